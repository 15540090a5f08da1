# SPDX-License-Identifier: MIT
"""The simulated robot: the same legs behind the bytes of each layout, for the real drivers.

Not modelled: the timing of single bytes, and collisions on the bus.
"""

import struct

import can
import numpy as np

from rig.links.faults import PERFECT_LINE, Faults, FaultyWire
from rig.links.framing import CobsFramer
from rig.links.packet import TICK, Kind, Packet, decode_packet, encode_packet
from rig.links.packet_stream import LONGEST
from rig.zebro.can import CLOCK, POSITIONS, SEQUENCE_WRAP, SET_POINTS, TICKS_WRAP
from rig.zebro.commands import MILLISECOND, set_point_body
from rig.zebro.profile import DUMP_REGISTERS
from rig.zebro.registers import SYNC
from rig.zebro.serial import leg_body
from rig.zebro.simulated_legs import Frame, SimulatedLegs


class PacketRobot:
    """A robot behind a bridge that sends packets; satisfies `ByteTwin`.

    Args:
        legs: The legs.
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
        self._framer = CobsFramer(longest=LONGEST)
        self._body = leg_body(legs.profile)
        self._command = set_point_body(legs.profile)

    def poll(self, now: float, received: bytes) -> bytes:
        """Execute commands and return the packets that are due; see `ByteTwin.poll`.

        Args:
            now: Time, never decreasing [s].
            received: Bytes from the host since the last poll.

        Returns:
            Bytes to the host since the last poll.
        """
        for content in self._framer.feed(received):
            packet = decode_packet(content)
            if packet is not None:
                self._obey(packet, now)
        return self._wire.carry([self._encode(frame) for frame in self.legs.frames(now)])

    def _encode(self, frame: Frame) -> bytes:
        ticks = round(frame.device_time / TICK)
        body = self._body.pack(*frame.counts)
        return encode_packet(Packet(Kind.LEGS, frame.number, ticks, body))

    def _obey(self, packet: Packet, now: float) -> None:
        if packet.kind == Kind.STOP:
            self.legs.stop(now)
        elif packet.kind == Kind.LEG_SET_POINTS and len(packet.body) == self._command.size:
            *counts, duration = self._command.unpack(packet.body)
            self.legs.command(tuple(counts), duration * MILLISECOND, now)


class DumpRobot:
    """One leg module that dumps its registers; satisfies `ByteTwin`.

    Args:
        legs: The legs; the profile says which of them the module turns.
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
        """Return the register dumps that are due; see `ByteTwin.poll`.

        Args:
            now: Time, never decreasing [s].
            received: Bytes from the host; ignored, as the real module does.

        Returns:
            Bytes to the host since the last poll.
        """
        del received
        return self._wire.carry([self._encode(frame) for frame in self.legs.frames(now)])

    def _encode(self, frame: Frame) -> bytes:
        registers = bytearray(DUMP_REGISTERS)
        profile = self.legs.profile
        for first, count in zip(profile.registers.positions, frame.counts, strict=True):
            registers[first : first + 2] = count.to_bytes(2, profile.byte_order)
        return bytes(registers) + SYNC


class PolledRobot:
    """A bridge that answers register reads; satisfies `ByteTwin`.

    Args:
        legs: The legs.
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
        self._inbox = b""
        self._counts: tuple[int, ...] = (0,) * len(legs.profile.legs)

    def poll(self, now: float, received: bytes) -> bytes:
        """Answer register reads and execute register writes; see `ByteTwin.poll`.

        Args:
            now: Time, never decreasing [s].
            received: Bytes from the host since the last poll.

        Returns:
            Bytes to the host since the last poll.
        """
        for frame in self.legs.frames(now):
            self._counts = frame.counts
        self._inbox += received
        answers: list[bytes] = []
        while len(self._inbox) >= 3 and self._serve(now, answers):
            pass
        return self._wire.carry(answers)

    def _serve(self, now: float, answers: list[bytes]) -> bool:
        """Answer the first request of the inbox; return whether it was complete."""
        command, first, size = self._inbox[:3]
        registers = self.legs.profile.registers
        if command == registers.read_command:
            answers.append(self._memory()[first : first + size])
            self._inbox = self._inbox[3:]
        elif command == registers.write_command:
            if len(self._inbox) < 3 + size:
                return False
            self._write(first, self._inbox[3 : 3 + size], now)
            self._inbox = self._inbox[3 + size :]
        else:
            self._inbox = self._inbox[1:]
        return True

    def _memory(self) -> bytes:
        memory = bytearray(DUMP_REGISTERS)
        profile = self.legs.profile
        for first, count in zip(profile.registers.positions, self._counts, strict=True):
            memory[first : first + 2] = count.to_bytes(2, profile.byte_order)
        return bytes(memory)

    def _write(self, first: int, data: bytes, now: float) -> None:
        profile = self.legs.profile
        layout = struct.Struct(
            ("<" if profile.byte_order == "little" else ">") + f"{len(profile.legs) + 1}H"
        )
        if first == profile.registers.stop and any(data):
            self.legs.stop(now)
        elif first == profile.registers.set_points[0] and len(data) == layout.size:
            *counts, duration = layout.unpack(data)
            self.legs.command(tuple(counts), duration * MILLISECOND, now)


class CanRobot:
    """A robot on a CAN bus.

    Args:
        legs: The legs.
        bus: Its own end of the bus; the caller closes it.
        faults: What goes wrong; only `drop`, `duplicate` and `delay` mean anything for frames that
            the bus itself guards.
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
        self._faults = faults
        self._rng = rng
        self._held: list[can.Message] = []

    def poll(self, now: float) -> None:
        """Execute commands from the bus and send the frames that are due up to a time [s]."""
        while (message := self._bus.recv(0.0)) is not None:
            self._obey(message, now)
        for frame in self.legs.frames(now):
            for message in self._encode(frame):
                self._send(message)

    def _encode(self, frame: Frame) -> tuple[can.Message, can.Message]:
        ids = self.legs.profile.can_ids
        number = frame.number % SEQUENCE_WRAP
        ticks = round(frame.device_time / TICK) % TICKS_WRAP
        return (
            can.Message(arbitration_id=ids.clock, data=CLOCK.pack(number, ticks),
                        is_extended_id=False),
            can.Message(arbitration_id=ids.positions, data=POSITIONS.pack(*frame.counts, number),
                        is_extended_id=False),
        )  # fmt: skip

    def _send(self, message: can.Message) -> None:
        held, self._held = self._held, []
        if self._rng.random() < self._faults.delay:
            self._held = [message]
        elif self._rng.random() >= self._faults.drop:
            self._bus.send(message)
            if self._rng.random() < self._faults.duplicate:
                self._bus.send(message)
        for late in held:
            self._bus.send(late)

    def _obey(self, message: can.Message, now: float) -> None:
        ids = self.legs.profile.can_ids
        if message.arbitration_id == ids.stop:
            self.legs.stop(now)
        elif message.arbitration_id == ids.set_points and message.dlc == SET_POINTS.size:
            *counts, duration = SET_POINTS.unpack(message.data)
            self.legs.command(tuple(counts), duration * MILLISECOND, now)
