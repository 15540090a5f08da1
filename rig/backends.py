# SPDX-License-Identifier: MIT
"""Table of the driver of each device profile; an address gives the profile and the port."""

from dataclasses import dataclass
from typing import Any

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Stream
from rig.driver_table import IMUS, LEGS, load_class
from rig.imu.profile import ImuProfile, load_imu_profile
from rig.links.byte_link import ByteLink
from rig.links.can import CanLink
from rig.links.serial import SerialLink
from rig.links.udp import UdpLink
from rig.profile import split_address
from rig.slip_rig.board import RigBoard
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.profile import (
    BoardProfile,
    DriveProfile,
    LoadCellProfile,
    RigProfile,
    device_profiles,
    load_rig_profile,
)
from rig.zebro.profile import LegProfile, load_leg_profile


def open_legs(address: str) -> Any:
    """Return the driver of a robot's leg stream; entering the driver opens the port.

    Args:
        address: `PROFILE@PORT`; for CAN the port is `INTERFACE:CHANNEL`.

    Returns:
        A `Stream` that also takes `LegCommands`.

    Raises:
        ProfileError: The address or the profile is invalid, or the profile describes a table.
    """
    profile_name, port = split_address(address)
    profile = load_leg_profile(profile_name)
    return leg_driver(profile, leg_link(profile, port))


def leg_link(profile: LegProfile, port: str, *, source: str = "real") -> SerialLink | CanLink:
    """Return the link for a leg profile, CAN or serial; not yet open.

    Args:
        profile: The profile.
        port: Serial port or URL; for CAN `INTERFACE:CHANNEL`.
        source: `real`, or `sim:WHAT` where a twin serves the port.
    """
    if LEGS[profile.layout].link == "can":
        return CanLink(port, bitrate=profile.baudrate, source=source)
    return SerialLink(port, baudrate=profile.baudrate, source=source)


def leg_driver(profile: LegProfile, link: Any, *, clock: Clock = SYSTEM_CLOCK) -> Any:
    """Return the driver for the layout of a leg profile over a given link, neither yet open.

    Args:
        profile: The profile.
        link: A `CanLink` for the layout `can`, else a `ByteLink`.
        clock: Host time.

    Returns:
        A `Stream` that also takes `LegCommands`.

    Raises:
        ProfileError: The profile describes a table, not a device.
    """
    driver = load_class(LEGS[profile.layout].driver, profile=profile.name)
    return driver(link, profile=profile, clock=clock)


def open_imu(address: str, *, name: str = "imu") -> Any:
    """Return the driver of an inertial measurement unit; entering the driver opens the port.

    Args:
        address: `PROFILE@PORT`.
        name: Name of the stream.

    Returns:
        A `Stream` with the unit's `profile`.

    Raises:
        ProfileError: The address or the profile is invalid, or the profile describes a table.
    """
    profile_name, port = split_address(address)
    return imu_driver(load_imu_profile(profile_name), port, name=name)


def imu_driver(profile: ImuProfile, port: str, *, name: str, source: str = "real") -> Any:
    """Return the driver of an inertial measurement unit at a serial port, not yet open.

    Args:
        profile: The profile.
        port: Serial port or URL.
        name: Name of the stream.
        source: `real`, or `sim:WHAT` where a twin serves the port.

    Raises:
        ProfileError: The profile describes a table, not a device.
    """
    driver = load_class(IMUS[profile.layout].driver, profile=profile.name)
    link = SerialLink(port, baudrate=profile.baudrate, source=source)
    return driver(link, profile=profile, name=name)


@dataclass(frozen=True)
class RigDevices:
    """The devices of a slip rig, not yet opened: either drives and load cell, or a board.

    Attributes:
        profile: Profile of the rig.
        drives: Both drives; None where there is a board.
        load_cell: The load cell; None where there is a board.
        board: The board; None where there are drives.
    """

    profile: RigProfile
    drives: DriveBus | None = None
    load_cell: NetFtCell | None = None
    board: RigBoard | None = None

    @property
    def streams(self) -> tuple[Stream, ...]:
        """All devices of the rig as streams: drives and load cell, or the board."""
        return tuple(s for s in (self.drives, self.load_cell, self.board) if s is not None)


def open_rig(address: str, *, buffered: bool = False) -> RigDevices:
    """Return the drivers of a slip rig; entering a driver opens its link.

    Args:
        address: `PROFILE@PORT`; the port is the drives' `INTERFACE:CHANNEL`, or the board's.
        buffered: Let the load cell send many records per datagram, see `NetFtCell`.

    Returns:
        The devices, not yet opened.

    Raises:
        ProfileError: The address or the profile is invalid, or the profile describes a table.
    """
    profile_name, port = split_address(address)
    profile = load_rig_profile(profile_name)
    found = device_profiles(profile)
    if isinstance(found, BoardProfile):
        return board_devices(profile, found, SerialLink(port, baudrate=found.baudrate))
    bus = CanLink(port, bitrate=found[0].bitrate)
    datagrams = UdpLink(found[1].host, found[1].port)
    return bus_devices(profile, found, bus, datagrams, buffered=buffered)


def board_devices(
    profile: RigProfile, board: BoardProfile, link: ByteLink, *, clock: Clock = SYSTEM_CLOCK
) -> RigDevices:
    """Return the board of a rig over a given link, neither yet open."""
    driver = RigBoard(link, profile=board, limits=profile.limits, clock=clock)
    return RigDevices(profile, board=driver)


def bus_devices(
    profile: RigProfile,
    profiles: tuple[DriveProfile, LoadCellProfile],
    bus: CanLink,
    datagrams: UdpLink,
    *,
    buffered: bool = False,
) -> RigDevices:
    """Return drives and load cell of a rig over given links, none yet open, see `open_rig`."""
    return RigDevices(
        profile,
        drives=DriveBus(bus, profile=profiles[0], limits=profile.limits),
        load_cell=NetFtCell(datagrams, profile=profiles[1], buffered=buffered),
    )
