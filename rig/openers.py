# SPDX-License-Identifier: MIT
"""Open the device that an address names, at a port or as a simulated twin."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

import numpy as np

from model.gait.reference import LegReference
from rig.backends import open_imu, open_legs
from rig.errors import ProfileError
from rig.imu.profile import load_imu_profile
from rig.imu.simulated import Attitude, at_rest
from rig.profile import split_address
from rig.twins import simulated_imu, simulated_legs
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated_legs import SimulatedLegs

SIMULATED: Final = "sim"
"""Name of a simulated twin, instead of a port or of PROFILE@PORT."""
REPLAY: Final = "replay:"
"""Prefix of an address that names a recorded run instead of a device."""
LEGS_PROFILE: Final = "zebro-100-serial"
"""Profile of the robot's legs at the address `sim`."""
IMU_PROFILE: Final = "imu-quaternion-serial"
"""Profile of the inertial measurement unit at the address `sim`."""


def resolve(address: str, *, default: str) -> tuple[str, str]:
    """Split an address into the profile's name and the port; `sim` alone gives (default, `sim`).

    Args:
        address: `PROFILE@PORT`, `PROFILE@sim` or `sim`.
        default: Name of the profile for `sim` alone.

    Returns:
        Name or path of the profile, and port; the port `sim` means a simulated twin.

    Raises:
        ProfileError: Profile or port is missing, or the address is a replay, which has no port.

    >>> resolve("sim", default="zebro-100-serial")
    ('zebro-100-serial', 'sim')
    """
    if address.startswith(REPLAY):
        raise ProfileError(
            f"'{address}' replays a recording, which only `record` accepts; give PROFILE@PORT or "
            "sim instead"
        )
    return (default, SIMULATED) if address == SIMULATED else split_address(address)


@contextmanager
def legs_at(address: str, gait: LegReference, *, rng: np.random.Generator) -> Iterator[Any]:
    """Provide the driver of the robot's legs at an address; the port `sim` serves a twin meanwhile.

    Args:
        address: `PROFILE@PORT`, `PROFILE@sim` or `sim`.
        gait: Gait that a twin walks until it is commanded; a real robot does not use it.
        rng: Random generator of a twin.

    Yields:
        A `Stream` that also takes `LegCommands`, not yet entered.

    Raises:
        ProfileError: The address or the profile is invalid, the profile describes a table, or the
            address is a replay.
        LinkError: The system provides no port for a twin.
    """
    name, port = resolve(address, default=LEGS_PROFILE)
    if port == SIMULATED:
        twin = SimulatedLegs(gait, profile=load_leg_profile(name))
        with simulated_legs(twin, rng=rng) as legs:
            yield legs
    else:
        yield open_legs(address)


@contextmanager
def imu_at(
    address: str, *, name: str, attitude: Attitude = at_rest, rng: np.random.Generator
) -> Iterator[Any]:
    """Provide the driver of an inertial measurement unit; the port `sim` serves a twin meanwhile.

    Args:
        address: `PROFILE@PORT`, `PROFILE@sim` or `sim`.
        name: Name of the stream.
        attitude: Attitude of the body that carries a twin, by the host's time.
        rng: Random generator of a twin.

    Yields:
        The driver, not yet entered.

    Raises:
        ProfileError: The address or the profile is invalid, the profile describes a table, or the
            address is a replay.
        LinkError: The system provides no port for a twin.
    """
    profile, port = resolve(address, default=IMU_PROFILE)
    if port == SIMULATED:
        with simulated_imu(
            load_imu_profile(profile), attitude=attitude, rng=rng, name=name
        ) as unit:
            yield unit
    else:
        yield open_imu(address, name=name)
