# SPDX-License-Identifier: MIT
"""Read a trajectory of another program: TUM, KITTI, EuRoC, a table or a ROS log."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.counted import counted
from model.poses import Poses
from model.rigid_path import RigidPath, plane_axes, rotations_of_quaternions
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.mcap.ros_bags import bag_files, is_ros_log
from zebro_lab.tables.mapped_columns import MappedColumns
from zebro_lab.tables.table_files import has_table_name
from zebro_lab.track.trajectory.layouts import OrderedNumbers, ordered
from zebro_lab.track.trajectory.logged_poses import LoggedPoses, read_logged_poses
from zebro_lab.track.trajectory.numbers import NumberLines, read_number_lines
from zebro_lab.track.trajectory.request import Axis, Layout, Plane, TrajectoryRequest
from zebro_lab.track.trajectory.stamps import kept_stamps, stamp_factor
from zebro_lab.track.trajectory.table import read_table_trajectory

_TILTED = np.radians(5.0)  # a body that leaves the plane by more is told of


@dataclass(frozen=True)
class Trajectory:
    """Trajectory of another program.

    Attributes:
        file: The file.
        layout: Its layout.
        path: Poses in space; z is 0 where it is not known, and times are row numbers without times.
        timed: Whether it has times.
        in_space: Whether z is known.
        plane: Axes that span the floor.
        forward: Axis of the body that points ahead.
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
    timed: bool
    in_space: bool
    plane: Plane
    forward: Axis
    source: str = "unknown"
    notes: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()
    topic: str | None = None
    covariance: Array | None = None

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
    def planar_covariance(self) -> Array | None:
        """Covariance of x, y and heading in the plane, shape (n, 3, 3) [m, rad]; None without."""
        if self.covariance is None:
            return None
        chosen = np.zeros((3, 6))
        chosen[[0, 1], plane_axes(self.plane)] = 1.0
        chosen[2, 3:] = self.normal  # the heading turns about it
        return chosen @ self.covariance @ chosen.T


def read_trajectory(
    path: Path,
    request: TrajectoryRequest,
    *,
    mapping: MappedColumns | None = None,
    which: int = 0,
    topic: str | None = None,
    topics: Collection[str] = (),
) -> Trajectory:
    """Read a trajectory; its layout is found by its content where the request does not state it.

    Args:
        path: The file.
        request: How to read it.
        mapping: Headers and units of the columns of a table.
        which: 0 for the first file of a command, 1 for the second.
        topic: Topic to read from a ROS log; None for one of `topics`, else the only one with poses.
        topics: Topics of a ROS log to prefer, also such of other messages.

    Raises:
        NotFound: A file is missing, or the package that reads a ROS log.
        DataError: The file is damaged or its layout is not known; a stamp is repeated with another
            pose, or earlier than the one before.
        SettingsError: An option does not fit the file.
    """
    stated = request.layout_of(which)
    if is_ros_log(path):
        _require_no_other(path, request, which)
        found = read_logged_poses(path, topic=topic, topics=topics)
        return _with_all_rows(_of_ros_log(path, request, found), mapping)
    if stated is Layout.ROS:
        raise DataError("is no ROS log by its name; expected .mcap, .db3, .bag or a bag's folder, "
                        "or another --layout", file=path)  # fmt: skip
    numbers = number_lines_of(path, stated)
    if numbers is None:
        if stated not in (None, Layout.TABLE):
            raise DataError(f"has a line of words; expected lines of numbers ({stated})", file=path)
        return _of_table(path, request, mapping)
    plane, forward = _frame(request, is_kitti=_has_matrices(numbers, stated))
    read = ordered(numbers, stated, plane=plane)
    t, notes, files = _times(read, numbers, request.times)
    kept, more = kept_stamps(t, read.poses, fault=numbers.fault)
    trajectory = Trajectory(
        file=path,
        layout=read.layout,
        path=RigidPath(t, read.position, read.rotation).part(kept),
        timed=read.t is not None or request.times is not None,
        in_space=True,
        plane=plane,
        forward=forward,
        notes=_named(path, (*notes, *more)),
        files=(path, *files),
    )
    return _with_all_rows(_with_doubts(trajectory), mapping)


def number_lines_of(path: Path, stated: Layout | None) -> NumberLines | None:
    """Read lines of numbers; None for a table, which may be binary or in another encoding."""
    if stated is Layout.TABLE or path.suffix.lower() in (".parquet", ".xlsx", ".gz"):
        return None
    try:
        numbers = read_number_lines(path)
    except DataError as error:
        if has_table_name(path) and isinstance(error.__cause__, UnicodeDecodeError):
            return None
        raise
    if numbers is None and not has_table_name(path):
        raise DataError("has a line of words; expected lines of 8 (TUM) or 12 (KITTI) numbers, or "
                        "a table with a suffix such as .csv", file=path)  # fmt: skip
    return numbers


def _has_matrices(numbers: NumberLines, stated: Layout | None) -> bool:
    return stated is Layout.KITTI or (stated is None and numbers.values.shape[1] == 12)


def _frame(request: TrajectoryRequest, *, is_kitti: bool) -> tuple[Plane, Axis]:
    plane = request.plane or (Plane.XZ if is_kitti else Plane.XY)
    return plane, request.forward or (Axis.Z if "z" in plane else Axis.X)


def _times(
    read: OrderedNumbers, numbers: NumberLines, file: Path | None
) -> tuple[Array, tuple[str, ...], Sequence[Path]]:
    """Return times [s], from the file of times or row numbers where there are none, and notes."""
    if read.t is not None:
        factor, notes = stamp_factor(read.t, read.time_unit, fault=numbers.fault)
        return read.t * factor, notes, ()
    count = len(read.position)
    if file is None:
        return np.arange(count, dtype=float), (), ()
    times = read_number_lines(file)
    if times is None or times.values.shape[1] != 1:
        raise SettingsError(f"{file} is not a file of one number a line", key="--times")
    if len(times.values) != count:
        raise SettingsError(
            f"{file} has {counted(len(times.values), 'time')}, {numbers.file} has "
            f"{counted(count, 'pose')}; expected as many of both",
            key="--times",
        )
    t = times.values[:, 0]
    factor, notes = stamp_factor(t, "s", fault=times.fault)
    kept_stamps(
        t, np.arange(count, dtype=float)[:, None], fault=times.fault
    )  # times that do not increase
    return t * factor, notes, (file,)


def _of_table(path: Path, request: TrajectoryRequest, mapping: MappedColumns | None) -> Trajectory:
    table = read_table_trajectory(path, mapping)
    plane, forward = _frame(request, is_kitti=False)
    if not table.in_space and plane is not Plane.XY:
        raise SettingsError(f"{path} has no column z; leave --plane out", key="--plane")
    trajectory = Trajectory(
        path, Layout.TABLE, table.path, True, table.in_space, plane, forward, table.source,
        _named(path, table.notes), table.files,
    )  # fmt: skip
    return _with_doubts(trajectory)


def _require_no_other(path: Path, request: TrajectoryRequest, which: int) -> None:
    """Raise `SettingsError` for options that do not fit a ROS log."""
    if request.times is not None:
        raise SettingsError(f"{path} is a ROS log, whose messages have times; leave the option out",
                            key="--times")  # fmt: skip
    if request.layout_of(which) not in (None, Layout.ROS):
        raise SettingsError(f"{path} is a ROS log; leave the option out", key="--layout")


def _of_ros_log(path: Path, request: TrajectoryRequest, found: LoggedPoses) -> Trajectory:
    rows, quaternion = found.rows, found.quaternion

    def fault(problem: str, index: int) -> DataError:
        return DataError(f"message {index + 1} on topic {rows.topic}: {problem}", file=path)

    t = np.array(rows.t)
    poses = found.position if quaternion is None else np.hstack([found.position, quaternion])
    kept, notes = kept_stamps(t, poses, fault=fault)
    rotation = None if quaternion is None else rotations_of_quaternions(quaternion)
    plane, forward = _frame(request, is_kitti=False)
    trajectory = Trajectory(
        file=path,
        layout=Layout.ROS,
        path=RigidPath(t, found.position, rotation).part(kept),
        timed=True,
        in_space=True,
        plane=plane,
        forward=forward,
        notes=_named(path, (rows.told, *rows.notes, *notes)),
        files=tuple(bag_files(path)),
        topic=rows.topic,
        covariance=None if found.covariance is None else found.covariance[kept].reshape(-1, 6, 6),
    )
    return _with_doubts(trajectory)


def _with_all_rows(trajectory: Trajectory, mapping: MappedColumns | None) -> Trajectory:
    """Add a note that rows are chosen from tables only, where `[rows] keep` is stated."""
    if mapping is None or not mapping.keep:
        return trajectory
    note = (
        f"all poses are read; [{mapping.where}rows] keep in {mapping.stated_in} applies to tables "
        f"only, not to {trajectory.layout}"
    )
    return replace(trajectory, notes=(*trajectory.notes, *_named(trajectory.file, [note])))


def _with_doubts(trajectory: Trajectory) -> Trajectory:
    """Add notes where rotations leave the plane, and where the path extends across it."""
    path, plane, notes = trajectory.path, trajectory.plane, []
    tilt = float(path.tilt(plane).max())
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
    return replace(trajectory, notes=(*trajectory.notes, *_named(trajectory.file, notes)))


def _named(path: Path, notes: Sequence[str]) -> tuple[str, ...]:
    return tuple(note if note.startswith(path.name) else f"{path.name}: {note}" for note in notes)
