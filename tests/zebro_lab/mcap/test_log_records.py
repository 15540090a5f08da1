# SPDX-License-Identifier: MIT
"""Logs that were cut are read up to there, and those with damage but for it."""

import numpy as np

from rig.device import Sample
from support.logs import COUNTS, STREAMS, log_of
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.raw_log import read_raw_log


def test_a_log_is_read_up_to_where_it_is_cut(tmp_path):
    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        writer = LogWriter(file, streams={"legs": STREAMS["legs"]}, attachments={}, start=0.0,
                           start_ns=0)  # fmt: skip
        for n in range(50):
            writer.write("legs", [Sample(n / 10, n / 10, n, COUNTS["legs"])])
            writer.flush()
    whole = path.read_bytes()
    for kept in (0.4, 0.6, 0.95):
        path.write_bytes(whole[: int(kept * len(whole))])
        found = read_raw_log(path)
        assert found.damage is not None
        numbers = found.streams["/legs/raw"].sequence
        assert 5 < len(numbers) < 50
        np.testing.assert_array_equal(numbers, np.arange(len(numbers)))


def test_a_log_with_flipped_bytes_is_read_in_part_or_refused(tmp_path):
    file, _ = log_of("legs", rows=40)
    whole = file.getvalue()
    rng = np.random.default_rng(0)
    path = tmp_path / "log.mcap"
    for _ in range(300):
        data = bytearray(whole)
        for at in rng.integers(0, len(data), rng.integers(1, 4)):
            data[at] ^= 1 << rng.integers(8)
        path.write_bytes(data)
        try:
            found = read_raw_log(path)
        except DataError:
            continue
        for stream in found.streams.values():
            assert len(stream) <= 40
