# SPDX-License-Identifier: MIT
"""Table of the driver of each device profile; a driver is imported only when it is used."""

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Stream
from rig.errors import ProfileError
from rig.profile import split_address

if TYPE_CHECKING:
    from rig.imu.profile import ImuProfile
    from rig.imu.stream import ImuStream
    from rig.slip_rig.board import RigBoard
    from rig.slip_rig.drives import DriveBus
    from rig.slip_rig.load_cell import NetFtCell
    from rig.slip_rig.profile import RigProfile
    from rig.zebro.profile import LegProfile

LEG_DRIVERS: Final = {
    "packet": "rig.zebro.serial:PacketLegs",
    "can": "rig.zebro.can:CanLegs",
    "dump": "rig.zebro.registers:DumpLegs",
    "poll": "rig.zebro.registers:PolledLegs",
}
"""Driver of each layout of a leg stream."""


def open_legs(address: str, *, name: str = "legs", clock: Clock = SYSTEM_CLOCK) -> Any:
    """Return the driver of a robot's leg stream; entering it opens the port.

    Args:
        address: `PROFILE@PORT`; for CAN the port is `INTERFACE:CHANNEL`.
        name: Name of the stream.
        clock: Host time.

    Returns:
        A `Stream` that also takes `LegCommands`.

    Raises:
        ProfileError: The address or the profile is invalid.
    """
    from rig.zebro.profile import load_leg_profile

    profile_name, port = split_address(address)
    profile = load_leg_profile(profile_name)
    return leg_driver(profile, leg_link(profile, port, clock=clock), name=name, clock=clock)


def leg_link(
    profile: "LegProfile", port: str, *, source: str = "real", clock: Clock = SYSTEM_CLOCK
) -> Any:
    """Return the serial or CAN link that a leg profile names.

    Args:
        profile: The profile.
        port: Port of the link.
        source: `real`, or `sim:WHAT` where a twin serves the port.
        clock: Host time.

    Returns:
        A `SerialLink` or a `CanLink`.

    Raises:
        ProfileError: The profile describes a table, not a device.
    """
    _require_device(profile)
    if profile.layout == "can":
        from rig.links.can import CanLink

        return CanLink(port, bitrate=profile.baudrate, source=source, clock=clock)
    from rig.links.serial import SerialLink

    return SerialLink(port, baudrate=profile.baudrate, source=source, clock=clock)


def leg_driver(
    profile: "LegProfile", link: Any, *, name: str = "legs", clock: Clock = SYSTEM_CLOCK
) -> Any:
    """Return the driver for the layout of a leg profile, over a given link.

    Args:
        profile: The profile.
        link: A `CanLink` for the layout `can`, else a `ByteLink`.
        name: Name of the stream.
        clock: Host time.

    Returns:
        A `Stream` that also takes `LegCommands`.

    Raises:
        ProfileError: The profile describes a table, not a device.
    """
    _require_device(profile)
    module, _, driver = LEG_DRIVERS[profile.layout].partition(":")
    return getattr(import_module(module), driver)(link, profile=profile, name=name, clock=clock)


def _require_device(profile: "LegProfile") -> None:
    if profile.layout not in LEG_DRIVERS:
        raise ProfileError(
            f"has the layout '{profile.layout}', of a file and no device; name a device's profile",
            file=profile.name,
        )


def open_imu(address: str, *, name: str = "imu", clock: Clock = SYSTEM_CLOCK) -> "ImuStream":
    """Return the driver of an inertial measurement unit; entering it opens the port.

    Args:
        address: `PROFILE@PORT`.
        name: Name of the stream.
        clock: Host time.

    Returns:
        The driver.

    Raises:
        ProfileError: The address or the profile is invalid.
    """
    from rig.imu.profile import load_imu_profile
    from rig.imu.stream import ImuStream
    from rig.links.serial import SerialLink

    profile_name, port = split_address(address)
    profile: ImuProfile = load_imu_profile(profile_name)
    if profile.link == "table":
        raise ProfileError("is of a file and no device; name a device's profile", file=profile.name)
    link = SerialLink(port, baudrate=profile.baudrate, clock=clock)
    return ImuStream(link, profile=profile, name=name, clock=clock)


@dataclass(frozen=True)
class RigDevices:
    """The devices of a slip rig, not yet opened: either drives and load cell, or a board.

    Attributes:
        profile: Profile of the rig.
        drives: Both drives; None where there is a board.
        load_cell: The load cell; None where there is a board.
        board: The board; None where there are drives.
    """

    profile: "RigProfile"
    drives: "DriveBus | None" = None
    load_cell: "NetFtCell | None" = None
    board: "RigBoard | None" = None

    @property
    def streams(self) -> tuple[Stream, ...]:
        """All devices, as streams to be entered and read."""
        return tuple(s for s in (self.drives, self.load_cell, self.board) if s is not None)


def open_rig(address: str, *, buffered: bool = False, clock: Clock = SYSTEM_CLOCK) -> RigDevices:
    """Return the drivers of a slip rig; entering each opens it.

    Args:
        address: `PROFILE@PORT`; the port is the drives' `INTERFACE:CHANNEL`, or the board's.
        buffered: Let the load cell send many records per packet, see `NetFtCell`.
        clock: Host time.

    Returns:
        The devices.

    Raises:
        ProfileError: The address or the profile is invalid, or the profile describes a table.
    """
    from rig.slip_rig.profile import load_rig_profile, require_device

    profile_name, port = split_address(address)
    profile = load_rig_profile(profile_name)
    require_device(profile)
    if profile.board is not None:
        from rig.links.serial import SerialLink
        from rig.slip_rig.board import RigBoard

        link = SerialLink(port, baudrate=profile.board.baudrate, clock=clock)
        board = RigBoard(link, profile=profile.board, limits=profile.limits, clock=clock)
        return RigDevices(profile, board=board)
    return _drives_and_cell(profile, port, buffered, clock)


def _drives_and_cell(profile: "RigProfile", port: str, buffered: bool, clock: Clock) -> RigDevices:
    from rig.links.can import CanLink
    from rig.links.udp import UdpLink
    from rig.slip_rig.drives import DriveBus
    from rig.slip_rig.load_cell import NetFtCell

    if profile.drives is None or profile.load_cell is None:
        raise ProfileError(f"profile '{profile.name}' has neither a board nor drives and load cell")
    bus = CanLink(port, bitrate=profile.drives.bitrate, clock=clock)
    datagrams = UdpLink(profile.load_cell.host, profile.load_cell.port, clock=clock)
    return RigDevices(
        profile,
        drives=DriveBus(bus, profile=profile.drives, limits=profile.limits, clock=clock),
        load_cell=NetFtCell(datagrams, profile=profile.load_cell, buffered=buffered, clock=clock),
    )
