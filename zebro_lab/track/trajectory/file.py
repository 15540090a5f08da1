# SPDX-License-Identifier: MIT
"""Read a trajectory of another program: TUM, KITTI, EuRoC, a table or a ROS log."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

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
from zebro_lab.track.trajectory.layouts import read_pose_table
from zebro_lab.track.trajectory.logged_poses import read_logged_poses
from zebro_lab.track.trajectory.request import Axis, Layout, Plane, TrajectoryRequest, of_file
from zebro_lab.track.trajectory.table import MAPPED_UNITS, QUATERNION, read_table_columns


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
    """

    file: Path
    layout: Layout
    path: RigidPath
    columns: Mapping[str, Array]
    rows: RawTable
    plane: Plane
    forward: Axis
    timed: bool
    source: str
    notes: tuple[str, ...]
    files: tuple[Path, ...]
    topic: str | None

    @property
    def in_space(self) -> bool:
        """Whether z is known."""
        return "z_m" in self.columns

    @property
    def poses(self) -> Poses:
        """Poses in the plane."""
        return self.path.in_plane(self.plane, forward=self.forward)

    @property
    def leaves_plane(self) -> bool:
        """Whether the path extends farther along the normal than along one axis of the plane.

        An extent along the normal of up to a tenth of the path's longer one does not count.
        """
        extent = np.ptp(self.poses.position, axis=0)
        across = float(np.ptp(self.height))
        return across > extent.min() and across > 0.1 * extent.max()

    @property
    def height(self) -> Array:
        """Coordinate along the plane's normal, upwards where the plane is seen from above [m]."""
        first, second = np.eye(3)[list(plane_axes(self.plane))]
        return self.path.position @ np.cross(first, second)


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
        request: How to read it; its times are those of KITTI files alone.
        mapping: Headers and units of the columns of a table; those that it leaves at their
            canonical names are recognised by their headers.
        which: 0 for the first file of a command, 1 for the second.
        topic: Topic to read from a ROS log; None for one of `topics`, else the only one with poses.
        topics: Topics of a ROS log to prefer; those without poses are ignored.

    Raises:
        NotFound: A file is missing, or the package that reads a ROS log.
        DataError: The file is damaged or its layout is not known; a stamp is earlier than the one
            before; or rows that repeat a stamp with another pose are more than one plus 1 % of all.
        SettingsError: An option does not fit the file.
    """
    mapping = mapping or Columns(MAPPED_UNITS)
    layout = of_file(request.layout, which)
    plane = request.plane or Plane.XY
    files: tuple[Path, ...] = (path,)
    if is_ros_log(path):
        if layout not in (None, Layout.ROS):
            raise SettingsError(f"{path} is a ROS log; leave the option out", key="--layout")
        layout, files = Layout.ROS, bag_files(path)
        topic, table = read_logged_poses(path, plane=plane, topic=topic, topics=topics)
    elif layout is Layout.ROS:
        raise DataError("is no ROS log by its name; expected .mcap, .db3, .bag or a bag's folder, "
                        "or another --layout", file=path)  # fmt: skip
    else:
        layout, table = read_pose_table(path, layout, plane=plane, sheet=mapping.sheet)
        topic = None
    timed = layout is not Layout.KITTI or request.times is not None
    if layout is Layout.KITTI:
        plane = request.plane or Plane.XZ
        if request.times is not None:
            table, files = _with_times(table, request.times), (path, request.times)
    source = mapping.source or table.source or "unknown"
    files = (*files, mapping.file) if mapping.file else files
    named = mapping if layout is Layout.TABLE else replace(mapping, columns={}, keep=())
    columns, rows, notes = read_table_columns(table, named)
    if "z_m" not in columns and plane is not Plane.XY:
        raise SettingsError(f"{path} has no column z; leave --plane out", key="--plane")
    key = "--forward" if request.forward else "--plane" if "z" in plane else None
    if key and "yaw_rad" in columns and not set(QUATERNION) <= set(columns):
        problem = "has a heading of its own, about z and ahead; leave the option out"
        raise SettingsError(f"{path} {problem}", key=key)
    zero = np.zeros(len(rows))
    position = np.column_stack([columns.get(name, zero) for name in ("x_m", "y_m", "z_m")])
    forward = request.forward or (Axis.Z if "z" in plane else Axis.X)
    found = Trajectory(
        path, layout, RigidPath(columns["t_s"], position, _rotation(columns)), columns, rows,
        plane, forward, timed, source, (), files, topic,
    )  # fmt: skip
    notes = [*table.notes, *notes]
    if found.leaves_plane:
        notes.append(
            f"the path extends {np.ptp(found.height):.3g} m across the plane {plane}, farther than "
            "in it; is another --plane meant?"
        )
    named = (each if each.startswith(path.name) else f"{path.name}: {each}" for each in notes)
    return replace(found, notes=tuple(named))


def _rotation(columns: Mapping[str, Array]) -> Array | None:
    """Return rotations, shape (n, 3, 3), by quaternion, else by heading; None without either."""
    if set(QUATERNION) <= set(columns):
        return rotations_of_quaternions(np.column_stack([columns[name] for name in QUATERNION]))
    if "yaw_rad" not in columns:
        return None
    half = columns["yaw_rad"] / 2
    zero = np.zeros_like(half)
    return rotations_of_quaternions(np.column_stack([zero, zero, np.sin(half), np.cos(half)]))


def _with_times(table: RawTable, file: Path) -> RawTable:
    """Return a table of poses with the times of another file, one a line [s].

    Raises:
        SettingsError: The file has several numbers in a line, or not as many lines as there are
            poses.
        DataError: A time is no finite number, or times do not increase.
    """
    times = read_table_file(file, bare=True)
    if len(times.columns) != 1:
        raise SettingsError(f"{file} is not a file of one number a line", key="--times")
    if len(times) != len(table):
        raise SettingsError(
            f"{file} has {counted(len(times), 'time')}, {table.path} has "
            f"{counted(len(table), 'pose')}; expected as many of both",
            key="--times",
        )
    (name,) = times.columns
    t = times.numbers(name)
    times.require_finite(name, t)
    times.require_increasing(name, t)
    return replace(table, columns={**table.columns, "t_s": pd.Series(t)}, units={})
