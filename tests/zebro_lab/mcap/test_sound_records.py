# SPDX-License-Identifier: MIT
"""What is whole in a damaged log is read: one flipped bit costs one chunk at most, and is told."""

import io
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from rig.device import Sample
from support.logs import STREAMS
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.log_records import read_log_messages
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.raw_log import read_raw_log

CHUNKS, IN_CHUNK = 30, 7


@dataclass(frozen=True)
class Recorded:
    """A log: its bytes, where its chunks end, and where to write a damaged copy."""

    data: bytes
    ends: list[int]
    copy: Path


@pytest.fixture(params=["finished", "of a killed recorder"])
def recorded(request, tmp_path):
    """Return a log of two streams, with numbers for all that is in a sample."""
    file, ends, rng = io.BytesIO(), [], np.random.default_rng(3)
    streams = {name: STREAMS[name] for name in ("legs", "board")}
    texts = {"profiles/x.toml": "schema = 1\n" * 50}
    log = LogWriter(file, streams=streams, attachments=texts, start=0.0, start_ns=10**18)
    for chunk in range(CHUNKS):
        for name, width in (("legs", 6), ("board", 4)):
            log.write(name, [sample(number, width) for number in numbers_in(chunk)])
        log.event(float(chunk), str(rng.random()))
        log.flush()
        ends.append(file.tell())
    if request.param == "finished":
        log.finish()
    return Recorded(file.getvalue(), ends, tmp_path / "log.mcap")


def numbers_in(chunk):
    return range(chunk * IN_CHUNK, (chunk + 1) * IN_CHUNK)


@cache
def sample(number, width):
    counts = np.random.default_rng([number, width]).integers(-(2**31), 2**31, width)
    return Sample(number / 7, number / 3, number, tuple(counts.tolist()), number % 5, 0)


def lost_chunks(path):
    """Return the chunks of which anything is missing; whatever is there must be as it was."""
    found = read_raw_log(path)
    lost = set()
    for topic, width in (("/legs/raw", 6), ("/board/raw", 4)):
        samples = list(found.streams[topic])
        assert samples == [sample(each.sequence, width) for each in samples]
        numbers = [each.sequence for each in samples]
        assert numbers == sorted(set(numbers))
        missing = set(range(CHUNKS * IN_CHUNK)) - set(numbers)
        lost |= {number // IN_CHUNK for number in missing}
        assert missing == {number for chunk in lost for number in numbers_in(chunk)}
    return lost, found.damage


def flip(recorded, bit):
    data = bytearray(recorded.data)
    data[bit // 8] ^= 1 << bit % 8
    recorded.copy.write_bytes(data)
    lost, damage = lost_chunks(recorded.copy)
    assert len(lost) <= 1, bit
    if lost:
        assert damage is not None, bit
        (chunk,) = lost
        begin = 0 if chunk == 0 else recorded.ends[chunk - 1]
        assert begin <= bit // 8 < recorded.ends[chunk], bit
        size = int(damage.split(", ")[-1].split(" byte")[0])
        assert size >= 0.5 * (recorded.ends[1] - recorded.ends[0])
    return lost


def test_a_flipped_bit_costs_one_chunk_at_most(recorded):
    for bit in np.random.default_rng(0).integers(0, 8 * len(recorded.data), 10):
        flip(recorded, int(bit))


def test_a_flipped_bit_of_what_describes_a_chunk_costs_that_chunk_at_most(recorded):
    begin = 8 * recorded.ends[10]
    for bit in range(begin, begin + 8 * 60, 37):
        flip(recorded, bit)


@pytest.mark.long
def test_flipped_bits_cost_one_chunk_at_most_each(recorded):
    rng = np.random.default_rng(1)
    lost = [flip(recorded, int(bit)) for bit in rng.integers(0, 8 * len(recorded.data), 400)]
    assert sum(map(bool, lost)) > 200
    for end in recorded.ends[:3]:  # and all bits of the beginning of chunks, and of the file
        for bit in range(8 * end, 8 * (end + 60)):
            flip(recorded, bit)
    for bit in range(8 * 60):
        flip(recorded, bit)


@pytest.mark.parametrize("fill", [b"\0", b"\xff", b"\x06"])
def test_a_hole_costs_the_chunks_in_it_and_says_where(recorded, fill):
    begin, end = recorded.ends[4] + 20, recorded.ends[8] + 60
    data = recorded.data[:begin] + fill * (end - begin) + recorded.data[end:]
    recorded.copy.write_bytes(data)
    lost, damage = lost_chunks(recorded.copy)
    assert lost == {5, 6, 7, 8, 9}
    assert damage.startswith(f"bytes {recorded.ends[4]} to {recorded.ends[9]} are left out: ")
    assert f"1 fault, {recorded.ends[9] - recorded.ends[4]} bytes left out" in damage


def test_two_holes_are_both_counted(recorded):
    data = bytearray(recorded.data)
    for chunk in (3, 20):
        data[recorded.ends[chunk] - 5] ^= 0xFF
    recorded.copy.write_bytes(data)
    lost, damage = lost_chunks(recorded.copy)
    assert lost == {3, 20}
    assert "2 faults" in damage


def test_every_part_of_a_log_from_its_beginning_is_told_to_end_early(recorded):
    for kept in (8, 9, 17, *range(40, len(recorded.data), 97), *recorded.ends[:-1]):
        recorded.copy.write_bytes(recorded.data[:kept])
        found = read_raw_log(recorded.copy)
        assert "the file ends early" in found.damage, kept
        whole = sum(end <= kept for end in recorded.ends) * IN_CHUNK
        assert len(found.streams.get("/legs/raw", ())) == whole


def test_no_run_hangs_on_its_first_chunk(recorded):
    first = recorded.data.index(b"\4\0\0\0zstd")
    data = recorded.data[: first - 37] + bytes(recorded.ends[0] - first + 37)
    recorded.copy.write_bytes(data + recorded.data[recorded.ends[0] :])
    assert lost_chunks(recorded.copy)[0] == {0}


def test_a_wrong_first_byte_alone_is_no_reason_to_refuse_a_log(recorded):
    recorded.copy.write_bytes(b"x" + recorded.data[1:])
    lost, damage = lost_chunks(recorded.copy)
    assert not lost
    assert "first bytes" in damage


FOREIGN = {
    "not compressed": {"compression": CompressionType.NONE},
    "lz4": {"compression": CompressionType.LZ4},
    "without checksums": {"enable_crcs": False},
    "without chunks": {"use_chunking": False, "enable_data_crcs": True},
}


def foreign(path, **options):
    with path.open("wb") as file:
        log = Writer(file, chunk_size=500, **options)
        log.start()
        schema = log.register_schema("x", "ros2msg", b"uint8[] x")
        channel = log.register_channel("/x", "cdr", schema)
        for number in range(100):
            log.add_message(channel, log_time=number, data=bytes([number]) * 50, publish_time=0)
        log.finish()
    return path


def contents(path):
    messages, damage = read_log_messages(path, lambda schema: bytes)
    return [message.content for message in messages], damage


@pytest.mark.parametrize("options", FOREIGN.values(), ids=FOREIGN)
def test_logs_of_other_forms_are_read_and_their_damage_is_seen(tmp_path, options):
    path = foreign(tmp_path / "log.mcap", **options)
    wanted = [bytes([number]) * 50 for number in range(100)]
    assert contents(path) == (wanted, None)
    whole = path.read_bytes()
    for at in np.random.default_rng(2).integers(100, len(whole) - 700, 20):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        found, damage = contents(path)
        if options.get("use_chunking", True) and options.get("enable_crcs", True):
            assert len(found) >= 90
            assert set(found) <= set(wanted)
        assert found == wanted or damage is not None or not options.get("enable_crcs", True)
    for kept in range(400, len(whole) - 700, 100):
        path.write_bytes(whole[:kept])
        found, damage = contents(path)
        assert damage is not None
        assert found == wanted[: len(found)]


def test_what_is_no_mcap_file_is_refused(tmp_path):
    for data in (b"", b"x", b"\x06" * 300, b"\x04\0\0\0zstd" * 99, b"a,b\n1,2\n" * 99):
        (tmp_path / "log.mcap").write_bytes(data)
        with pytest.raises(DataError, match="is not an MCAP file"):
            contents(tmp_path / "log.mcap")
