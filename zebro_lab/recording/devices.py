# SPDX-License-Identifier: MIT
"""Open the devices that a command line names, real, simulated or replayed, for recording."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from model.gait.reference import LegReference
from rig.acquisition import Device
from rig.backends import open_legs, open_rig
from rig.device import Sample
from rig.imu.profile import load_imu_profile
from rig.imu.simulated import Attitude, at_rest
from rig.openers import IMU_PROFILE, LEGS_PROFILE, REPLAY, SIMULATED, imu_at, resolve
from rig.profile import shipped_file
from rig.safety import SampleGuard
from rig.slip_rig.decode import decode_board, decode_forces
from rig.slip_rig.imperfections import TYPICAL_RIG, with_load_noise
from rig.slip_rig.profile import RigProfile, load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.sweep import SweepPlan
from rig.twins import simulated_legs, simulated_rig_devices
from rig.zebro.commands import GaitPlayer
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated_legs import SimulatedLegs
from zebro_lab.files.errors import SettingsError
from zebro_lab.recording.replayed import IMU, read_replay
from zebro_lab.robot.gait_argument import GaitRequest, make_gait
from zebro_lab.runs.manifest import RIG
from zebro_lab.runs.profile_streams import LEGS

RIG_PROFILE: Final = "rig-odrive-netft"
PAUSE: Final = 0.053
"""Pause between two reads of a device that sends its time; the system buffers its data meanwhile.
With the recorder's wait it stays well below the 200 ms that a killed run may lack. It is not a
multiple of a usual period, so that samples are read with varying delays; those with the smallest
delays give the clock offset [s]."""
TWIN_SWEEP: Final = SweepPlan(slips=tuple(np.linspace(0.0, 0.9, 16) ** 1.5), duration=1.0)
"""Sweep of a simulated rig: all slips in 16 s at each of four loads."""


@dataclass(frozen=True)
class DevicesRequest:
    """Addresses of the requested devices; None or empty where none is requested.

    Attributes:
        zebro: Address of the robot: `PROFILE@PORT`, `PROFILE@sim`, `sim` or `replay:RUN`.
        imus: Address of each inertial measurement unit, in the form of `zebro`.
        rig: Address of the slip rig, in the form of `zebro`.
        play: Gait whose set-points are sent to the robot; None sends none.
        seed: Seed of the random generator of simulated devices.
    """

    zebro: str | None = None
    imus: Sequence[str] = ()
    rig: str | None = None
    play: LegReference | None = None
    seed: int = 0


@dataclass(frozen=True)
class OpenDevices:
    """Opened devices and the manifest entries that they give.

    Attributes:
        devices: The devices, a stream each.
        profiles: Name and TOML text of each profile, by its name in the run folder.
        constants: Radii of the rig's discs [m]; of a replayed rig all constants of its run, its
            zero offsets included; empty without a rig.
        truth: True parameters of a simulated rig; else empty.
        replayed: Duration of each replayed device, see `Replayed.lasts` [s].
    """

    devices: list[Device] = field(default_factory=list)
    profiles: dict[str, tuple[str, str]] = field(default_factory=dict)
    constants: dict[str, float] = field(default_factory=dict)
    truth: dict[str, Any] = field(default_factory=dict)
    replayed: list[float] = field(default_factory=list)


@contextmanager
def open_devices(request: DevicesRequest) -> Iterator[OpenDevices]:
    """Open every requested device; close each when the body ends, which de-energises its motors.

    Yields:
        The devices, their drivers entered. One IMU is named `imu`, several `imu1`, `imu2`, ...

    Raises:
        SettingsError: No device is requested, a gait is given without a robot or for a replayed
            one, or the rig's profile has neither a board nor a load cell.
        RigError: An address, a profile or a port is invalid.
        ZebroLabError: A replayed run is missing or invalid, see `read_replay`.
    """
    _require_any(request)
    rng = np.random.default_rng(request.seed)
    opened = OpenDevices()
    with ExitStack() as stack:
        # Loops that have to be compiled are compiled here, before a device is opened or served
        twin = _simulated_robot(request, rng)
        bodies: list[Attitude] = [at_rest for _ in request.imus]
        if twin is not None and bodies:
            from rig.zebro.simulated_body import SimulatedBody  # compiled loops are loaded

            bodies = [SimulatedBody(twin) for _ in bodies]
        if request.zebro is not None:
            _add_legs(opened, stack, request, twin, rng)
        names = ["imu"] if len(request.imus) == 1 else [f"imu{i + 1}" for i, _ in
                                                        enumerate(request.imus)]  # fmt: skip
        for name, address, body in zip(names, request.imus, bodies, strict=True):
            _add_imu(opened, stack, name, address, body, rng)
        if request.rig is not None:
            _add_rig(opened, stack, request.rig, rng)
        for device in opened.devices:
            stack.enter_context(device.stream)
        yield opened


def default_gait() -> LegReference:
    """Return the default gait, leg angles over time of half-circle legs, for a simulated robot."""
    return make_gait(GaitRequest(), leg_arc=np.pi).reference


def twin_rig(rng: np.random.Generator) -> SimulatedRig:
    """Return the simulated rig of recordings: typical imperfections, sweeping by `TWIN_SWEEP`."""
    return SimulatedRig(
        plan=TWIN_SWEEP,
        imperfections=with_load_noise(TYPICAL_RIG),
        dynamics=RigDynamics(ripple=0.005),
        rng=rng,
    )


def profile_text(name: str) -> str:
    """Read the TOML text of a profile: of the file `name`, else of the shipped `name.toml`.

    Raises:
        OSError: There is neither, or it cannot be read.
    """
    path = Path(name)
    return (path if path.is_file() else shipped_file(f"{name}.toml")).read_text(encoding="utf-8")


def _require_any(request: DevicesRequest) -> None:
    """Raise `SettingsError` without any device, or without a robot if a gait is to be played."""
    if request.zebro is None and request.rig is None and not request.imus:
        raise SettingsError(
            "no device to record is given; add one or more of them", key="--zebro, --imu, --rig"
        )
    if request.play is not None and request.zebro is None:
        raise SettingsError("no robot to move is given; add --zebro or omit --play", key="--play")


def _simulated_robot(request: DevicesRequest, rng: np.random.Generator) -> SimulatedLegs | None:
    """Return the legs of the requested robot if it is simulated, else None."""
    if request.zebro is None or request.zebro.startswith(REPLAY):
        return None
    name, port = resolve(request.zebro, default=LEGS_PROFILE)
    if port != SIMULATED:
        return None
    gait = request.play or default_gait()
    gait.angles(0.0)  # compiles, see `open_devices`
    return SimulatedLegs(gait, profile=load_leg_profile(name))


def _add_legs(
    opened: OpenDevices,
    stack: ExitStack,
    request: DevicesRequest,
    twin: SimulatedLegs | None,
    rng: np.random.Generator,
) -> None:
    """Add the robot's legs: replayed, simulated (`twin`) or real, and the gait that moves them.

    Without a gait, legs that send their time in packets are read with pauses.

    Raises:
        SettingsError: A replayed robot is to play a gait.
    """
    address, play = str(request.zebro), request.play
    if address.startswith(REPLAY):
        if play is not None:
            raise SettingsError("a replayed robot cannot be moved; omit --play", key="--play")
        _replay(opened, address, LEGS)
        return
    if twin is None:
        legs = open_legs(address)
    else:
        legs = stack.enter_context(simulated_legs(twin, rng=rng))
    profile = legs.profile
    player = None if play is None else GaitPlayer(legs, play, profile)
    opened.devices.append(
        Device(
            legs,
            command=player,
            at_end=None if player is None else legs.stop,
            pause=PAUSE if player is None and profile.layout == "packet" else 0.0,
        )
    )
    opened.profiles[LEGS] = (profile.name, profile_text(resolve(address, default=LEGS_PROFILE)[0]))


def _add_imu(
    opened: OpenDevices,
    stack: ExitStack,
    stream: str,
    address: str,
    attitude: Attitude,
    rng: np.random.Generator,
) -> None:
    """Add an inertial measurement unit: replayed, simulated with an attitude, or real."""
    if address.startswith(REPLAY):
        _replay(opened, address, IMU, name=stream)
        return
    name, _ = resolve(address, default=IMU_PROFILE)
    profile = load_imu_profile(name)
    unit = stack.enter_context(imu_at(address, name=stream, attitude=attitude, rng=rng))
    opened.devices.append(Device(unit, pause=PAUSE))
    opened.profiles[stream] = (profile.name, profile_text(name))


def _add_rig(opened: OpenDevices, stack: ExitStack, address: str, rng: np.random.Generator) -> None:
    """Add the streams of the slip rig: replayed, simulated or real; check forces for limits."""
    if address.startswith(REPLAY):
        _replay(opened, address, RIG)
        return
    name, port = resolve(address, default=RIG_PROFILE)
    profile = load_rig_profile(name)
    if port == SIMULATED:
        rig = twin_rig(rng)
        devices = stack.enter_context(simulated_rig_devices(profile, rig, buffered=True, rng=rng))
        opened.truth["rig"] = rig.description() | {"sweep": asdict(TWIN_SWEEP)}
    else:
        devices = open_rig(address, buffered=True)  # recorded samples control no motion
    check = ForceCheck(profile)
    for device in devices.streams:
        is_drives = device is devices.drives
        opened.devices.append(Device(device) if is_drives else Device(device, check, pause=PAUSE))
    opened.profiles[RIG] = (profile.name, profile_text(name))
    opened.constants.update(radius_leg=profile.radius_leg, radius_ground=profile.radius_ground)


def _replay(opened: OpenDevices, address: str, what: str, *, name: str | None = None) -> None:
    """Add the streams of a recorded run instead of a device, with profile, duration, constants."""
    replayed = read_replay(address, what, name=name)
    opened.devices.extend(Device(stream, pause=PAUSE) for stream in replayed.streams)
    opened.profiles[name or what] = replayed.profile
    opened.replayed.append(replayed.lasts)
    if what == RIG:
        opened.constants.update(replayed.manifest.constants)


class ForceCheck:
    """Limit check of a rig's forces in every sample; called with the samples of a read.

    Args:
        profile: Profile of the rig: axes, scale and limits.

    Raises:
        SettingsError: The profile has neither a board nor a load cell.
    """

    def __init__(self, profile: RigProfile) -> None:
        board, cell, limits = profile.board, profile.load_cell, profile.limits
        if board is not None:
            self._forces = lambda samples: decode_board(board, samples)[0]
        elif cell is not None:
            self._forces = partial(decode_forces, cell)
        else:
            raise SettingsError(
                f"profile '{profile.name}' lacks [board] or [load_cell]", key="--rig"
            )
        self._normal = SampleGuard(limits.normal_force, quantity="normal force", unit="N")
        self._traction = SampleGuard(limits.traction_force, quantity="traction force", unit="N")

    def __call__(self, samples: Sequence[Sample]) -> None:
        """Decode the forces of samples and check them against the profile's limits.

        Args:
            samples: Next samples of the board or the load cell.

        Raises:
            LimitExceeded: Three of the latest five values of a force, also across calls, the last
                one included, are beyond its limit or not finite.
        """
        forces = self._forces(samples)
        self._normal.check_all(forces.normal)
        self._traction.check_all(forces.traction)
