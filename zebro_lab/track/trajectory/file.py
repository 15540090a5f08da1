# SPDX-License-Identifier: MIT
"""Read a trajectory of another program: TUM, KITTI, EuRoC, a table or a ROS log."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from model.arrays import Array
from model.counted import counted
from model.poses import Poses
from model.rigid_path import RigidPath, plane_axes, rotations_of_quaternions
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.names import is_ros_log
from zebro_lab.mcap.ros_log import bag_files
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.trajectory.layouts import read_number_lines, read_number_table
from zebro_lab.track.trajectory.logged_poses import read_logged_poses
from zebro_lab.track.trajectory.request import Axis, Layout, Plane, TrajectoryRequest, of_file
from zebro_lab.track.trajectory.table import (
    COVARIANCE,
    MAPPED_UNITS,
    QUATERNION,
    read_table_columns,
)

_TILTED = np.radians(5.0)  # a body that leaves the plane by more is told of


@dataclass(frozen=True)
class Trajectory:
    """Trajectory of another program.

    Attributes:
        file: The file.
        layout: Its layout.
        path: Poses in space; z is 0 where it is not known, and times are row numbers without times.
        columns: Columns in SI by canonical name, shape (n,) each.
        rows: The rows of the file that the poses are, for messages.
        plane: Axes that span the floor.
        forward: Axis of the body that points ahead.
        timed: Whether it has times.
        source: Where the poses come from, as stated; else "unknown".
        notes: Notes on how the file was read, one line each.
        files: Every file read.
        topic: Topic of a ROS log that was read; None for any other file.
        covariance: Covariances of x, y, z and the rotations about them, of messages that have
            them, by rows, shape (n, 6, 6) [m, rad]; else None.
    """

    file: Path
    layout: Layout
    path: RigidPath
    columns: Mapping[str, Array]
    rows: RawTable
    plane: Plane
    forward: Axis
    timed: bool = True
    source: str = "unknown"
    notes: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()
    topic: str | None = None
    covariance: Array | None = None

    @property
    def in_space(self) -> bool:
        """Whether z is known."""
        return "z_m" in self.columns

    @property
    def is_planar_table(self) -> bool:
        """Whether it is a table of x, y and perhaps heading, whose columns are the path's."""
        planar = self.layout is Layout.TABLE and self.plane is Plane.XY
        return planar and not set(QUATERNION) <= set(self.columns)

    @property
    def poses(self) -> Poses:
        """Poses in the plane."""
        return self.path.in_plane(self.plane, forward=self.forward)

    @property
    def leaves_plane(self) -> bool:
        """Whether the path extends farther across the plane than in it, in one direction."""
        extent = np.ptp(self.poses.position, axis=0)
        across = float(np.ptp(self.height))
        return across > extent.min() and across > 0.1 * extent.max()

    @property
    def normal(self) -> Array:
        """Unit vector normal to the plane, upwards where the plane is seen from above, (3,) [-]."""
        first, second = plane_axes(self.plane)
        return np.cross(np.eye(3)[first], np.eye(3)[second])

    @property
    def height(self) -> Array:
        """Coordinate along the plane's normal [m]."""
        return self.path.position @ self.normal

    @property
    def planar_covariance(self) -> Mapping[str, Array]:
        """Columns `cov_xx` to `cov_yawyaw` of the covariance in the plane; empty without it."""
        if self.covariance is None:
            return {}
        chosen = np.zeros((3, 6))
        chosen[[0, 1], plane_axes(self.plane)] = 1.0
        chosen[2, 3:] = self.normal  # the heading turns about it
        planar = chosen @ self.covariance @ chosen.T
        upper = zip(COVARIANCE, zip(*np.triu_indices(3), strict=True), strict=True)
        return {name: planar[:, i, j] for name, (i, j) in upper}


def read_trajectory(
    path: Path,
    request: TrajectoryRequest,
    *,
    mapping: Columns | None = None,
    which: int = 0,
    topic: str | None = None,
    topics: Collection[str] = (),
) -> Trajectory:
    """Read a trajectory; its layout is found by its content where the request does not name it.

    Args:
        path: The file.
        request: How to read it.
        mapping: Headers and units of the columns of a table; those that it leaves at their
            canonical names are recognised by their headers.
        which: 0 for the first file of a command, 1 for the second.
        topic: Topic to read from a ROS log; None for one of `topics`, else the only one with poses.
        topics: Topics of a ROS log to prefer, also such of other messages.

    Raises:
        NotFound: A file is missing, or the package that reads a ROS log.
        DataError: The file is damaged or its layout is not known; a stamp is repeated with another
            pose, or earlier than the one before.
        SettingsError: An option does not fit the file.
    """
    mapping = mapping or Columns(MAPPED_UNITS)
    layout, rows, more = _rows(path, request, of_file(request.layout, which), mapping,
                               {"topic": topic, "topics": topics})  # fmt: skip
    is_table = layout is Layout.TABLE
    read = read_table_columns(rows, mapping if is_table else replace(mapping, columns={}, keep=()))
    columns, kept, covariance = read.columns, read.table.kept, more.get("covariance")
    plane = request.plane or (Plane.XZ if layout is Layout.KITTI else Plane.XY)
    if "z_m" not in columns and plane is not Plane.XY:
        raise SettingsError(f"{path} has no column z; leave --plane out", key="--plane")
    if covariance is not None and kept is not None:
        more["covariance"] = covariance[kept]
    zero = np.zeros(len(read.table))
    position = np.column_stack([columns.get(name, zero) for name in ("x_m", "y_m", "z_m")])
    trajectory = Trajectory(
        file=path,
        layout=layout,
        path=RigidPath(columns["t_s"], position, _rotation(columns)),
        columns=columns,
        rows=read.table,
        plane=plane,
        forward=request.forward or (Axis.Z if "z" in plane else Axis.X),
        source=mapping.source or rows.source or "unknown",
        **more,
    )
    notes = [*rows.notes, *read.notes, *_doubts(trajectory)]
    if mapping.keep and not is_table:
        notes.append(
            f"all poses are read; [{mapping.where}rows] keep in {mapping.stated_in} applies to "
            f"tables only, not to {layout}"
        )
    named = (each if each.startswith(path.name) else f"{path.name}: {each}" for each in notes)
    return replace(trajectory, notes=tuple(named))


def _rows(
    path: Path,
    request: TrajectoryRequest,
    layout: Layout | None,
    mapping: Columns,
    topics: Mapping[str, Any],
) -> tuple[Layout, RawTable, dict[str, Any]]:
    """Read layout, table of poses, and what else the file gives of a `Trajectory`, by attribute."""
    if is_ros_log(path):
        for key, wrong in (("--times", request.times is not None),
                           ("--layout", layout not in (None, Layout.ROS))):  # fmt: skip
            if wrong:
                raise SettingsError(f"{path} is a ROS log; leave the option out", key=key)
        logged = read_logged_poses(path, **topics)
        more = {"topic": logged.topic, "covariance": logged.covariance}
        return Layout.ROS, logged.table, {**more, "files": tuple(bag_files(path))}
    if layout is Layout.ROS:
        raise DataError("is no ROS log by its name; expected .mcap, .db3, .bag or a bag's folder, "
                        "or another --layout", file=path)  # fmt: skip
    numbers = read_number_table(path, layout, plane=request.plane)
    if numbers is None:
        files = (path, *([mapping.file] if mapping.file else []))
        return Layout.TABLE, read_table_file(path, sheet=mapping.sheet), {"files": files}
    layout, table = numbers
    if layout is not Layout.KITTI or request.times is None:
        return layout, table, {"files": (path,), "timed": layout is not Layout.KITTI}
    return layout, _with_times(table, request.times), {"files": (path, request.times)}


def _rotation(columns: Mapping[str, Array]) -> Array | None:
    """Return rotations by the quaternion, else by the heading; None without either."""
    if set(QUATERNION) <= set(columns):
        return rotations_of_quaternions(np.column_stack([columns[name] for name in QUATERNION]))
    if "yaw_rad" not in columns:
        return None
    half = columns["yaw_rad"] / 2
    zero = np.zeros_like(half)
    return rotations_of_quaternions(np.column_stack([zero, zero, np.sin(half), np.cos(half)]))


def _with_times(table: RawTable, file: Path) -> RawTable:
    """Return a table of poses with the times of another file, one a line [s]."""
    times = read_number_lines(file)
    if times is None or times.rows.shape[1] != 1:
        raise SettingsError(f"{file} is not a file of one number a line", key="--times")
    if len(times.rows) != len(table):
        raise SettingsError(
            f"{file} has {counted(len(times.rows), 'time')}, {table.path} has "
            f"{counted(len(table), 'pose')}; expected as many of both",
            key="--times",
        )
    t = pd.Series(times.rows[:, 0])
    RawTable(file, {"t_s": t}, header_line=times.line - 1).require_increasing("t_s", t.to_numpy())
    return replace(table, columns={**table.columns, "t_s": t}, units={})


def _doubts(trajectory: Trajectory) -> list[str]:
    """Return notes where rotations leave the plane, and where the path extends across it."""
    plane, notes = trajectory.plane, []
    tilt = float(trajectory.path.tilt(plane).max())
    if tilt > _TILTED:
        notes.append(
            f"rotations leave the plane {plane} by up to {np.degrees(tilt):.1f} deg; the heading "
            f"is the direction of the {trajectory.forward} axis in the plane"
        )
    if trajectory.leaves_plane:
        first, second = np.ptp(trajectory.poses.position, axis=0)
        across = float(np.ptp(trajectory.height))
        notes.append(
            f"the path extends {across:.3g} m across the plane {plane} and {first:.3g} m by "
            f"{second:.3g} m in it; is another --plane meant?"
        )
    return notes
