# SPDX-License-Identifier: MIT
"""Serve simulated devices at ports that any program can open."""

import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias, cast

import can
import numpy as np
import tomlkit

from model.gait.reference import LegReference
from rig.imu.profile import load_imu_profile
from rig.imu.simulated import SimulatedImu
from rig.links.byte_link import ByteTwin
from rig.links.faults import Faults
from rig.links.serve import PortServer, Ticker
from rig.links.slcan import SlcanAdapter
from rig.openers import LEGS_PROFILE
from rig.slip_rig.profile import BoardProfile, device_profiles, load_rig_profile
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.twins import rig_on_bus, robot_twin
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated import CanRobot
from rig.zebro.simulated_body import SimulatedBody
from rig.zebro.simulated_legs import SimulatedLegs
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.recording.devices import default_gait, profile_text, twin_rig
from zebro_lab.recording.request import ImuTwinRequest, RigTwinRequest, ZebroTwinRequest
from zebro_lab.runs.legs import read_leg_log

TwinRequest: TypeAlias = ZebroTwinRequest | ImuTwinRequest | RigTwinRequest


@dataclass(frozen=True)
class Served:
    """Simulated device that is being served.

    Attributes:
        source: Source of the device's data, `sim:WHAT`.
        places: Port of each part of the device, by the name of the part.
        address: `PROFILE@PORT` under which a driver finds the device; the profile may be a
            temporary file.
    """

    source: str
    places: dict[str, str]
    address: str


def serve(request: TwinRequest) -> AbstractContextManager[Served]:
    """Serve a simulated device while the context lasts.

    A robot, on a port or a CAN bus, walks the requested leg angles or the default gait; so does the
    one that carries an IMU. A slip rig is a board, or drives and load cell, whose address names a
    temporary profile with the port of the load cell.

    Raises:
        RigError: The profile or the port is invalid, or the profile of a rig has neither a board
            nor drives with a load cell.
        ZebroLabError: The leg angles to walk cannot be read.
    """
    if isinstance(request, ZebroTwinRequest):
        return _zebro(request)
    return _imu(request) if isinstance(request, ImuTwinRequest) else _rig(request)


@contextmanager
def _zebro(request: ZebroTwinRequest) -> Iterator[Served]:
    """Serve a walking robot on a CAN bus, if that is its profile's layout, else on a port."""
    profile = load_leg_profile(request.profile)
    rng = np.random.default_rng(0)
    gait = _gait(request.play)
    faults = Faults(drop=request.drop)
    if profile.layout == "can":
        legs = SimulatedLegs(gait, profile=profile)
        with _bus(request, "sim:zebro") as (bus, place):
            robot = CanRobot(legs, bus, faults=faults, rng=rng)
            with Ticker(robot.poll):
                yield Served(robot.source, {"robot": place}, f"{request.profile}@{place}")
        return
    twin = robot_twin(profile, gait, faults=faults, rng=rng)
    with _port(twin, request) as port:
        yield Served(twin.source, {"robot": port}, f"{request.profile}@{port}")


@contextmanager
def _imu(request: ImuTwinRequest) -> Iterator[Served]:
    """Serve the IMU of a walking robot on a port."""
    rng = np.random.default_rng(0)
    legs = SimulatedLegs(_gait(request.play), profile=load_leg_profile(LEGS_PROFILE))
    faults = Faults(drop=request.drop)
    twin = SimulatedImu(
        profile=load_imu_profile(request.profile), attitude=SimulatedBody(legs), faults=faults,
        rng=rng,
    )  # fmt: skip
    with _port(twin, request) as port:
        yield Served(twin.source, {"imu": port}, f"{request.profile}@{port}")


@contextmanager
def _rig(request: RigTwinRequest) -> Iterator[Served]:
    """Serve the slip rig: a board on a port, or drives on a CAN bus and a load cell by UDP."""
    profile = load_rig_profile(request.profile)
    found = device_profiles(profile)
    rng = np.random.default_rng(0)
    rig, faults = twin_rig(rng), Faults(drop=request.drop)
    if isinstance(found, BoardProfile):
        board = SimulatedBoard(rig, profile=found, faults=faults, rng=rng)
        with _port(board, request) as port:
            yield Served(board.source, {"board": port}, f"{request.profile}@{port}")
        return
    with (
        _bus(request, "sim:rig") as (bus, place),
        rig_on_bus(rig, found, bus, faults=faults, rng=rng) as cell,
        _profile_of_cell(request.profile, cell) as file,
    ):
        places = {"drives": place, "load cell": f"udp://{cell.host}:{cell.port}"}
        yield Served(cell.source, places, f"{file}@{place}")


def _gait(play: Path | None) -> LegReference:
    """Return the leg angles of a walk folder, table or run; the default gait for None."""
    return default_gait() if play is None else read_leg_log(play).reference


@contextmanager
def _profile_of_cell(name: str, cell: SimulatedLoadCell) -> Iterator[Path]:
    """Yield a temporary copy of profile `name`, with host and port of the simulated load cell."""
    document = tomlkit.parse(profile_text(name))
    load_cell = cast("dict[str, object]", document["load_cell"])
    load_cell |= {"host": cell.host, "port": cell.port}
    with tempfile.TemporaryDirectory(prefix="zebro-lab-twin-") as folder:
        file = Path(folder) / f"{Path(name).stem}.toml"
        atomic_write_text(file, tomlkit.dumps(document))
        yield file


@contextmanager
def _port(twin: ByteTwin, request: TwinRequest) -> Iterator[str]:
    """Serve a twin at a pseudo-terminal or TCP port; yield the name of the port."""
    with PortServer(twin, as_socket=request.as_socket) as server:
        yield server.port


@contextmanager
def _bus(request: TwinRequest, source: str) -> Iterator[tuple[can.BusABC, str]]:
    """Open a virtual CAN bus behind a simulated SLCAN adapter.

    Args:
        request: Options.
        source: Origin of the data that the adapter passes on, "sim:WHAT".

    Yields:
        The bus, and the name by which a driver opens it, "slcan:PORT".

    Raises:
        LinkError: The system provides no port for the adapter.
    """
    channel = f"zebro-lab-adapter-{id(request)}"
    with (
        can.Bus(interface="virtual", channel=channel) as bus,
        can.Bus(interface="virtual", channel=channel) as far,
        _port(SlcanAdapter(far, source=source), request) as port,
    ):
        yield bus, f"slcan:{port}"
