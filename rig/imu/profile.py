# SPDX-License-Identifier: MIT
"""Profile of an inertial measurement unit: conversion between counts and orientation."""

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal, TypeAlias

import numpy as np
import tomlkit
from scipy.spatial.transform import Rotation

from model.arrays import Array
from rig.device import Sample
from rig.profile import SCHEMA, open_profile
from rig.sample_columns import as_columns

NORM_TOLERANCE: Final = 0.05
"""Largest difference of a quaternion's length from 1 [-]."""
FIELDS: Final = 10
"""Number of counts of a sample: quaternion 4, angular rate 3, specific force 3."""
Link: TypeAlias = Literal["serial", "table"]


@dataclass(frozen=True)
class ImuProfile:
    """Profile of an inertial measurement unit: frame layout, scales and mounting.

    Attributes:
        name: Name of the profile: that of its file without suffix.
        baudrate: Line rate; 0 for a table [baud].
        byte_order: Byte order of the counts, of two bytes each.
        quaternion_scale: Counts per 1 of a quaternion component.
        rate_scale: Counts per angular rate [s/rad].
        force_scale: Counts per specific force [s²/m].
        mounting: Quaternion w, x, y, z of the rotation from the sensor's axes to the body's.
        rate: Sample rate [Hz].
        link: `serial`, or `table` for an imported file.
        has_yaw: Whether yaw is measured; if not, that of the quaternion means nothing.
    """

    name: str
    baudrate: int
    byte_order: Literal["little", "big"]
    quaternion_scale: float
    rate_scale: float
    force_scale: float
    mounting: tuple[float, ...]
    rate: float
    link: Link = "serial"
    has_yaw: bool = True

    @property
    def body(self) -> struct.Struct:
        """Layout of a packet's body: quaternion, angular rate and specific force as counts."""
        return struct.Struct(("<" if self.byte_order == "little" else ">") + f"{FIELDS}h")

    def possible(self, counts: tuple[float, ...]) -> bool:
        """Return whether the quaternion (first four counts) has length 1 +/- `NORM_TOLERANCE`."""
        norm = sum(count * count for count in counts[:4]) ** 0.5 / self.quaternion_scale
        return abs(norm - 1) <= NORM_TOLERANCE


@dataclass(frozen=True)
class Orientation:
    """Orientation of the body, with angular rate and specific force in the body's axes.

    Attributes:
        host_time: Time at which the host read each sample, shape (n,) [s].
        device_time: Time at which the unit took each sample, NaN where unknown, shape (n,) [s].
        roll: Roll angle, left side up, shape (n,) [rad].
        pitch: Pitch angle, nose down, shape (n,) [rad].
        yaw: Unwrapped yaw angle from an arbitrary heading, to the left, NaN if not measured, shape
            (n,) [rad].
        angular_rate: Angular velocity of the body, columns x, y, z, shape (n, 3) [rad/s].
        specific_force: Acceleration less that of gravity, hence upward at rest, columns x, y, z,
            shape (n, 3) [m/s²].
    """

    host_time: Array
    device_time: Array
    roll: Array
    pitch: Array
    yaw: Array
    angular_rate: Array
    specific_force: Array


def load_imu_profile(name: str) -> ImuProfile:
    """Read the profile of an inertial measurement unit.

    Args:
        name: Name of a shipped profile, or path of a TOML file.

    Returns:
        The profile.

    Raises:
        ProfileError: The file is missing or not such a profile; or a key is missing, unknown or
            invalid.
    """
    table = open_profile(name, device="imu")
    link, frame, scale, mounting, stream = (
        table.table(key) for key in ("link", "frame", "scale", "mounting", "stream")
    )
    kind: Link = link.choice("kind", ("serial", "table"))
    quaternion = mounting.numbers("quaternion", 4)
    if abs(sum(part * part for part in quaternion) - 1) > NORM_TOLERANCE:
        raise mounting.fault(f"found {list(quaternion)}; expected length 1", "quaternion")
    profile = ImuProfile(
        name=Path(name).stem,
        baudrate=0 if kind == "table" else link.whole("baudrate", least=1, most=20_000_000),
        byte_order="little" if kind == "table" else frame.choice("byte_order", ("little", "big")),
        quaternion_scale=scale.positive("quaternion"),
        rate_scale=scale.positive("angular_rate"),
        force_scale=scale.positive("specific_force"),
        mounting=quaternion,
        rate=stream.positive("rate"),
        link=kind,
        has_yaw=link.flag("yaw", default=True) if kind == "table" else True,
    )
    table.finish()
    return profile


def render_table_profile(rate: float, *, has_yaw: bool = True) -> str:
    """Format as TOML the profile of orientation imported from a table in SI and the body's axes.

    Args:
        rate: Sample rate [Hz].
        has_yaw: Whether the table has a yaw.
    """
    document = {
        "schema": SCHEMA,
        "device": "imu",
        "link": {"kind": "table", "yaw": has_yaw},
        "scale": {"quaternion": 1.0, "angular_rate": 1.0, "specific_force": 1.0},
        "mounting": {"quaternion": [1.0, 0.0, 0.0, 0.0]},
        "stream": {"rate": rate},
    }
    return tomlkit.dumps(document)


def decode_orientation(profile: ImuProfile, samples: Sequence[Sample]) -> Orientation:
    """Compute roll, pitch and yaw of the body, R = R_z(yaw) R_y(pitch) R_x(roll), from raw counts.

    Args:
        profile: Profile of the unit.
        samples: Samples of the unit, in order.

    Returns:
        Orientation, angular rate and specific force of the body, corrected for the mounting.
    """
    columns = as_columns(samples)
    counts = columns.counts.reshape(-1, FIELDS)
    mounting = Rotation.from_quat(profile.mounting, scalar_first=True)
    measured = Rotation.from_quat(_unit(counts[:, :4]), scalar_first=True)
    yaw, pitch, roll = (measured * mounting.inv()).as_euler("ZYX").T
    return Orientation(
        host_time=columns.host_time,
        device_time=columns.device_time,
        roll=roll,
        pitch=pitch,
        yaw=np.unwrap(yaw) if profile.has_yaw else np.full(len(yaw), np.nan),
        angular_rate=_turned(mounting, counts[:, 4:7] / profile.rate_scale),
        specific_force=_turned(mounting, counts[:, 7:] / profile.force_scale),
    )


def encode_orientation(
    profile: ImuProfile, rotation: Rotation, angular_rate: Array, specific_force: Array
) -> tuple[int, ...]:
    """Compute the counts of one reading; the inverse of `decode_orientation` but for rounding.

    Args:
        profile: Profile of the unit.
        rotation: Rotation from the body's axes to the inertial frame.
        angular_rate: Angular velocity in the body's axes, shape (3,) [rad/s].
        specific_force: Acceleration less gravity in the body's axes, shape (3,) [m/s²].

    Returns:
        Ten counts, rounded and clipped to 16 bits: quaternion w, x, y, z, rate, force.
    """
    mounting = Rotation.from_quat(profile.mounting, scalar_first=True)
    values = np.concatenate([
        profile.quaternion_scale * (rotation * mounting).as_quat(scalar_first=True),
        profile.rate_scale * mounting.inv().apply(angular_rate),
        profile.force_scale * mounting.inv().apply(specific_force),
    ])  # fmt: skip
    return tuple(int(count) for count in np.clip(np.rint(values), -32_768, 32_767))


def _turned(mounting: Rotation, vectors: Array) -> Array:
    """Rotate vectors, shape (n, 3); one with an axis that is not measured only by no rotation."""
    if mounting.magnitude() == 0:  # else a NaN of one axis would make all three NaN
        return vectors
    return mounting.apply(vectors)


def _unit(quaternions: Array) -> Array:
    return quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
