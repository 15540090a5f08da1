# SPDX-License-Identifier: MIT
"""Name the streams that the profiles in a run folder describe, and their counts and units."""

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from rig.imu.profile import ImuProfile, load_imu_profile
from rig.slip_rig.profile import (
    BoardProfile,
    DriveProfile,
    LoadCellProfile,
    RigProfile,
    load_rig_profile,
)
from rig.zebro.profile import LegProfile, load_leg_profile
from zebro_lab.mcap.raw_log import COUNTS_NAME, VALUES_NAME, RawStream
from zebro_lab.runs.manifest import RIG, profile_file

IMU: Final = "imu"
LEGS: Final = "legs"


def profile_streams(file: Path) -> dict[str, RawStream]:
    """Describe the counts and units of each stream of a profile for a log, by the stream's name.

    Args:
        file: Profile in a run folder; its name selects the kind: `rig`, `imu…`, else legs.

    Raises:
        RigError: The profile is missing or invalid.
    """
    name = file.stem
    if name == RIG:
        return rig_streams(load_rig_profile(str(file)))
    if name.startswith(IMU):
        return {name: imu_stream(load_imu_profile(str(file)))}
    return {name: legs_stream(load_leg_profile(str(file)))}


def stored_streams(folder: Path, profiles: Iterable[str]) -> dict[str, RawStream]:
    """Describe the counts and units of each stream of a run for a log, by the stream's name.

    Args:
        folder: The run folder.
        profiles: Names of the profiles in the run folder, such as `rig` and `imu`.

    Raises:
        RigError: A profile is missing or invalid.
    """
    streams: dict[str, RawStream] = {}
    for name in profiles:
        streams |= profile_streams(profile_file(folder, name))
    return streams


def legs_stream(profile: LegProfile) -> RawStream:
    """Describe the raw samples of legs."""
    schema = VALUES_NAME if profile.layout == "table" else COUNTS_NAME
    return RawStream(schema, {
        "counts": ", ".join(f"leg_{leg}" for leg in profile.legs),
        "unit": f"1/{profile.counts_per_revolution} turn",
        "zero": ", ".join(f"{count:g}" for count in profile.zero_counts),
        "sign": ", ".join(map(str, profile.sign)),
    })  # fmt: skip


def imu_stream(profile: ImuProfile) -> RawStream:
    """Describe the raw samples of an inertial unit."""
    return RawStream(VALUES_NAME if profile.needs_doubles else COUNTS_NAME, {
        "counts": ", ".join(name for name, _ in profile.record),
        "unit": f"quaternion 1/{profile.quaternion_scale:g}, angle 1/{profile.angle_scale:g} rad, "
        f"rate 1/{profile.rate_scale:g} rad/s, force 1/{profile.force_scale:g} m/s2",
    })  # fmt: skip


def rig_streams(profile: RigProfile) -> dict[str, RawStream]:
    """Describe those of the streams `board`, `drives` and `load_cell` that a slip rig has."""
    streams: dict[str, RawStream] = {}
    if profile.board is not None:
        streams["board"] = _board(profile.board)
    if profile.drives is not None:
        streams["drives"] = _drives(profile.drives)
    if profile.load_cell is not None:
        streams["load_cell"] = _load_cell(profile.load_cell)
    return streams


def _board(profile: BoardProfile) -> RawStream:
    """Describe the raw samples of the rig's board, which measures forces and speeds."""
    return RawStream(VALUES_NAME if profile.link == "table" else COUNTS_NAME, {
        "counts": "normal force, traction force, speed of leg disc, speed of ground disc",
        "unit": f"1/{profile.counts_per_force:g} N (signs {profile.normal_sign}, "
        f"{profile.traction_sign}), 1/{profile.counts_per_speed:g} rad/s",
    })  # fmt: skip


def _drives(profile: DriveProfile) -> RawStream:
    """Describe the raw samples of the motor drives of both discs."""
    discs = {"leg_disc": profile.leg, "ground_disc": profile.ground}
    return RawStream(VALUES_NAME, {
        "counts": "motor position, motor velocity",
        "unit": "turn, turn/s",
        "channels": ", ".join(f"{drive.node} {disc}" for disc, drive in discs.items()),
        "turns of the motor in one of the disc": ", ".join(
            f"{drive.sign * drive.gear:g}" for drive in discs.values()
        ),
    })  # fmt: skip


def _load_cell(profile: LoadCellProfile) -> RawStream:
    """Describe the raw samples of the load cell, and which of its axes are the two forces."""
    return RawStream(COUNTS_NAME, {
        "counts": "Fx, Fy, Fz, Tx, Ty, Tz",
        "unit": f"1/{profile.counts_per_force:g} N for the forces",
        "normal force": _axis(profile.normal.sign, profile.normal.index),
        "traction force": _axis(profile.traction.sign, profile.traction.index),
    })  # fmt: skip


def _axis(sign: int, index: int) -> str:
    """Return the name of a load cell's axis with its sign, such as "-Fz" for index 2."""
    return f"{'+' if sign > 0 else '-'}F{'xyz'[index]}"
