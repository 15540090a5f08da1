# SPDX-License-Identifier: MIT
"""Read poses over time from a table with the columns of `track.csv` or `path.csv`."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.counted import counted
from model.errors import DomainError
from model.joint_covariance import JointCovariance
from model.poses import Poses
from zebro_lab.files.errors import DataError
from zebro_lab.files.folder_manifest import changed_output
from zebro_lab.files.replacement import recover
from zebro_lab.tables.columns import MappedColumn
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.folder import MANIFEST, TRACK_CSV, read_track_manifest
from zebro_lab.track.joint_file import read_joint
from zebro_lab.track.trajectory.table import COVARIANCE

FEWEST = 3  # a start, which is not scored, and two poses to score
_NAMES = (("t_s", "t"), ("x_m", "x"), ("y_m", "y"))
_YAW = ("yaw_rad", "yaw")


@dataclass(frozen=True)
class TrackFile:
    """Tracked poses with their covariance, source and notes.

    Attributes:
        poses: Poses with their covariance, None if unknown; yaw NaN where the table has none.
        source: Source of the poses as stated, such as "real" or "sim:what"; else "unknown".
        file: The table file.
        notes: Notes on missing yaw or covariance and from reading, one line each.
    """

    poses: Poses
    source: str
    file: Path
    notes: tuple[str, ...] = ()

    @property
    def joint(self) -> JointCovariance:
        """Covariance of x, y [m] and yaw [rad] of all poses, zero if unknown."""
        known = self.poses.joint
        none = np.zeros((len(self.poses), 3, 3))
        return JointCovariance.independent(none) if known is None else known

    @property
    def covariance(self) -> Array:
        """Covariance of x, y [m], yaw [rad] of each pose, zero if unknown, shape (n, 3, 3)."""
        return self.joint.marginal


def read_track(path: Path) -> TrackFile:
    """Read tracked poses from a table or a track folder.

    Args:
        path: A table with `t_s,x_m,y_m`, or `t,x,y`, perhaps `yaw_rad` (or `yaw`) and the upper
            triangle of a covariance, all of `cov_xx` to `cov_yawyaw`; or the folder of a
            `track.csv`.

    Raises:
        NotFound: The table file does not exist.
        DataError: The table, its joint covariance or the manifest beside it is damaged, a column is
            missing, a cell holds no finite number, time does not increase, a covariance has a
            negative eigenvalue, or there are fewer than `FEWEST` poses.
    """
    recover(path)
    file = path / TRACK_CSV if path.is_dir() else path
    track = track_of_table(read_table_file(file))
    changed = (f"WARNING: {each}" for each in changed_output(file))
    return replace(track, notes=(*changed, *track.notes))


def track_of_table(table: RawTable) -> TrackFile:
    """Convert a table with the columns of `read_track` to poses; validate them.

    The source is the table's, else that in the manifest beside a `track.csv`, else "unknown".

    Raises:
        DataError: As in `read_track`.
    """
    file = table.path
    poses = _poses(table, file)
    if len(poses) < FEWEST:
        raise DataError(
            f"has {counted(len(poses), 'pose')}; expected {FEWEST} or more, since the first "
            "only starts the prediction: take photographs more often, or walk for longer",
            file=file,
        )
    notes = [] if poses.has_yaw else [f"{file.name} has no column yaw_rad; yaw is not scored"]
    has_covariance = all(name in table.columns for name in COVARIANCE)
    if not has_covariance:
        notes.append(f"{file.name} has no full covariance; its poses are taken as exact")
    if has_covariance:
        joint, doubts = _joint(table, poses)
        poses, notes = replace(poses, joint=joint), [*notes, *doubts]
    source = table.source or _tracked_source(file) or "unknown"
    return TrackFile(poses, source, file, (*table.notes, *notes))


def _joint(table: RawTable, poses: Poses) -> tuple[JointCovariance, tuple[str, ...]]:
    """Return the joint covariance of all poses, and notes.

    It is read from the file beside a `track.csv` with yaw; without that file, errors of different
    poses are independent.
    """
    covariance = _covariance(table)
    if table.path.name == TRACK_CSV and poses.has_yaw:
        return read_joint(table.path, poses.t, covariance)
    return JointCovariance.independent(covariance), ()


def _tracked_source(file: Path) -> str | None:
    """Return the source in the manifest beside a `track.csv`, "unknown" if it states none.

    None for a file of another name, or without a manifest beside it.
    """
    if file.name != TRACK_CSV or not (file.parent / MANIFEST).is_file():
        return None
    return str(read_track_manifest(file.parent).get("source", "unknown"))


def read_poses(file: Path) -> Poses:
    """Read poses from a table with the columns of `read_track`; ignore covariance.

    Raises:
        NotFound: The file does not exist.
        DataError: The table is damaged or has no rows, a column is missing, a cell holds no finite
            number, or time does not increase.
    """
    return _poses(read_table_file(file), file)


def tum_lines(poses: Poses) -> str:
    """Format poses as TUM trajectory, `t x y z qx qy qz qw` a line; z is 0, unknown yaw is 0."""
    yaw = np.nan_to_num(poses.yaw)
    return "".join(
        f"{t:.6f} {x:.6f} {y:.6f} 0 0 0 {np.sin(half):.9f} {np.cos(half):.9f}\n"
        for t, (x, y), half in zip(poses.t, poses.position, yaw / 2, strict=True)
    )


def _poses(table: RawTable, file: Path) -> Poses:
    """Convert columns of time, x and y to poses; yaw is unwrapped, NaN without its column.

    Raises:
        DataError: A column is missing, a cell holds no finite number, time does not increase, or
            there are no rows.
    """
    si_units = ("s", "m", "m")
    t, x, y = (
        _numbers(table, _present(table, names), unit)
        for names, unit in zip(_NAMES, si_units, strict=True)
    )
    table.require_increasing(_present(table, _NAMES[0]), t)
    yaw_name = next((name for name in _YAW if name in table.columns), None)
    yaw = np.full(len(t), np.nan) if yaw_name is None else _numbers(table, yaw_name, "rad")
    try:
        return Poses(t, np.column_stack([x, y]), np.unwrap(yaw))
    except DomainError as error:
        raise DataError(str(error), file=file) from error


def _present(table: RawTable, names: Sequence[str]) -> str:
    """Return the first of two accepted names that the table has; `DataError` without either."""
    for name in names:
        if name in table.columns:
            return name
    columns = ", ".join(table.columns)
    raise table.fault(f"missing; expected {names[0]} or {names[1]}, found {columns}", names[0])


def _numbers(table: RawTable, name: str, si_unit: str) -> Array:
    """Return a column in SI, from the unit that the file states for it, if it states one.

    Raises:
        DataError: A cell is not a finite number.
    """
    values = MappedColumn(name, si_unit).in_unit_of(table, si_unit).in_si(table)
    table.require_finite(name, values, "a finite number: leave such poses out")
    return values


def _covariance(table: RawTable) -> Array:
    """Read the covariance of x, y and yaw of each pose, shape (n, 3, 3).

    Raises:
        DataError: An eigenvalue is negative, below -1e-9, which is more than rounding.
    """
    upper = np.column_stack([_numbers(table, *each) for each in COVARIANCE.items()])
    covariance = np.empty((len(upper), 3, 3))
    for k, (i, j) in enumerate(zip(*np.triu_indices(3), strict=True)):
        covariance[:, i, j] = covariance[:, j, i] = upper[:, k]
    smallest = np.linalg.eigvalsh(covariance).min(axis=1)
    if np.any(smallest < -1e-9):
        problem = "the covariance of this pose has a negative eigenvalue; expected none"
        raise table.fault(problem, "cov_xx", int(np.argmin(smallest)))
    return covariance
