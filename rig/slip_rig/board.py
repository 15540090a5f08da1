# SPDX-License-Identifier: MIT
"""Driver of a slip rig on one micro-controller: packets of forces and speeds, speed commands."""

import contextlib
import math
import struct
from typing import Final

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Limits, Sample
from rig.errors import DeviceFault, RigError
from rig.links.byte_link import ByteLink
from rig.links.packet import Kind
from rig.links.packet_stream import PacketStream
from rig.safety import require_within
from rig.slip_rig.profile import BoardProfile

WATCHDOG_EXPIRED: Final = 1
"""Status bit: the board's watchdog expired and stopped both discs, or the board was switched on and
takes no speeds yet; a stop command clears it."""


def board_body(profile: BoardProfile) -> struct.Struct:
    """Return the layout of a sample: normal force, traction, leg and ground speed, status.

    Four signed counts of 32 bits and an unsigned status of 32 bits, in the profile's byte order.
    """
    return struct.Struct(("<" if profile.byte_order == "little" else ">") + "4iI")


def speed_body(profile: BoardProfile) -> struct.Struct:
    """Return the layout of a speed command: leg and ground speed as signed counts of 32 bits.

    They are in the profile's byte order.
    """
    return struct.Struct(("<" if profile.byte_order == "little" else ">") + "2i")


class RigBoard(PacketStream):
    """Stream of the board and drives of both discs; reading feeds the board's watchdog.

    Leaving it stops both discs.

    Args:
        link: Bytes to and from the board.
        profile: Profile of the board.
        limits: Limits of the rig; commanded speeds must be within its speed.
        clock: Host time.

    Attributes:
        leg: Drive of the leg disc.
        ground: Drive of the ground disc.
        feeding: Whether `read` feeds the watchdog of an armed board.
    """

    watchdog_advice: Final = (
        "nothing has moved; make the board's firmware stop both discs 0.1 to 0.25 s after the last "
        f"speed command, and report status {WATCHDOG_EXPIRED:#x}"
    )

    def __init__(
        self,
        link: ByteLink,
        *,
        profile: BoardProfile,
        limits: Limits,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        super().__init__(
            link, name="board", kind=Kind.SLIP_RIG, body=board_body(profile), rate=profile.rate,
            clock=clock,
        )  # fmt: skip
        self.profile = profile
        self.limits = limits
        self.leg = BoardDrive(self, "leg")
        self.ground = BoardDrive(self, "ground")
        self.feeding = True
        self._speeds = {"leg": 0.0, "ground": 0.0}
        self._armed: set[str] = set()
        self._feed_at = -math.inf
        self._status = 0
        self._released = False  # whether a sample has shown that the board obeyed `_arm`

    def read(self, timeout: float) -> list[Sample]:
        """Return all samples that have arrived, waiting at most `timeout` for the first [s].

        Counts are normal force, traction, leg and ground speed; status is the board's. While a disc
        is armed and `feeding` True, both speeds are sent every `feed_interval`, which feeds the
        watchdog.

        Raises:
            DeviceMismatch: As `PacketStream.read`.
            RigTimeout: The port accepts no bytes within its timeout.
        """
        end = self._clock.now() + timeout
        while True:
            if self.feeding and self._armed and self._clock.now() >= self._feed_at:
                self.command_speeds()
            left = max(end - self._clock.now(), 0.0)
            samples = super().read(min(left, self.profile.feed_interval))
            if samples or left <= 0:
                return [self._with_status(sample) for sample in samples]

    def require_healthy(self) -> None:
        """Check the status of the board's latest sample.

        Raises:
            DeviceFault: The status is not 0: the watchdog has stopped the discs, or a fault.
        """
        if self._status:
            raise DeviceFault(
                f"the board reports status {self._status:#x} (expected 0; 0x1: its watchdog has "
                "stopped the discs); energise the discs again: repeat the run with --resume",
                status=self._status,
            )

    def unexpired(self) -> str:
        """Return the board's status as text; empty where its watchdog has expired since `arm`."""
        silence = "no status but 0x1 since armed" if self._status else "no sample since armed"
        told = f"status {self._status:#x}" if self._released else silence
        return "" if self._released and self._status & WATCHDOG_EXPIRED else f"board ({told})"

    def command_speeds(self) -> bool:
        """Send the latest commanded speeds of both discs; return whether the link took them."""
        self._feed_at = self._clock.now() + self.profile.feed_interval
        counts = [
            round(self._speeds[disc] * self.profile.counts_per_speed) for disc in ("leg", "ground")
        ]
        return self.send(Kind.DISC_SPEEDS, speed_body(self.profile).pack(*counts))

    def _with_status(self, sample: Sample) -> Sample:
        """Move the last count of a sample, the board's status, to its `status`, and remember it."""
        *counts, status = sample.counts
        self._status = int(status)
        self._released |= not self._status & WATCHDOG_EXPIRED
        return sample._replace(counts=tuple(counts), status=self._status)

    def _arm(self, disc: str) -> None:
        """Begin to feed the watchdog for a disc; where none is armed yet, clear its stop first."""
        if not self._armed:
            self.send(Kind.STOP)  # releases a board whose watchdog had stopped it
            self._speeds = dict.fromkeys(self._speeds, 0.0)
            self._released = False
        self._armed.add(disc)
        self._status = 0

    def __exit__(self, *exception: object) -> None:
        self._armed.clear()
        with contextlib.suppress(RigError):  # the board's watchdog remains
            self.send(Kind.STOP)
        super().__exit__(*exception)


class BoardDrive:
    """One disc of the board; implements the protocol `rig.device.Drive`.

    Args:
        board: Driver of the board.
        disc: `leg` or `ground`.
    """

    def __init__(self, board: RigBoard, disc: str) -> None:
        self.name = f"{disc} disc"
        self._board = board
        self._disc = disc

    def arm(self, timeout: float) -> None:
        """Command speed 0 and begin to feed the watchdog; clear its stop where no disc is armed.

        `timeout` [s] is not used, because the board does not confirm.
        """
        del timeout
        self._board._arm(self._disc)
        self.set_speed(0.0)

    def set_speed(self, omega: float) -> None:
        """Send an angular speed of the disc [rad/s], and the other disc's latest speed again.

        Raises:
            LimitExceeded: The magnitude of the speed is above the limit, or NaN.
            RigTimeout: The port accepts no bytes within its timeout.
        """
        limit = self._board.limits.speed
        require_within(omega, limit, quantity=f"speed of the {self.name}", unit="rad/s")
        self._board._speeds[self._disc] = omega
        self._board.command_speeds()

    def disarm(self) -> None:
        """Command speed 0; errors of sending are suppressed.

        The board has no command to de-energise. When no disc is armed, its watchdog is not fed.
        """
        self._board._armed.discard(self._disc)
        self._board._speeds[self._disc] = 0.0
        with contextlib.suppress(RigError):  # the board's watchdog remains
            self._board.command_speeds()
