# SPDX-License-Identifier: MIT
"""Leg angles from a bridge board in this project's own packets."""

from rig.clock import SYSTEM_CLOCK, Clock
from rig.links.byte_link import ByteLink
from rig.links.packet import Kind
from rig.links.packet_stream import PacketStream
from rig.zebro.commands import leave_still, milliseconds
from rig.zebro.profile import LegProfile


class PacketLegs(PacketStream):
    """Stream of the layout `packet`; implements the protocols `Stream` and `LegCommands`.

    Leaving the driver stops legs that it has moved; those that it only read go on.

    Args:
        link: Bytes to and from the bridge.
        profile: Profile of the robot, of the layout `packet`.
        clock: Host time.
    """

    def __init__(self, link: ByteLink, *, profile: LegProfile, clock: Clock = SYSTEM_CLOCK) -> None:
        super().__init__(
            link,
            name="legs",
            kind=Kind.LEGS,
            body=profile.words(6),
            rate=profile.rate,
            possible=profile.possible,
            clock=clock,
        )
        self.profile = profile
        self._moved = False

    def __exit__(self, *exception: object) -> None:
        if self._moved:
            leave_still(self)
        super().__exit__(*exception)

    def set_points(self, counts: tuple[int, ...], duration: float) -> bool:
        """Send the command to turn every leg to a count; see `LegCommands.set_points`.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].

        Returns:
            Whether the link took the command.
        """
        body = self.profile.words(7).pack(*counts, milliseconds(duration))
        self._moved = True
        return self.send(Kind.LEG_SET_POINTS, body)

    def stop(self) -> bool:
        """Send the command to stop every leg where it is; return whether the link took it."""
        return self.send(Kind.STOP)
