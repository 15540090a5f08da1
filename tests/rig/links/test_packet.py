# SPDX-License-Identifier: MIT
"""Packets come back whole, and a damaged one is none."""

import numpy as np
import pytest
from cobs import cobs
from hypothesis import given
from hypothesis import strategies as st

from rig.errors import ProtocolError
from rig.links.faults import Faults, FaultyWire
from rig.links.packet import (
    LONGEST_BODY,
    WRAP,
    CobsFramer,
    Packet,
    TrailerFramer,
    decode_packet,
    encode_packet,
)
from rig.links.packet_stream import LONGEST

PACKETS = st.builds(
    Packet, st.integers(0, 255), st.integers(0, 2**40), st.integers(0, 2**40),
    st.binary(max_size=LONGEST_BODY),
)  # fmt: skip


@given(PACKETS)
def test_a_packet_comes_back_with_its_numbers_wrapped(packet):
    wire = encode_packet(packet)
    assert wire.endswith(b"\0")
    assert b"\0" not in wire[:-1]
    expected = packet._replace(sequence=packet.sequence % WRAP, ticks=packet.ticks % WRAP)
    assert decode_packet(cobs.decode(wire[:-1])) == expected


@given(PACKETS, st.data())
def test_any_flipped_bit_makes_it_no_packet(packet, data):
    content = bytearray(cobs.decode(encode_packet(packet)[:-1]))
    bit = data.draw(st.integers(0, 8 * len(content) - 1))
    content[bit // 8] ^= 1 << bit % 8
    assert decode_packet(bytes(content)) is None


@given(st.binary(max_size=12))
def test_what_is_too_short_is_no_packet(content):
    assert decode_packet(content) is None


def test_a_body_that_is_too_long_is_refused():
    with pytest.raises(ProtocolError, match="has 201 bytes; expected at most 200"):
        encode_packet(Packet(1, 0, 0, bytes(LONGEST_BODY + 1)))


TRAILER = bytes.fromhex("FF4512EA4B")


def chunks(data, rng, mean=40):
    cuts = np.sort(rng.integers(0, len(data) + 1, max(len(data) // mean, 1))).tolist()
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)], strict=True)]


packets = st.builds(
    Packet,
    kind=st.integers(0, 255),
    sequence=st.integers(0, WRAP - 1),
    ticks=st.integers(0, WRAP - 1),
    body=st.binary(max_size=LONGEST_BODY),
)


@given(st.lists(packets, max_size=8), st.integers(0, 2**32 - 1))
def test_packets_are_found_however_the_bytes_are_cut(sent, seed):
    framer = CobsFramer(longest=LONGEST)
    data = b"".join(map(encode_packet, sent))
    found = []
    for chunk in chunks(data, np.random.default_rng(seed), 15):
        found += [decode_packet(content) for content in framer.feed(chunk)]
    assert found == sent
    assert framer.damaged == 0


@given(st.lists(st.binary(max_size=700), max_size=6), packets)
def test_after_any_noise_the_second_next_packet_is_found_at_the_latest(noise, packet):
    framer = CobsFramer(longest=LONGEST)
    for chunk in noise:
        framer.feed(chunk)
    framer.feed(encode_packet(packet))
    assert [decode_packet(c) for c in framer.feed(encode_packet(packet))] == [packet]


def test_noise_without_an_end_does_not_fill_the_memory():
    framer = CobsFramer(longest=LONGEST)
    for _ in range(100):
        framer.feed(b"\x55" * 10_000)
    assert len(framer._tail) <= LONGEST + 1
    assert framer.feed(b"\0") == []


@given(st.lists(st.binary(min_size=256, max_size=256), min_size=2, max_size=5), st.integers(1, 400))
def test_dumps_after_the_first_trailer_are_found(dumps, size):
    dumps = [dump.replace(TRAILER, bytes(5)).replace(b"\xff", b"\xfe") for dump in dumps]
    data = b"".join(dump + TRAILER for dump in dumps)
    framer = TrailerFramer(length=261, trailer=TRAILER)
    found = [f for i in range(0, len(data), size) for f in framer.feed(data[i : i + size])]
    assert found == dumps[1:]
    assert framer.damaged == 0


def test_a_truncated_dump_costs_at_most_itself_and_the_next():
    dumps = [bytes([n]) * 256 + TRAILER for n in range(6)]
    framer = TrailerFramer(length=261, trailer=TRAILER)
    found = framer.feed(b"".join([*dumps[:3], dumps[3][100:], *dumps[4:]]))
    assert {f[0] for f in found} >= {1, 2, 5}
    assert 3 not in {f[0] for f in found}
    assert (framer.damaged, framer.resynchronised) == (1, 1)


@given(st.binary(max_size=2000))
def test_any_bytes_are_taken_by_the_dump_reader(data):
    TrailerFramer(length=261, trailer=TRAILER).feed(data)


@pytest.mark.parametrize("flip", [1e-6, 1e-4, 1e-3, 1e-2])
def test_no_damaged_packet_is_taken_at_any_bit_error_rate(flip):
    rng = np.random.default_rng(5)
    sent = [Packet(1, n, 10 * n, rng.bytes(12)) for n in range(4000)]
    faults = Faults(flip=flip, truncate=0.01, duplicate=0.01, garbage=0.01, drop=0.01, delay=0.01)
    data = FaultyWire(faults, rng=rng).stream([encode_packet(p) for p in sent])
    framer = CobsFramer(longest=LONGEST)
    taken = [p for c in framer.feed(data) if (p := decode_packet(c)) is not None]
    assert set(taken) <= set(sent)
    assert len(taken) > 0.5 * len(sent) * (1 - flip) ** (8 * 27)
