# SPDX-License-Identifier: MIT
"""Samples from packets of one kind; what else comes is counted and never handed on."""

import struct

import pytest
from cobs import cobs

from rig.clock import ManualClock
from rig.errors import DeviceMismatch
from rig.links.byte_link import MemoryLink
from rig.links.packet import Kind, Packet, decode_packet, encode_packet
from rig.links.packet_stream import MAX_FOREIGN, PacketStream

BODY = struct.Struct("<hh")


class Feed:
    """Sends what it is given and keeps what it receives."""

    source = "sim:feed"

    def __init__(self):
        self.out, self.received = b"", b""

    def poll(self, now, received):
        self.received += received
        out, self.out = self.out, b""
        return out


def stream(**options):
    feed, clock = Feed(), ManualClock(10.0)
    link = MemoryLink(feed, clock=clock)
    made = PacketStream(
        link, name="x", kind=Kind.LEGS, body=BODY, rate=100.0, clock=clock, **options
    )
    return made, feed


def packet(number, counts=(1, 2), kind=Kind.LEGS):
    return encode_packet(Packet(kind, number, 10_000 * number, BODY.pack(*counts)))


def test_counts_numbers_and_device_times_come_out():
    reader, feed = stream()
    feed.out = packet(0, (1, -2)) + packet(1, (3, 4))
    first, second = reader.read(0.0)
    assert (first.counts, first.sequence, first.device_time) == ((1, -2), 0, 0.0)
    assert (second.counts, second.sequence) == ((3, 4), 1)
    assert second.device_time == pytest.approx(0.01)
    assert second.host_time == 10.0
    assert reader.counters.received == 2


def test_damaged_impossible_foreign_and_missing_packets_are_counted():
    reader, feed = stream(possible=lambda counts: counts[0] < 100)
    damaged = bytearray(packet(1))
    damaged[3] ^= 0x40
    feed.out = (packet(0) + bytes(damaged) + packet(2, (100, 0)) + packet(3, kind=Kind.STOP)
                + packet(5))  # fmt: skip
    assert [s.sequence for s in reader.read(0.0)] == [0, 5]
    counters = reader.counters
    assert (counters.received, counters.damaged, counters.refused) == (2, 1, 2)
    assert counters.lost == 4


def test_packets_of_another_device_alone_are_a_mismatch():
    reader, feed = stream()
    feed.out = b"".join(packet(n, kind=Kind.ORIENTATION) for n in range(MAX_FOREIGN))
    with pytest.raises(DeviceMismatch, match=r"kind 2.* none of kind 1"):
        reader.read(0.0)


def test_what_is_sent_is_numbered_and_dated():
    reader, feed = stream()
    assert reader.send(Kind.STOP)
    assert reader.send(Kind.LEG_SET_POINTS, b"ab")
    reader.read(0.0)
    sent = [decode_packet(cobs.decode(part)) for part in feed.received.split(b"\0")[:-1]]
    assert [(p.kind, p.sequence, p.ticks, p.body) for p in sent] == [
        (Kind.STOP, 0, 10_000_000, b""), (Kind.LEG_SET_POINTS, 1, 10_000_000, b"ab"),
    ]  # fmt: skip
