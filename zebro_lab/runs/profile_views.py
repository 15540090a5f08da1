# SPDX-License-Identifier: MIT
"""Make the converters of streams to display messages from the profile that a run folder keeps."""

from pathlib import Path

from rig.imu.profile import load_imu_profile
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.profile import load_leg_profile
from zebro_lab.mcap.stream_views import StreamView, imu_view, legs_view, rig_views
from zebro_lab.runs.manifest import RIG
from zebro_lab.runs.recorded_legs import LEGS


def profile_views(file: Path, stream: str | None = None) -> dict[str, StreamView]:
    """Return the converters of all streams that a profile describes, by the streams' names.

    Args:
        file: Profile in a run folder; its name says of which device.
        stream: Name of an IMU's stream; the profile's when None.

    Raises:
        RigError: The profile is invalid.
    """
    if file.stem == LEGS:
        return {LEGS: legs_view(LEGS, profile=load_leg_profile(str(file)))}
    if file.stem == RIG:
        return rig_views(load_rig_profile(str(file)))
    name = stream or file.stem
    return {name: imu_view(name, profile=load_imu_profile(str(file)))}
