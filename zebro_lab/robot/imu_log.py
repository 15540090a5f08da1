# SPDX-License-Identifier: MIT
"""Read the body's orientation from an IMU table, in SI and in the body frame."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from model.arrays import Array
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable

_QUATERNION: Final = ("qw", "qx", "qy", "qz")
_ANGLES: Final = ("roll", "pitch", "yaw")
_RATE: Final = ("rate_x", "rate_y", "rate_z")
_FORCE: Final = ("force_x", "force_y", "force_z")
IMU_UNITS: Final[Mapping[str, str]] = {
    "t": "s",
    **dict.fromkeys(_QUATERNION, "dimensionless"),
    **dict.fromkeys(_ANGLES, "rad"),
    **dict.fromkeys(_RATE, "rad/s"),
    **dict.fromkeys(_FORCE, "m/s^2"),
}
_NORM_TOLERANCE: Final = 0.05  # of a quaternion's length; files round to a few digits
NEAR_G: Final = 0.15  # of a median specific force from 1, in multiples of g
_MOST_NAMED: Final = 6  # columns that are not read
LARGEST_TILT: Final = 1.0
"""Largest roll or pitch that is believed without a unit [rad]: a walking body stays upright."""
_ADVICE: Final = "delete such rows, or fill them"


@dataclass(frozen=True)
class ImuLog:
    """Orientation, angular rate and specific force of the body over time.

    Attributes:
        t: Time, shape (n,) [s].
        values: Columns quaternion w, x, y, z [-], angular rate x, y, z [rad/s], specific force x,
            y, z [m/s2], shape (n, 10); NaN for a rate or force that the table lacks.
        source: Source stated by the column map or the table; None if not stated.
        files: Files that were read: the table and, if there is one, the column map.
        notes: Notes, one line each.
        has_yaw: Whether the table states a yaw; if not, that of the quaternion is 0.
    """

    t: Array
    values: Array
    source: str | None
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    has_yaw: bool = True


def imu_of_table(table: RawTable, mapping: Columns) -> ImuLog:
    """Convert an IMU table to quaternions, rates and forces; orientation may be roll and pitch.

    Args:
        table: Table with quaternions, or roll and pitch with yaw (0 if missing, with a note); rates
            and forces are optional, NaN if missing.
        mapping: Column map with the canonical names of `IMU_UNITS`.

    Raises:
        DataError: Time or orientation is missing, a cell does not hold a finite number, time does
            not increase, or a quaternion's length is not 1 within 0.05; names the cell. Or, without
            a stated unit, steps of time are unusual, roll or pitch is over `LARGEST_TILT`, or the
            specific force seems to be in g.
    """
    t = mapping.times(table, "t", advice=_ADVICE)
    table.require_increasing(mapping.mapped["t"].name, t)
    quaternion, has_yaw = _orientation(table, mapping)
    rest = [_or_nan(table, mapping, name) for name in (*_RATE, *_FORCE)]
    _require_no_multiples_of_g(table, mapping, rest[3:])
    return ImuLog(
        t,
        np.column_stack([quaternion, *rest]),
        mapping.source or table.source,
        (table.path, *([mapping.file] if mapping.file else [])),
        (*table.notes, *mapping.conversions(table), *_not_read(table, mapping, has_yaw=has_yaw)),
        has_yaw,
    )


def _not_read(table: RawTable, mapping: Columns, *, has_yaw: bool) -> Iterator[str]:
    """Yield a note of a missing yaw, and one of the columns that are mapped to no quantity."""
    if not has_yaw:
        yield f"{table.path.name} has no column of yaw; yaw is not measured"
    known = {column.name for column in mapping.mapped.values()}
    others = [f"'{name}'" for name in table.columns if name not in known]
    if others:
        shown = ", ".join(others[:_MOST_NAMED]) + ", …" * (len(others) > _MOST_NAMED)
        yield (
            f"{table.path.name}: not read: {shown}; if one is an angular rate or a specific force "
            "of the body, map it in [imu.columns] of a columns.toml"
        )


def _orientation(table: RawTable, mapping: Columns) -> tuple[Array, bool]:
    """Return quaternions, shape (n, 4), w first, and whether the table has a yaw.

    They are those of the table, which count as with a yaw, else made of its roll, pitch and yaw by
    R = Rz Ry Rx; without a column of yaw it is 0.

    Raises:
        DataError: There is neither a quaternion nor roll and pitch, or their values are impossible.
    """
    if mapping.has(table, "qw"):
        columns = [_numbers(table, mapping, name) for name in _QUATERNION]
        quaternion = np.column_stack(columns)
        require_unit_quaternions(table, mapping, quaternion)
        return quaternion, True
    if not mapping.has(table, "roll"):
        what = "orientation, roll and pitch or a quaternion qw, qx, qy, qz,"
        raise mapping.missing(table, "roll", what=what)
    roll, pitch = (_numbers(table, mapping, name) for name in ("roll", "pitch"))
    known = mapping.has(table, "yaw")
    yaw = _numbers(table, mapping, "yaw") if known else np.zeros(len(roll))
    _require_radians(table, mapping, np.column_stack([roll, pitch]))
    turned = Rotation.from_euler("ZYX", np.column_stack([yaw, pitch, roll]))
    return turned.as_quat(scalar_first=True), known


def _require_radians(table: RawTable, mapping: Columns, tilt: Array) -> None:
    """Raise `DataError` if roll or pitch exceed `LARGEST_TILT` in radians, but no unit is stated.

    They may be degrees. `tilt` are both angles, shape (n, 2) [rad].
    """
    largest = float(np.max(np.abs(tilt), initial=0.0))
    if largest <= LARGEST_TILT or mapping.states_unit(table, "roll"):
        return
    found = (
        f"roll and pitch go up to {largest:.3g} rad, {np.degrees(largest):.3g} deg, if they are in "
        f"rad; expected at most {LARGEST_TILT:g} rad where their unit is not stated"
    )
    raise mapping.unstated(table, "roll", found, unit="deg", others="pitch and yaw")


def _numbers(table: RawTable, mapping: Columns, name: str) -> Array:
    """Return a column in SI, finite throughout, shape (n,); raise `DataError` otherwise."""
    return mapping.numbers(table, name, what=f"{name} of the body", advice=_ADVICE)


def _or_nan(table: RawTable, mapping: Columns, name: str) -> Array:
    """Return a column as `_numbers`, or NaN throughout if the table lacks it, shape (n,)."""
    if mapping.has(table, name):
        return _numbers(table, mapping, name)
    return np.full(len(table), np.nan)


def _require_no_multiples_of_g(table: RawTable, mapping: Columns, force: list[Array]) -> None:
    """Raise `DataError` if a specific force without a stated unit seems to be in g, not m/s^2.

    That is if the median of its length is that of a body at rest in g, by `is_in_g`.
    """
    columns = [mapping.mapped[name] for name in _FORCE]
    if any(c.unit_stated or table.unit_of(c.name, "m/s^2") is not None for c in columns):
        return
    usual = float(np.median(np.linalg.norm(np.array(force), axis=0)))
    if is_in_g(usual):
        found = (
            f"the specific force is {usual:.3g} m/s^2 in the middle, if it is in m/s^2; expected "
            "about 9.81 of a body on the ground"
        )
        raise mapping.unstated(table, "force_x", found, unit="g", others="force_y and force_z")


def is_in_g(usual: float) -> bool:
    """Return whether a median specific force is that of a body on the ground in multiples of g.

    Args:
        usual: Median length of the specific force in the file's unit; NaN is False.
    """
    return abs(usual - 1.0) < NEAR_G


def require_unit_quaternions(table: RawTable, mapping: Columns, quaternion: Array) -> None:
    """Check that quaternions in any order of their parts, shape (n, 4), have length 1.

    Raises:
        DataError: The length of one differs by more than `_NORM_TOLERANCE`.
    """
    norm = np.linalg.norm(np.clip(quaternion, -1e3, 1e3), axis=1)  # squares of damage overflow
    good = np.abs(norm - 1) <= _NORM_TOLERANCE
    problem = "the quaternion has length {}; expected 1 within {}: is the order of columns right?"
    table.require(
        mapping.mapped["qw"].name, good,
        lambda index: problem.format(f"{norm[index]:.3g}", _NORM_TOLERANCE),
    )  # fmt: skip
