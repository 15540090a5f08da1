# SPDX-License-Identifier: MIT
"""A simulated micro-controller instead of drives and load cell."""

import math

import numpy as np

from rig.links.faults import PERFECT_LINE, Faults, FaultyWire
from rig.links.packet import TICK, CobsFramer, Kind, Packet, decode_packet, encode_packet
from rig.links.packet_stream import LONGEST
from rig.slip_rig.board import WATCHDOG_EXPIRED, board_body, speed_body
from rig.slip_rig.profile import BoardProfile
from rig.slip_rig.simulated import SimulatedRig


class SimulatedBoard:
    """Simulated board with forces, speeds and a watchdog; implements the protocol `ByteTwin`.

    Args:
        rig: Simulated discs and contact that the board turns and measures.
        profile: Counts, signs and rate of the board.
        watchdog: Time without a speed command after which the board stops both discs, and ignores
            speed commands until a stop command, as after switching on; infinite without one. It
            starts with the first command [s].
        faults: Transmission errors of the line.
        rng: Random generator of the transmission errors.
    """

    def __init__(
        self,
        rig: SimulatedRig,
        *,
        profile: BoardProfile,
        watchdog: float = 0.2,
        faults: Faults = PERFECT_LINE,
        rng: np.random.Generator,
    ) -> None:
        self.source = "sim:rig"
        self._rig = rig
        self._profile = profile
        self._watchdog = watchdog
        self._wire = FaultyWire(faults, rng=rng)
        self._framer = CobsFramer(longest=LONGEST)
        self._body = board_body(profile)
        self._command = speed_body(profile)
        self._fed = math.inf
        self._number = self._booted = 0
        self._status = WATCHDOG_EXPIRED

    def poll(self, now: float, received: bytes) -> bytes:
        """Check the watchdog, execute commands, simulate the rig, and return the packets due.

        See `ByteTwin.poll`.

        Args:
            now: Time, never decreasing [s].
            received: Bytes from the host since the last poll.

        Returns:
            Bytes to the host since the last poll.
        """
        if now - self._fed > self._watchdog:
            self._stop()
            self._status = WATCHDOG_EXPIRED
        for content in self._framer.feed(received):
            packet = decode_packet(content)
            if packet is not None:
                self._execute(packet, now)
        self._rig.advance(now)
        due = int(self._rig.elapsed(now) * self._profile.rate + 1e-6)
        frames = self._frames(due)
        self._number = max(self._number, due)
        return self._wire.stream(frames)

    def restart(self) -> None:
        """Switch the board off and on: discs stop, and its numbers and its clock begin anew."""
        self._stop()
        self._status = WATCHDOG_EXPIRED
        self._booted = self._number
        self._framer.reset()

    def _frames(self, due: int) -> list[bytes]:
        """Encode the samples after the last one sent up to number `due`."""
        numbers = np.arange(self._number + 1, due + 1)
        if len(numbers) == 0:
            return []
        normal, traction = self._rig.forces(numbers / self._profile.rate)
        speeds = self._rig.measured_speeds(numbers / self._profile.rate)
        scale = self._profile.counts_per_force
        leg, ground = (
            np.rint(speed * self._profile.counts_per_speed).astype(int).tolist() for speed in speeds
        )
        pressing = np.rint(self._profile.normal_sign * scale * normal).astype(int).tolist()
        driving = np.rint(self._profile.traction_sign * scale * traction).astype(int).tolist()
        return [
            self._encode(number, (pressing[k], driving[k], leg[k], ground[k], self._status))
            for k, number in enumerate((numbers - self._booted).tolist())
        ]

    def _encode(self, number: int, counts: tuple[int, ...]) -> bytes:
        """Encode the packet of a sample, taken `number` sample intervals after switching on."""
        ticks = round(number / self._profile.rate / TICK)
        return encode_packet(Packet(Kind.SLIP_RIG, number, ticks, self._body.pack(*counts)))

    def _execute(self, packet: Packet, now: float) -> None:
        """Execute a stop, which clears an expired watchdog, or speeds of both discs.

        Until that stop speeds are ignored, as are other packets at any time.
        """
        if packet.kind == Kind.STOP:
            self._status = 0
            self._stop()
        elif self._status:
            return  # stopped by the watchdog: a host that comes back must not set it turning
        elif packet.kind == Kind.DISC_SPEEDS and len(packet.body) == self._command.size:
            self._fed = now
            leg, ground = self._command.unpack(packet.body)
            self._rig.command("leg", leg / self._profile.counts_per_speed)
            self._rig.command("ground", ground / self._profile.counts_per_speed)

    def _stop(self) -> None:
        """Stop both discs, and the watchdog until the next speed command."""
        self._fed = math.inf
        self._rig.command("leg", 0.0)
        self._rig.command("ground", 0.0)
