# SPDX-License-Identifier: MIT
"""Simulated devices in real time behind the real drivers, which `sim` in place of a port selects.

Each context manager serves a twin and yields its driver, not yet entered, whose `source` says that
it is simulated. To let other programs reach a twin, serve a byte twin such as `robot_twin` with
`rig.links.serve.PortServer` and print its port.
"""

import itertools
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, Final

import can
import numpy as np

from model.gait.reference import LegReference
from rig.backends import RigDevices, leg_driver, leg_link
from rig.errors import ProfileError
from rig.imu.profile import ImuProfile
from rig.imu.simulated import PERFECT_UNIT, Attitude, ImuImperfections, SimulatedImu, rocking
from rig.imu.stream import ImuStream
from rig.links.byte_link import ByteTwin
from rig.links.can import CanLink
from rig.links.faults import PERFECT_LINE, Faults
from rig.links.serial import SerialLink
from rig.links.serve import PortServer, Ticker
from rig.links.udp import UdpLink
from rig.slip_rig.board import RigBoard
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.profile import (
    BoardProfile,
    DriveProfile,
    LoadCellProfile,
    RigProfile,
    require_device,
)
from rig.slip_rig.simulated import SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.zebro.profile import LegProfile
from rig.zebro.simulated import CanRobot, DumpRobot, PacketRobot, PolledRobot
from rig.zebro.simulated_legs import EXACT_ROBOT, RobotImperfections, SimulatedLegs

BYTE_ROBOTS: Final = {"packet": PacketRobot, "dump": DumpRobot, "poll": PolledRobot}
_channels = itertools.count()


def robot_twin(
    profile: LegProfile,
    reference: LegReference,
    *,
    imperfections: RobotImperfections = EXACT_ROBOT,
    faults: Faults = PERFECT_LINE,
    rng: np.random.Generator,
) -> ByteTwin:
    """Return the byte twin of a robot on a serial link.

    Args:
        profile: Counts, layout and rate of the robot.
        reference: Gait that it walks.
        imperfections: Its deviations from the gait.
        faults: Transmission errors of the line.
        rng: Random generator.

    Returns:
        The twin.

    Raises:
        ProfileError: The profile's robot is on a CAN bus, not on a serial line.
    """
    if profile.layout not in BYTE_ROBOTS:
        raise ProfileError(
            f"a robot of the layout '{profile.layout}' has no serial port; serve it on a bus",
            file=profile.name,
        )
    legs = SimulatedLegs(reference, profile=profile, imperfections=imperfections, rng=rng)
    return BYTE_ROBOTS[profile.layout](legs, faults=faults, rng=rng)


@contextmanager
def simulated_legs(
    profile: LegProfile,
    reference: LegReference,
    *,
    imperfections: RobotImperfections = EXACT_ROBOT,
    faults: Faults = PERFECT_LINE,
    rng: np.random.Generator,
    name: str = "legs",
) -> Iterator[Any]:
    """Serve a simulated robot of any layout and yield its driver.

    Args:
        profile: Counts, layout and rate of the robot.
        reference: Gait that it walks.
        imperfections: Its deviations from the gait.
        faults: Transmission errors of the line.
        rng: Random generator.
        name: Name of the stream.

    Yields:
        A `Stream` that also takes `LegCommands`.
    """
    if profile.layout == "can":
        channel = _new_channel()
        legs = SimulatedLegs(reference, profile=profile, imperfections=imperfections, rng=rng)
        with can.Bus(interface="virtual", channel=channel) as bus:
            robot = CanRobot(legs, bus, faults=faults, rng=rng)
            with Ticker(robot.poll):
                yield leg_driver(
                    profile, leg_link(profile, f"virtual:{channel}", source="sim:zebro"), name=name
                )
        return
    twin = robot_twin(profile, reference, imperfections=imperfections, faults=faults, rng=rng)
    with PortServer(twin) as server:
        yield leg_driver(profile, leg_link(profile, server.port, source=twin.source), name=name)


@contextmanager
def simulated_imu(
    profile: ImuProfile,
    attitude: Attitude = rocking,
    *,
    imperfections: ImuImperfections = PERFECT_UNIT,
    faults: Faults = PERFECT_LINE,
    rng: np.random.Generator,
    name: str = "imu",
) -> Iterator[ImuStream]:
    """Serve a simulated inertial measurement unit and yield its driver.

    Args:
        profile: Scale of the counts, mounting and rate of the unit.
        attitude: Motion of the body that carries it.
        imperfections: Its noise and drift.
        faults: Transmission errors of the line.
        rng: Random generator.
        name: Name of the stream.

    Yields:
        The driver.
    """
    twin = SimulatedImu(
        attitude, profile=profile, imperfections=imperfections, faults=faults, rng=rng
    )
    with PortServer(twin) as server:
        link = SerialLink(server.port, baudrate=profile.baudrate, source=twin.source)
        yield ImuStream(link, profile=profile, name=name)


@contextmanager
def simulated_rig_devices(
    profile: RigProfile,
    rig: SimulatedRig,
    *,
    watchdog: float = 0.2,
    buffered: bool = False,
    faults: Faults = PERFECT_LINE,
    rng: np.random.Generator,
) -> Iterator[RigDevices]:
    """Serve a simulated slip rig and yield its drivers.

    Args:
        profile: The rig's profile.
        rig: The simulated rig; it runs its own sweep until a drive is commanded.
        watchdog: Silence after which drives or board stop the discs [s].
        buffered: Let the load cell send many records per packet, see `NetFtCell`.
        faults: Transmission errors of the load cell's or the board's line.
        rng: Random generator of the transmission errors.

    Yields:
        The drivers, not yet entered.

    Raises:
        ProfileError: The profile has neither a board nor drives and load cell, or describes a
            table.
    """
    require_device(profile)
    if profile.board is not None:
        with _board(profile, profile.board, rig, watchdog, faults, rng) as devices:
            yield devices
    elif profile.drives is not None and profile.load_cell is not None:
        with _drives_and_cell(
            profile, profile.drives, profile.load_cell, rig, watchdog, buffered, faults, rng
        ) as devices:
            yield devices
    else:
        raise ProfileError(f"profile '{profile.name}' has neither a board nor drives and load cell")


@contextmanager
def _board(
    profile: RigProfile,
    board: BoardProfile,
    rig: SimulatedRig,
    watchdog: float,
    faults: Faults,
    rng: np.random.Generator,
) -> Iterator[RigDevices]:
    twin = SimulatedBoard(rig, profile=board, watchdog=watchdog, faults=faults, rng=rng)
    with PortServer(twin) as server:
        link = SerialLink(server.port, baudrate=board.baudrate, source=twin.source)
        yield RigDevices(profile, board=RigBoard(link, profile=board, limits=profile.limits))


@contextmanager
def _drives_and_cell(
    profile: RigProfile,
    drives: DriveProfile,
    load_cell: LoadCellProfile,
    rig: SimulatedRig,
    watchdog: float,
    buffered: bool,
    faults: Faults,
    rng: np.random.Generator,
) -> Iterator[RigDevices]:
    channel = _new_channel()
    with ExitStack() as stack:
        bus = stack.enter_context(can.Bus(interface="virtual", channel=channel))
        axes = SimulatedDrives(rig, bus, profile=drives, watchdog=watchdog)
        cell = stack.enter_context(
            SimulatedLoadCell(rig, profile=load_cell, faults=faults, rng=rng)
        )

        def tick(now: float) -> None:
            axes.poll(now)
            cell.poll(now)

        stack.enter_context(Ticker(tick))
        link = CanLink(f"virtual:{channel}", source=axes.source)
        datagrams = UdpLink(cell.host, cell.port, source=cell.source)
        yield RigDevices(
            profile,
            drives=DriveBus(link, profile=drives, limits=profile.limits),
            load_cell=NetFtCell(datagrams, profile=load_cell, buffered=buffered),
        )


def _new_channel() -> str:
    return f"zebro-lab-twin-{next(_channels)}"
