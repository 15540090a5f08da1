# SPDX-License-Identifier: MIT
"""Stream of one kind of packet over a byte link, for legs, an IMU and the rig's board."""

import struct
from collections.abc import Callable
from typing import Final

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from rig.errors import DeviceMismatch
from rig.links.byte_link import ByteLink, LinkedStream
from rig.links.packet import (
    CHECKSUM,
    HEADER,
    LONGEST_BODY,
    TICK,
    WRAP,
    CobsFramer,
    Kind,
    Packet,
    decode_packet,
    encode_packet,
)
from rig.links.sequence import SequenceTracker, TimeUnwrapper

LONGEST: Final = HEADER.size + LONGEST_BODY + CHECKSUM.size + 1
"""Longest stuffed packet without its zero byte [bytes]."""
MAX_FOREIGN: Final = 20
"""Number of packets of other kinds or lengths, with no sample so far, that is a mismatch."""


class PacketStream(LinkedStream[ByteLink]):
    """Samples from packets of one kind; implements the protocol `rig.device.Stream`.

    Args:
        link: Bytes to and from the device.
        name: Name of the stream.
        kind: Kind of packet that carries the samples.
        body: Layout of the packet's body; its fields are the sample's counts.
        rate: Sample rate; distinguishes a loss from a restart [Hz].
        possible: Returns whether the counts of a sample are possible; samples with impossible ones
            are discarded and counted as refused. None accepts any counts.
        clock: Host time.
    """

    def __init__(
        self,
        link: ByteLink,
        *,
        name: str,
        kind: Kind,
        body: struct.Struct,
        rate: float,
        possible: Callable[[tuple[float, ...]], bool] | None = None,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        super().__init__(link, name=name, clock=clock)
        self._kind = kind
        self._body = body
        self._possible = possible
        self._framer = CobsFramer(longest=LONGEST)
        self._tracker = SequenceTracker(modulus=WRAP, rate=rate)
        self._device_time = TimeUnwrapper(modulus=WRAP, tick=TICK)
        self._foreign = 0
        self._sent = 0
        self._connections = 0

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far.

        Packets of other kinds or lengths, or with impossible counts, count as refused.
        """
        return Counters(
            received=self._received,
            lost=self._tracker.lost,
            damaged=self._framer.damaged,
            repeated=self._tracker.repeated,
            refused=self._refused,
            resynchronised=self._framer.resynchronised,
            reconnected=self._link.reconnected,
            restarted=self._tracker.restarted,
        )

    def read(self, timeout: float) -> list[Sample]:
        """Return all samples that have arrived, waiting at most `timeout` for the first [s].

        Raises:
            DeviceMismatch: `MAX_FOREIGN` whole packets had another kind or length, and none has
                given a sample.
        """
        data = self._link.read(timeout)
        if self._link.reconnected != self._connections:
            self._connections = self._link.reconnected
            self._framer.reset()
        now = self._clock.now()
        found = (self._sample(content, now) for content in self._framer.feed(data))
        samples = [sample for sample in found if sample is not None]
        self._received += len(samples)
        return samples

    def send(self, kind: Kind, body: bytes = b"") -> bool:
        """Send a packet to the device.

        Args:
            kind: Kind of command.
            body: Encoded values of the command.

        Returns:
            Whether the link took the packet; False while the link is disconnected. The protocol
            has no acknowledgement: whether the device obeys shows in its stream.

        Raises:
            ProtocolError: The body is longer than a packet can hold.
            RigTimeout: The port accepts no bytes within its timeout.
        """
        ticks = int(self._clock.now() / TICK)
        packet = Packet(kind, self._sent, ticks, body)
        self._sent += 1
        return self._link.write(encode_packet(packet))

    def _sample(self, content: bytes, now: float) -> Sample | None:
        """Return the sample of a decoded frame; None, counted by its fault, if there is none."""
        packet = decode_packet(content)
        if packet is None:
            self._framer.refuse()
            return None
        self._framer.accept()
        if packet.kind != self._kind or len(packet.body) != self._body.size:
            self._refuse_foreign(packet)
            return None
        counts = self._body.unpack(packet.body)
        if self._possible is not None and not self._possible(counts):
            self._refused += 1
            return None
        elapsed = self._device_time.since(packet.ticks)
        sequence = self._tracker.accept(packet.sequence, now, elapsed)
        if sequence is None:
            return None
        return Sample(now, self._device_time.unwrap(packet.ticks), sequence, counts)

    def _refuse_foreign(self, packet: Packet) -> None:
        """Count a packet of another kind or length as refused.

        Raises:
            DeviceMismatch: It is the `MAX_FOREIGN`-th or a later one, and no sample was received.
        """
        self._refused += 1
        self._foreign += 1
        if self._received == 0 and self._foreign >= MAX_FOREIGN:
            raise DeviceMismatch(
                f"stream '{self.name}' received {self._foreign} packets of other kinds or lengths "
                f"(last: kind {packet.kind}, {len(packet.body)} bytes) and none of kind "
                f"{int(self._kind)} with {self._body.size} bytes; are two ports swapped?"
            )
