# SPDX-License-Identifier: MIT
"""Simulated devices in real time behind the real drivers, which `sim` instead of a port selects.

Each context manager serves a twin and yields its driver, not yet entered, whose `source` says that
it is simulated. To let other programs reach a twin, serve a byte twin such as `robot_twin` with
`rig.links.serve.PortServer` and print its port.
"""

import itertools
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import can
import numpy as np

from model.gait.reference import LegReference
from rig.backends import (
    RigDevices,
    board_devices,
    bus_devices,
    imu_driver,
    leg_driver,
    leg_link,
)
from rig.driver_table import IMUS, LEGS, load_class
from rig.errors import ProfileError
from rig.imu.profile import ImuProfile
from rig.imu.simulated import Attitude, at_rest
from rig.links.byte_link import ByteTwin
from rig.links.can import CanLink
from rig.links.faults import PERFECT_LINE, Faults
from rig.links.serial import SerialLink
from rig.links.serve import PortServer, Ticker
from rig.links.udp import UdpLink
from rig.slip_rig.profile import (
    BoardProfile,
    DriveProfile,
    LoadCellProfile,
    RigProfile,
    device_profiles,
)
from rig.slip_rig.simulated import SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.zebro.profile import LegProfile
from rig.zebro.simulated_legs import SimulatedLegs

_channels = itertools.count()
"""Numbers for the names of virtual CAN buses."""


def _byte_robot(
    legs: SimulatedLegs, *, faults: Faults = PERFECT_LINE, rng: np.random.Generator
) -> ByteTwin:
    """Return the twin of legs on a serial line.

    Raises:
        ProfileError: The layout of the legs' profile is `can` or `table`.
    """
    layout, name = legs.profile.layout, legs.profile.name
    if LEGS[layout].link == "can":
        raise ProfileError(f"no serial port carries layout '{layout}'", file=name)
    return load_class(LEGS[layout].twin, profile=name)(legs, faults=faults, rng=rng)


def robot_twin(
    profile: LegProfile,
    reference: LegReference,
    *,
    faults: Faults = PERFECT_LINE,
    rng: np.random.Generator,
) -> ByteTwin:
    """Return a simulated robot on a serial line, as a byte twin that is not served yet.

    Args:
        profile: Counts, layout and rate of the robot.
        reference: Gait that the robot walks until it is commanded.
        faults: Transmission errors of the line.
        rng: Random generator of the transmission errors.

    Returns:
        The twin.

    Raises:
        ProfileError: The profile's layout is `can` or `table`, which no serial line carries.
    """
    return _byte_robot(SimulatedLegs(reference, profile=profile), faults=faults, rng=rng)


@contextmanager
def simulated_legs(legs: SimulatedLegs, *, rng: np.random.Generator) -> Iterator[Any]:
    """Serve simulated legs at a virtual CAN bus or a port, and yield their driver.

    Args:
        legs: The legs, whose profile's layout decides between bus and port.
        rng: Random generator of transmission errors.

    Yields:
        A `Stream` that also takes `LegCommands`, not yet entered.

    Raises:
        ProfileError: The layout of the legs' profile is `table`.
        LinkError: The system provides no port.
    """
    profile = legs.profile
    if LEGS[profile.layout].link == "can":
        channel = _new_channel()
        with can.Bus(interface="virtual", channel=channel) as bus:
            robot = load_class(LEGS[profile.layout].twin, profile=profile.name)(legs, bus, rng=rng)
            with Ticker(robot.poll):
                link = leg_link(profile, f"virtual:{channel}", source=robot.source)
                yield leg_driver(profile, link)
        return
    twin = _byte_robot(legs, rng=rng)
    with PortServer(twin) as server:
        yield leg_driver(profile, leg_link(profile, server.port, source=twin.source))


@contextmanager
def simulated_imu(
    profile: ImuProfile,
    *,
    attitude: Attitude = at_rest,
    rng: np.random.Generator,
    name: str = "imu",
) -> Iterator[Any]:
    """Serve a simulated inertial measurement unit at a port, and yield its driver.

    Args:
        profile: Scale of the counts, mounting and rate of the unit.
        attitude: Attitude of the body that carries the unit, by the host's time.
        rng: Random generator of transmission errors.
        name: Name of the stream.

    Yields:
        The driver, not yet entered.

    Raises:
        ProfileError: The layout of the unit's profile is `table`.
        LinkError: The system provides no port.
    """
    unit = load_class(IMUS[profile.layout].twin, profile=profile.name)
    twin = unit(profile=profile, attitude=attitude, rng=rng)
    with PortServer(twin) as server:
        yield imu_driver(profile, server.port, name=name, source=twin.source)


@contextmanager
def simulated_rig_devices(
    profile: RigProfile,
    rig: SimulatedRig,
    *,
    watchdog: float = 0.2,
    buffered: bool = False,
    rng: np.random.Generator,
) -> Iterator[RigDevices]:
    """Serve a simulated slip rig in real time and yield its drivers.

    Args:
        profile: Profile of the rig; decides between a board, and drives with a load cell.
        rig: Simulated discs and contact; they run their own sweep until a drive is commanded.
        watchdog: Time without a command after which drives or board stop the discs [s].
        buffered: Let the load cell send many records per datagram, see `NetFtCell`.
        rng: Random generator of the transmission errors.

    Yields:
        The drivers, not yet entered.

    Raises:
        ProfileError: The profile has neither a board nor drives and load cell, or describes a
            table.
        LinkError: The system provides no port for a board.
    """
    found = device_profiles(profile)
    if isinstance(found, BoardProfile):
        twin = SimulatedBoard(rig, profile=found, watchdog=watchdog, rng=rng)
        with PortServer(twin) as server:
            serial = SerialLink(server.port, baudrate=found.baudrate, source=twin.source)
            yield board_devices(profile, found, serial)
        return
    channel = _new_channel()
    with (
        can.Bus(interface="virtual", channel=channel) as bus,
        rig_on_bus(rig, found, bus, watchdog=watchdog, rng=rng) as cell,
    ):
        link = CanLink(f"virtual:{channel}", source=cell.source)
        datagrams = UdpLink(cell.host, cell.port, source=cell.source)
        yield bus_devices(profile, found, link, datagrams, buffered=buffered)


@contextmanager
def rig_on_bus(
    rig: SimulatedRig,
    profiles: tuple[DriveProfile, LoadCellProfile],
    bus: can.BusABC,
    *,
    watchdog: float = 0.2,
    faults: Faults = PERFECT_LINE,
    rng: np.random.Generator,
) -> Iterator[SimulatedLoadCell]:
    """Serve drives on a CAN bus and a load cell at a UDP port.

    Args:
        rig: Simulated discs and contact.
        profiles: Profiles of drives and load cell.
        bus: The bus, open.
        watchdog: Time without a command after which drives stop the discs [s].
        faults: Transmission errors of the load cell's datagrams.
        rng: Random generator of the transmission errors.

    Yields:
        The load cell, which knows its host and port.
    """
    drives = SimulatedDrives(rig, bus, profile=profiles[0], watchdog=watchdog)
    with SimulatedLoadCell(rig, profile=profiles[1], faults=faults, rng=rng) as cell:

        def tick(now: float) -> None:
            """Poll drives and load cell, which simulates the rig up to a time."""
            drives.poll(now)
            cell.poll(now)

        with Ticker(tick):
            yield cell


def _new_channel() -> str:
    """Return a channel name for a virtual CAN bus that no other twin of this process has."""
    return f"zebro-lab-twin-{next(_channels)}"
