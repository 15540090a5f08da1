# SPDX-License-Identifier: MIT
"""Profile of an inertial measurement unit: layout of its records, counts to orientation."""

import math
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

import numpy as np
import tomlkit

from model.arrays import Array
from model.toml_table import TomlTable
from rig.device import Sample
from rig.driver_table import IMUS
from rig.links.packet import LONGEST_BODY
from rig.profile import SCHEMA, open_profile
from rig.sample_columns import as_columns

if TYPE_CHECKING:  # commands of devices that are no such units start without it
    from scipy.spatial.transform import Rotation

NORM_TOLERANCE: Final = 0.05
"""Largest difference from 1 of a measured quaternion's length, and of the mounting's squared length
[-]."""
QUATERNION: Final = tuple(f"quaternion_{axis}" for axis in "wxyz")
ANGLES: Final = ("roll", "pitch", "yaw")
RATE: Final = tuple(f"angular_rate_{axis}" for axis in "xyz")
FORCE: Final = tuple(f"specific_force_{axis}" for axis in "xyz")
UNUSED: Final = "unused"
"""Name of a count of a record that means nothing here, such as a temperature."""
TYPES: Final = {"int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f"}
"""Types of counts in a record, as `struct` spells them."""
Record = tuple[tuple[str, str], ...]
DEFAULT_RECORD: Final[Record] = tuple((name, "int16") for name in QUATERNION + RATE + FORCE)
"""Record of a profile that states none: ten counts of 16 bits."""


@dataclass(frozen=True)
class ImuProfile:
    """Profile of an inertial measurement unit: layout of its records, scales and mounting.

    Attributes:
        name: Name of the profile: that of its file without suffix.
        baudrate: Line rate; 0 for a table [baud].
        byte_order: Byte order of the counts.
        quaternion_scale: Counts per 1 of a quaternion component.
        rate_scale: Counts per angular rate [s/rad].
        force_scale: Counts per specific force [s²/m].
        mounting: Quaternion w, x, y, z of the rotation from the sensor's axes to the body's.
        rate: Sample rate [Hz].
        layout: Layout of the frames, a key of `rig.driver_table.IMUS`, which has its driver.
        has_yaw: Whether yaw is measured; if not, that of the quaternion means nothing.
        record: Name and type of each count of a record, in order. Orientation is a quaternion, or
            roll and pitch, with or without yaw; angular rate and specific force may be missing.
        angle_scale: Counts per roll, pitch or yaw [1/rad].
    """

    name: str
    baudrate: int
    byte_order: Literal["little", "big"]
    quaternion_scale: float
    rate_scale: float
    force_scale: float
    mounting: tuple[float, ...]
    rate: float
    layout: str = "packet"
    has_yaw: bool = True
    record: Record = DEFAULT_RECORD
    angle_scale: float = 1.0

    @property
    def body(self) -> struct.Struct:
        """Layout of a packet's body: the counts of a record."""
        order = "<" if self.byte_order == "little" else ">"
        return struct.Struct(order + "".join(TYPES[kind] for _, kind in self.record))

    @property
    def needs_doubles(self) -> bool:
        """Whether counts may not fit into int32: of a table, or a record with such types."""
        kinds = {kind for _, kind in self.record}
        return self.layout == "table" or not kinds.isdisjoint({"float32", "uint32"})

    def columns(self, names: Sequence[str]) -> list[int]:
        """Return the places of counts in a record; empty if the record lacks one of them."""
        known = [name for name, _ in self.record]
        return [known.index(name) for name in names] if set(names) <= set(known) else []

    def possible(self, counts: tuple[float, ...]) -> bool:
        """Return whether counts are finite and a quaternion has length 1 +/- `NORM_TOLERANCE`."""
        if not all(map(math.isfinite, counts)):
            return False
        if not (places := self.columns(QUATERNION)):
            return True
        norm = sum(counts[place] ** 2 for place in places) ** 0.5 / self.quaternion_scale
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
    layout = "table" if link.choice("kind", ("serial", "table")) == "table" else frame.choice(
        "layout", tuple(name for name in IMUS if name != "table"), "packet"
    )  # fmt: skip
    record = _record(frame)
    named = {name for name, _ in record}
    quaternion = mounting.numbers("quaternion", 4)
    if abs(sum(part * part for part in quaternion) - 1) > NORM_TOLERANCE:
        raise mounting.fault(f"found {list(quaternion)}; expected length 1", "quaternion")
    profile = ImuProfile(
        name=Path(name).stem,
        baudrate=0 if layout == "table" else link.whole("baudrate", least=1, most=20_000_000),
        byte_order="little" if layout == "table" else frame.choice("byte_order", ("little", "big")),
        quaternion_scale=scale.positive("quaternion") if named.issuperset(QUATERNION) else 1.0,
        rate_scale=scale.positive("angular_rate") if named.issuperset(RATE) else 1.0,
        force_scale=scale.positive("specific_force") if named.issuperset(FORCE) else 1.0,
        mounting=quaternion,
        rate=stream.positive("rate"),
        layout=layout,
        has_yaw=(
            link.flag("yaw", default=True)
            if layout == "table"
            else bool(named & {"yaw", "quaternion_w"})
        ),
        record=record,
        angle_scale=1.0 if named.issuperset(QUATERNION) else scale.positive("angle"),
    )
    table.finish()
    return profile


def _record(frame: TomlTable) -> Record:
    """Read the counts of a record, `NAME` or `NAME:TYPE` each; `DEFAULT_RECORD` if none are given.

    Names and types must be known, each name is there once at most but for `UNUSED`, and there must
    be a whole quaternion, or roll and pitch.
    """
    if "record" not in frame:
        return DEFAULT_RECORD
    pairs = tuple(text.partition(":") for text in frame.texts("record"))
    record = tuple((name, kind or "int16") for name, _, kind in pairs)
    names = [name for name, _ in record if name != UNUSED]
    known = (*QUATERNION, *ANGLES, *RATE, *FORCE)
    wrong = [name for name in names if name not in known or names.count(name) > 1]
    wrong += [kind for _, kind in record if kind not in TYPES]
    if wrong:
        raise frame.fault(
            f"found '{wrong[0]}'; expected each of {', '.join(known)} once at most, and "
            f"'{UNUSED}', with one of the types {', '.join(TYPES)}, as in 'roll:float32'",
            "record",
        )
    if not set(names).issuperset(QUATERNION) and not {"roll", "pitch"} <= set(names):
        raise frame.fault("has no orientation; add quaternion_w to _z, or roll and pitch", "record")
    if struct.calcsize("<" + "".join(TYPES[kind] for _, kind in record)) > LONGEST_BODY:
        raise frame.fault(f"is longer than {LONGEST_BODY} bytes, the longest packet", "record")
    return record


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
    body, rate, force = _decode_motion(profile, columns.counts.reshape(-1, len(profile.record)))
    yaw, pitch, roll = body.as_euler("ZYX").T
    return Orientation(
        host_time=columns.host_time,
        device_time=columns.device_time,
        roll=roll,
        pitch=pitch,
        yaw=np.unwrap(yaw) if profile.has_yaw else np.full(len(yaw), np.nan),
        angular_rate=rate,
        specific_force=force,
    )


def _decode_motion(profile: ImuProfile, counts: Array) -> tuple["Rotation", Array, Array]:
    """Compute rotations from the body's axes to the inertial frame, and motion in these axes.

    Args:
        profile: Profile of the unit.
        counts: Counts of the records, shape (n, counts of a record).

    Returns:
        The rotations; angular rate [rad/s] and specific force [m/s²], shape (n, 3) each, NaN where
        the unit does not measure them.
    """
    from scipy.spatial.transform import Rotation

    mounting = Rotation.from_quat(profile.mounting, scalar_first=True)
    places = profile.columns(QUATERNION)
    if places:
        quaternions = counts[:, places] / np.linalg.norm(counts[:, places], axis=1, keepdims=True)
        measured = Rotation.from_quat(quaternions, scalar_first=True)
    else:
        angles = np.zeros((len(counts), 3))  # yaw, pitch, roll
        for column, name in enumerate(("yaw", "pitch", "roll")):
            for place in profile.columns([name]):
                angles[:, column] = counts[:, place] / profile.angle_scale
        measured = Rotation.from_euler("ZYX", angles)
    vectors = []
    for names, scale in ((RATE, profile.rate_scale), (FORCE, profile.force_scale)):
        places = profile.columns(names)
        vector = counts[:, places] / scale if places else np.full((len(counts), 3), np.nan)
        vectors.append(_turned(mounting, vector))
    return measured * mounting.inv(), vectors[0], vectors[1]


def encode_orientation(
    profile: ImuProfile, rotation: "Rotation", angular_rate: Array, specific_force: Array
) -> tuple[float, ...]:
    """Compute the counts of one record; the inverse of `decode_orientation` but for rounding.

    Args:
        profile: Profile of the unit.
        rotation: Rotation from the body's axes to the inertial frame.
        angular_rate: Angular velocity in the body's axes, shape (3,) [rad/s].
        specific_force: Acceleration less gravity in the body's axes, shape (3,) [m/s²].

    Returns:
        The counts of the profile's record, whole ones rounded and clipped to their type; 0 for an
        unused one.
    """
    from scipy.spatial.transform import Rotation

    mounting = Rotation.from_quat(profile.mounting, scalar_first=True)
    sensor = rotation * mounting
    parts = (
        (QUATERNION, profile.quaternion_scale * sensor.as_quat(scalar_first=True)),
        (ANGLES[::-1], profile.angle_scale * sensor.as_euler("ZYX")),
        (RATE, profile.rate_scale * mounting.inv().apply(angular_rate)),
        (FORCE, profile.force_scale * mounting.inv().apply(specific_force)),
    )
    values: Mapping[str, float] = {
        name: value for names, part in parts for name, value in zip(names, part, strict=True)
    }
    return tuple(_as_count(float(values.get(name, 0.0)), kind) for name, kind in profile.record)


def _turned(mounting: "Rotation", vectors: Array) -> Array:
    """Rotate vectors from the sensor's axes to the body's, shape (n, 3).

    A NaN, of an axis that is not measured, makes all three NaN unless the mounting is no rotation.
    """
    if mounting.magnitude() == 0:  # multiplying by its zeros would spread a NaN as well
        return vectors
    return mounting.apply(vectors)


def _as_count(value: float, kind: str) -> float:
    """Round and clip a value to the range of an integer type; leave it as it is for `float32`."""
    if kind == "float32":
        return value
    limits = np.iinfo(kind)
    return int(np.clip(round(value), limits.min, limits.max))
