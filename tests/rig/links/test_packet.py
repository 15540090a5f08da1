# SPDX-License-Identifier: MIT
"""Packets come back whole, and a damaged one is none."""

import pytest
from cobs import cobs
from hypothesis import given
from hypothesis import strategies as st

from rig.errors import ProtocolError
from rig.links.packet import LONGEST_BODY, WRAP, Packet, decode_packet, encode_packet

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
