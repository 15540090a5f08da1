# SPDX-License-Identifier: MIT
"""The simulated robot: the same legs behind the bytes of each layout, for the real drivers.

Not modelled: the timing of single bytes, and collisions on the bus.
"""

from abc import ABC, abstractmethod

import can
import numpy as np

from rig.links.faults import PERFECT_LINE, Faults, FaultyLine, FaultyWire
from rig.links.packet import TICK, CobsFramer, Kind, Packet, decode_packet, encode_packet
from rig.links.packet_stream import LONGEST
from rig.zebro.can import CLOCK, POSITIONS, SEQUENCE_WRAP, SET_POINTS, TICKS_WRAP
from rig.zebro.commands import MILLISECOND
from rig.zebro.profile import DUMP_REGISTERS, LegProfile
from rig.zebro.serial import SYNC
from rig.zebro.simulated_legs import Frame, SimulatedLegs


class _ByteRobot(ABC):
    """Simulated robot on a serial line; implements the protocol `ByteTwin`.

    Args:
        legs: Simulated legs that the robot moves and reports.
        faults: Transmission errors of the line.
        rng: Random generator of the transmission errors.
    """

    def __init__(
        self,
        legs: SimulatedLegs,
        *,
        faults: Faults = PERFECT_LINE,
        rng: np.random.Generator,
    ) -> None:
        self.source = "sim:zebro"
        self.legs = legs
        self._wire = FaultyWire(faults, rng=rng)

    def poll(self, now: float, received: bytes) -> bytes:
        """Execute commands and return the frames that are due; see `ByteTwin.poll`.

        Args:
            now: Time, never decreasing [s].
            received: Bytes from the host since the last poll.

        Returns:
            Bytes to the host since the last poll.
        """
        return self._wire.stream(self._answer(now, received))

    @abstractmethod
    def _answer(self, now: float, received: bytes) -> list[bytes]:
        """Execute the commands received, and return the due frames without transmission errors."""


class PacketRobot(_ByteRobot):
    """Simulated robot behind a bridge that sends packets; layout `packet`."""

    def __init__(
        self, legs: SimulatedLegs, *, faults: Faults = PERFECT_LINE, rng: np.random.Generator
    ) -> None:
        super().__init__(legs, faults=faults, rng=rng)
        self._framer = CobsFramer(longest=LONGEST)

    def _answer(self, now: float, received: bytes) -> list[bytes]:
        """Execute the packets received; return those of the frames that are due."""
        for content in self._framer.feed(received):
            packet = decode_packet(content)
            if packet is not None:
                self._execute(packet, now)
        return [self._encode(frame) for frame in self.legs.frames(now)]

    def _encode(self, frame: Frame) -> bytes:
        """Encode a frame as a packet of the kind `LEGS`."""
        ticks = round(frame.device_time / TICK)
        body = self.legs.profile.words(6).pack(*frame.counts)
        return encode_packet(Packet(Kind.LEGS, frame.number, ticks, body))

    def _execute(self, packet: Packet, now: float) -> None:
        """Execute a stop or set-points of all legs; other packets are ignored."""
        layout = self.legs.profile.words(7)
        if packet.kind == Kind.STOP:
            self.legs.stop(now)
        elif packet.kind == Kind.LEG_SET_POINTS and len(packet.body) == layout.size:
            *counts, duration = layout.unpack(packet.body)
            self.legs.command(tuple(counts), duration * MILLISECOND, now)


class DumpRobot(_ByteRobot):
    """Simulated leg module that dumps its registers and ignores commands; layout `dump`."""

    def _answer(self, now: float, received: bytes) -> list[bytes]:
        """Return the dumps of the frames that are due; the bytes received are ignored."""
        del received  # the real module ignores commands, too
        profile = self.legs.profile
        return [_registers(profile, frame.counts) + SYNC for frame in self.legs.frames(now)]


class PolledRobot(_ByteRobot):
    """Simulated bridge that answers register reads and executes register writes; layout `poll`."""

    _inbox = b""
    _counts: tuple[int, ...]

    def _answer(self, now: float, received: bytes) -> list[bytes]:
        """Execute whole requests, return the answers; keep an incomplete one for the next call."""
        for frame in self.legs.frames(now):
            self._counts = frame.counts
        self._inbox += received
        answers: list[bytes] = []
        while len(self._inbox) >= 3 and self._serve(now, answers):
            pass
        return answers

    def _serve(self, now: float, answers: list[bytes]) -> bool:
        """Execute and remove the first request of the inbox; append the answer to a read.

        An unknown command byte is discarded. Returns False where the request is not complete yet.
        """
        command, first, size = self._inbox[:3]
        registers = self.legs.profile.registers
        if command == registers.read_command:
            answers.append(_registers(self.legs.profile, self._counts)[first : first + size])
            self._inbox = self._inbox[3:]
        elif command == registers.write_command:
            if len(self._inbox) < 3 + size:
                return False
            self._write(first, self._inbox[3 : 3 + size], now)
            self._inbox = self._inbox[3 + size :]
        else:
            self._inbox = self._inbox[1:]
        return True

    def _write(self, first: int, data: bytes, now: float) -> None:
        """Execute a write to the stop register or to all set-points; others are ignored."""
        profile = self.legs.profile
        layout = profile.words(len(profile.legs) + 1)
        if first == profile.registers.stop and any(data):
            self.legs.stop(now)
        elif first == profile.registers.set_points[0] and len(data) == layout.size:
            *counts, duration = layout.unpack(data)
            self.legs.command(tuple(counts), duration * MILLISECOND, now)


class CanRobot:
    """Simulated robot on a CAN bus; layout `can`.

    Args:
        legs: Simulated legs that the robot moves and reports.
        bus: The robot's own end of the bus; the caller closes it.
        faults: Transmission errors; only `drop`, `duplicate` and `delay` apply, because the bus
            protects each frame with a checksum.
        rng: Random generator of the transmission errors.
    """

    def __init__(
        self,
        legs: SimulatedLegs,
        bus: can.BusABC,
        *,
        faults: Faults = PERFECT_LINE,
        rng: np.random.Generator,
    ) -> None:
        self.source = "sim:zebro"
        self.legs = legs
        self._bus = bus
        self._line: FaultyLine[can.Message] = FaultyLine(faults, rng=rng)

    def poll(self, now: float) -> None:
        """Execute the commands on the bus, and send the frames that are due up to `now` [s]."""
        while (message := self._bus.recv(0.0)) is not None:
            self._execute(message, now)
        for frame in self.legs.frames(now):
            for message in self._encode(frame):
                for arrived in self._line.carry(message):
                    self._bus.send(arrived)

    def _encode(self, frame: Frame) -> tuple[can.Message, can.Message]:
        """Encode a frame as the CAN frame of its device time and, after it, that of its counts."""
        ids = self.legs.profile.can_ids
        number = frame.number % SEQUENCE_WRAP
        ticks = round(frame.device_time / TICK) % TICKS_WRAP
        return (
            can.Message(arbitration_id=ids.clock, data=CLOCK.pack(number, ticks),
                        is_extended_id=False),
            can.Message(arbitration_id=ids.positions, data=POSITIONS.pack(*frame.counts, number),
                        is_extended_id=False),
        )  # fmt: skip

    def _execute(self, message: can.Message, now: float) -> None:
        """Execute a stop or set-points of all legs; other frames are ignored."""
        ids = self.legs.profile.can_ids
        if message.arbitration_id == ids.stop:
            self.legs.stop(now)
        elif message.arbitration_id == ids.set_points and message.dlc == SET_POINTS.size:
            *counts, duration = SET_POINTS.unpack(message.data)
            self.legs.command(tuple(counts), duration * MILLISECOND, now)


def _registers(profile: LegProfile, counts: tuple[int, ...]) -> bytes:
    """Encode the counts of all channels as a dump of registers; all other registers are 0."""
    registers = bytearray(DUMP_REGISTERS)
    for first, count in zip(profile.registers.positions, counts, strict=True):
        registers[first : first + 2] = count.to_bytes(2, profile.byte_order)
    return bytes(registers)
