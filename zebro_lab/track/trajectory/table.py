# SPDX-License-Identifier: MIT
"""Convert the columns of a table of poses to SI and check them."""

import re
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.counted import counted
from model.poses import Poses
from model.travel import has_travelled, travel_direction
from zebro_lab.robot.imu_log import require_unit_quaternions
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.row_conditions import kept_rows

NEEDED: Final = ("t_s", "x_m", "y_m")
QUATERNION: Final = ("qx", "qy", "qz", "qw")
POSE_UNITS: Final = {
    "t_s": "s", "x_m": "m", "y_m": "m", "z_m": "m", "yaw_rad": "rad",
    **dict.fromkeys(QUATERNION, "dimensionless"),
}  # fmt: skip
"""SI unit of each column of poses, by canonical name."""
COVARIANCE: Final = {
    "cov_xx": "m^2", "cov_xy": "m^2", "cov_xyaw": "m rad", "cov_yy": "m^2", "cov_yyaw": "m rad",
    "cov_yawyaw": "rad^2",
}  # fmt: skip
FASTEST: Final = 20.0
"""Largest mean speed of a path whose unit of length nobody states [m/s]."""
_LEGS_OF_PATH: Final = 21  # so few that noise does not lengthen the path
_ALIGNED: Final = 0.9  # alignment of heading and travel above which a unit fits the path
_CLEARLY, _LEAST_LACK = 5.0, 0.05  # by which radians must align worse than degrees: factor, offset
_UNITS: Final = {"ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_SINCE_1970: Final = (6.3e8, 4.2e9)
"""Seconds since 1970 of the years 1990 to 2102: no other unit has such numbers for these years."""
_GAPS: Final = (1e-6, 1e4)
"""Range of the median time between poses; outside the unit cannot be right [s]."""
_MOST_REPEATED: Final = 0.01
"""Largest share of rows that repeat a stamp with another pose; beyond, stamps are too coarse."""
MAPPED_UNITS: Final[Mapping[str, str]] = {**POSE_UNITS, "t_sigma": "s", **COVARIANCE}
"""SI unit of each column that `[track.columns]` maps; not every command reads all of them."""
_HEADERS: Final = {
    "t_s": r"t|t_s|time|time_s|time_?stamps?|stamp|sec|seconds",
    **{
        f"{axis}_m": rf"{axis}|{axis}_m|[tp]_?{axis}|(p|pos|position|translation)[_. ]{axis}"
        rf"|p_rs_r_{axis}|(pose\.)*position\.{axis}|(transform\.)?translation\.{axis}"
        for axis in "xyz"
    },
    **{
        f"q{axis}": rf"q_?{axis}|(q|quat|quaternion|rotation|orientation)[_. ]{axis}|q_rs_{axis}"
        rf"|(pose\.)*orientation\.{axis}|(transform\.)?rotation\.{axis}"
        for axis in "xyzw"
    },
    "yaw_rad": r"yaw|yaw_rad",
}  # fmt: skip
"""Regular expression of each canonical column's header, in lower case and without its unit."""
_UNIT: Final = re.compile(r"[\[(][^\])]*[\])]\s*$")


def named_columns(headers: Sequence[str]) -> Mapping[str, str]:
    """Return the header of each column of a trajectory by canonical name; the first if several.

    Headers that `_HEADERS` does not recognise are left out; letter case and units do not matter.

    >>> named_columns(["#timestamp [ns]", "p_RS_R_x [m]"])["t_s"]
    '#timestamp [ns]'
    """
    found: dict[str, str] = {}
    for header in headers:
        word = _UNIT.sub("", header).strip("# ").lower()
        for canonical, pattern in _HEADERS.items():
            if re.fullmatch(pattern, word):
                found.setdefault(canonical, header)
    return found


def read_table_columns(
    table: RawTable, mapping: Columns
) -> tuple[dict[str, Array], RawTable, list[str]]:
    """Convert the columns of a trajectory to SI, and check units, stamps and quaternions.

    Rows without any number of a pose are gaps, as motion-capture systems write them: left out, as
    is all but the first row of a stamp.

    Args:
        table: The table.
        mapping: Headers and units of its columns, see `recognised`; time, x and y are needed.

    Returns:
        Columns by canonical name, shape (n,) each; the rows of the table that they are; and notes.

    Raises:
        DataError: Time, x or y is missing, a cell is no finite number, a unit that nobody states
            cannot be SI, or a stamp is earlier than the one before or, in many rows, repeated with
            another pose.
    """
    mapping = recognised(table, mapping)
    table, notes = _with_poses(table, mapping)
    columns = {}
    for name in MAPPED_UNITS:
        if name in NEEDED or mapping.has(table, name):
            advice = (
                "leave such poses out, of a table by "
                f'[{mapping.where}rows] keep = ["`{mapping.mapped[name].name}` > -1e9"] in '
                f"{mapping.stated_in}"
            )
            columns[name] = mapping.numbers(
                table, name, what=f"{name} of the trajectory", advice=advice
            )
    notes += [*mapping.conversions(table), *_in_seconds(table, mapping, columns)]
    _require_units(table, mapping, columns)
    kept, repeated = _first_of_stamps(table, mapping, columns)
    table, columns = table.part(kept), {name: column[kept] for name, column in columns.items()}
    table.require_increasing(mapping.mapped["t_s"].name, columns["t_s"])
    if set(QUATERNION) <= set(columns):
        quaternion = np.column_stack([columns[name] for name in QUATERNION])
        require_unit_quaternions(table, mapping, quaternion)
    return columns, table, [*notes, *repeated]


def _with_poses(table: RawTable, mapping: Columns) -> tuple[RawTable, list[str]]:
    """Return the rows that `[rows] keep` asks for and that hold a pose, and a note on empty ones.

    A row without any number of a pose is empty; nothing is left out if all are.
    """
    if mapping.keep:
        table = table.part(kept_rows(table, mapping.keep, where=mapping.where))
    headers = [mapping.mapped[name].name for name in POSE_UNITS if name != "t_s"]
    cells = [table.columns[header].isna() for header in headers if header in table.columns]
    empty = np.all(cells, axis=0) if cells else np.zeros(len(table), dtype=bool)
    if not empty.any() or empty.all():
        return table, []
    first = table.row(int(np.argmax(empty)))
    left_out = counted(int(empty.sum()), "empty pose")
    note = f"{table.path.name}: {left_out} left out, the first in row {first}"
    return table.part(np.flatnonzero(~empty)), [note]


def _in_seconds(table: RawTable, mapping: Columns, columns: dict[str, Array]) -> list[str]:
    """Convert stamps whose unit nobody states to seconds if they are times since 1970; note it.

    They are if they are dates from 1990 to 2102 in ms, us or ns; `columns["t_s"]` is replaced.

    Raises:
        DataError: Poses are hours, or less than a microsecond, apart, so that the unit must be
            another.
    """
    time, t, notes = mapping.mapped["t_s"], columns["t_s"], []
    stated = time.in_unit_of(table, "s")
    if stated.factor == 1.0 and time.name not in table.units:
        low, high = _SINCE_1970
        for unit, factor in _UNITS.items():
            if low <= float(np.abs(t).max(initial=0.0)) * factor <= high:
                columns["t_s"] = t = t * factor
                notes = [f"{table.path.name}: stamps are read as times since 1970 in {unit}"]
    gap = abs(float(np.median(np.diff(t)))) if len(t) > 1 else 0.0
    if gap and not _GAPS[0] < gap < _GAPS[1]:
        problem = (
            f"stamps are {gap:.3g} s apart, if they are in {stated.unit}; convert them, or name "
            "their unit in a header such as 'timestamp [ms]'"
        )
        raise table.fault(problem, time.name, 0)
    return notes


def _require_units(table: RawTable, mapping: Columns, columns: Mapping[str, Array]) -> None:
    """Raise `DataError` if headings or positions whose unit nobody states cannot be in SI.

    Headings are degrees if `are_degrees`; positions are not metres if their mean speed is above
    `FASTEST`.
    """
    position = np.column_stack([columns["x_m"], columns["y_m"]])
    heading, x = mapping.mapped["yaw_rad"], mapping.mapped["x_m"]
    unstated = not heading.unit_stated and heading.name not in table.units
    if "yaw_rad" in columns and unstated and are_degrees(columns["yaw_rad"], position):
        largest = float(np.abs(columns["yaw_rad"]).max())
        found = f"the heading goes up to {largest:.4g} rad and fits the path only in degrees"
        raise mapping.unstated(table, "yaw_rad", found, unit="deg")
    at = np.linspace(0, len(position) - 1, _LEGS_OF_PATH).astype(int)
    way = float(np.linalg.norm(np.diff(position[at], axis=0), axis=1).sum())
    speed = way / float(np.ptp(columns["t_s"]) or np.inf)
    if speed > FASTEST and x.name != "x_m" and not mapping.states_unit(table, "x_m"):
        found = (
            f"the path goes at {speed:.3g} m/s, if positions are in m; expected at most "
            f"{FASTEST:g} m/s where their unit is not stated"
        )
        raise mapping.unstated(table, "x_m", found, unit="mm", others="y_m")


def _first_of_stamps(
    table: RawTable, mapping: Columns, columns: Mapping[str, Array]
) -> tuple[NDArray[np.intp], list[str]]:
    """Return the first row of each stamp, and a note on those that are left out.

    Raises:
        DataError: Rows with the stamp of the row before and another pose are more than one plus
            the share `_MOST_REPEATED` of all rows.
    """
    t = columns["t_s"]
    poses = np.column_stack([column for name, column in columns.items() if name != "t_s"])
    same = np.diff(t, prepend=-np.inf) == 0
    moved = same & np.any(np.diff(poses, axis=0, prepend=poses[:1]) != 0, axis=1)
    count = int(moved.sum())
    if count > _MOST_REPEATED * len(t) + 1:
        problem = (
            f"{counted(count, 'row')} with another pose than the row before with the same stamp; "
            "expected increasing stamps: write them with more digits"
        )
        raise table.fault(problem, mapping.mapped["t_s"].name, int(np.argmax(moved)))
    other = f", {count} with another pose, row {table.row(int(np.argmax(moved)))} first"
    note = (
        f"{table.path.name}: {counted(int(same.sum()), 'row')} left out whose stamp is that of the "
        f"row before{other * bool(count)}"
    )
    return np.flatnonzero(~same), [note] * bool(same.any())


def recognised(table: RawTable, mapping: Columns) -> Columns:
    """Map columns that are missing and not mapped in a file to headers that are recognised."""
    for name, header in named_columns(list(table.columns)).items():
        if mapping.mapped[name].name == name and not mapping.has(table, name):
            mapping = mapping.called(name, header)
    return mapping


def are_degrees(heading: Array, position: Array) -> bool:
    """Return whether headings fit the direction of travel in degrees, and not in radians.

    They must exceed 2 pi, be aligned by more than `_ALIGNED` in degrees, and lack in radians over
    `_CLEARLY` times as much of an alignment of 1, plus `_LEAST_LACK`. False for too short a path.

    The alignment is the length of the mean of unit vectors at heading minus direction of travel:
    1 where they differ by a constant, about 0 where they have nothing to do with one another.
    Degrees that grow by 6 to 7 from pose to pose are nearly whole turns as radians, and align well
    too; a heading that stays fits in both units.

    Args:
        heading: Headings as in the file, shape (n,).
        position: Positions in the plane, shape (n, 2) [m].
    """
    if len(heading) == 0 or np.abs(heading).max() <= 2 * np.pi:
        return False
    poses = Poses(np.arange(len(heading), dtype=float), position, heading)
    if not has_travelled(poses):
        return False
    travel = travel_direction(poses)
    in_radians, in_degrees = (
        np.abs(np.exp(1j * (each - travel)).mean()) for each in (heading, np.radians(heading))
    )
    lacking = _CLEARLY * (1 - in_degrees) + _LEAST_LACK
    return bool(in_degrees > _ALIGNED and 1 - in_radians > lacking)
