# SPDX-License-Identifier: MIT
"""Convert streams to display messages with the profiles in a run folder."""

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from rig.imu.profile import load_imu_profile
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.profile import load_leg_profile
from zebro_lab.mcap.stream_views import StreamView, imu_view, legs_view, rig_views
from zebro_lab.runs.manifest import RIG, profile_file

IMU: Final = "imu"


def profile_views(file: Path) -> dict[str, StreamView]:
    """Return the converters of all streams that a profile describes, by the streams' names.

    Args:
        file: Profile in a run folder; its name selects the kind: `rig`, `imu…`, else legs.

    Raises:
        RigError: The profile is missing or invalid.
    """
    name = file.stem
    if name == RIG:
        return rig_views(load_rig_profile(str(file)))
    if name.startswith(IMU):
        return {name: imu_view(name, profile=load_imu_profile(str(file)))}
    return {name: legs_view(name, profile=load_leg_profile(str(file)))}


def stored_views(folder: Path, profiles: Iterable[str]) -> dict[str, StreamView]:
    """Return the converters of all streams of a run folder, by the streams' names.

    Args:
        folder: The run folder.
        profiles: Names of the profiles in the run folder, such as `rig` and `imu`.

    Raises:
        RigError: A profile is missing or invalid.
    """
    views: dict[str, StreamView] = {}
    for name in profiles:
        views |= profile_views(profile_file(folder, name))
    return views
