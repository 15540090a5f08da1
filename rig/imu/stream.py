# SPDX-License-Identifier: MIT
"""Orientation from an inertial measurement unit in this project's own packets."""

from rig.clock import SYSTEM_CLOCK, Clock
from rig.imu.profile import ImuProfile
from rig.links.byte_link import ByteLink
from rig.links.packet import Kind
from rig.links.packet_stream import PacketStream


class ImuStream(PacketStream):
    """Stream of an inertial measurement unit; implements the protocol `rig.device.Stream`.

    Args:
        link: Bytes from the unit.
        profile: Profile of the unit.
        name: Name of the stream; each of several units needs its own.
        clock: Host time.
    """

    def __init__(
        self,
        link: ByteLink,
        *,
        profile: ImuProfile,
        name: str = "imu",
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        super().__init__(
            link,
            name=name,
            kind=Kind.ORIENTATION,
            body=profile.body,
            rate=profile.rate,
            possible=profile.possible,
            clock=clock,
        )
        self.profile = profile
