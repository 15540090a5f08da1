# SPDX-License-Identifier: MIT
"""Damaged logs are read up to their damage."""

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from rig.device import Sample
from support.bounded_reading import peak_memory, reset_peak_memory
from support.logs import COUNTS, VIEWS, log_of
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.raw_log import COUNTS_NAME, read_raw_log
from zebro_lab.mcap.slip_rig_log import SCHEMA_NAME, TOPIC, read_log


def test_a_log_is_read_up_to_where_it_is_cut(tmp_path):
    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        writer = LogWriter(file, views={"legs": VIEWS["legs"]}, attachments={}, start=0.0,
                           start_ns=0)  # fmt: skip
        for n in range(50):
            writer.write("legs", [Sample(n / 10, n / 10, n, COUNTS["legs"])])
            writer.flush()
    whole = path.read_bytes()
    for kept in (0.3, 0.6, 0.95):
        path.write_bytes(whole[: int(kept * len(whole))])
        found = read_raw_log(path)
        assert found.damage is not None
        numbers = found.streams["/legs/raw"].sequence
        assert 5 < len(numbers) < 50
        np.testing.assert_array_equal(numbers, np.arange(len(numbers)))


@pytest.mark.parametrize("length", [2**63, 2**64 - 1, 2**40])
def test_a_length_beyond_the_file_is_damage(tmp_path, length):
    file, _ = log_of("legs", rows=40)
    path = tmp_path / "log.mcap"
    header = len(b"\x89MCAP0\r\n") + 1  # the first record's kind stands before its length
    data = bytearray(file.getvalue())
    data[header : header + 8] = length.to_bytes(8, "little")
    path.write_bytes(data)
    assert read_raw_log(path).damage is not None


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


def log_of_chunk(file: Path, *, unpacked: int, schema: str, topic: str) -> Path:
    """Write a log whose one message unpacks to so many bytes of zeros."""
    with file.open("wb") as out:
        writer = Writer(out, chunk_size=unpacked * 2, compression=CompressionType.ZSTD)
        writer.start()
        number = writer.register_schema(schema, "ros2msg", b"uint8 x")
        channel = writer.register_channel(topic, "cdr", number)
        writer.add_message(channel, 0, bytes(unpacked), 0)
        writer.finish()
    return file


@pytest.mark.parametrize(
    ("reader", "schema", "topic"),
    [(read_raw_log, COUNTS_NAME, "/a/raw"), (read_log, SCHEMA_NAME, TOPIC)],
    ids=["raw", "rig"],
)
def test_a_bomb_of_zeros_in_a_log_is_cut_off_within_memory(reader, schema, topic, tmp_path):
    file = tmp_path / "log.mcap"
    log_of_chunk(file, unpacked=400 << 20, schema=schema, topic=topic)
    assert file.stat().st_size < 1 << 20
    before = reset_peak_memory()
    with suppress(DataError):
        reader(file)
    assert peak_memory() - before < 200 * 1024
