# SPDX-License-Identifier: MIT
"""Import a path tracked by another program, from a table or a trajectory."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.poses import wrap
from model.travel import has_travelled, travel_direction
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.mcap.ros_bags import is_ros_log
from zebro_lab.tables.mapped_columns import MappedColumns, canonical_columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file
from zebro_lab.track.file import TrackFile, track_of_table, tum_lines
from zebro_lab.track.foreign_sd import ADVICE, PoseSd
from zebro_lab.track.trajectory.file import Trajectory, number_lines_of, read_trajectory
from zebro_lab.track.trajectory.request import Plane, TrajectoryRequest
from zebro_lab.track.trajectory.table import (
    COVARIANCE,
    MAPPED_UNITS,
    QUATERNION,
    read_table_columns,
    recognised,
)

TRACK_UNITS: Final[Mapping[str, str]] = {
    "t_s": "s", "t_sigma": "s", "x_m": "m", "y_m": "m", "yaw_rad": "rad", **COVARIANCE, "z_m": "m",
}  # fmt: skip
"""SI unit of each column of a path in the plane, in the order of `track.csv`."""
_SIDEWAYS: Final = np.radians(45.0)
"""Median angle from the direction of travel beyond which a heading is told of."""


@dataclass(frozen=True)
class ForeignTrack:
    """Path tracked by another program, validated.

    Attributes:
        track: Poses and their covariance.
        more: Known further columns of `track.csv`, `t_sigma` [s] and `z_m` [m], shape (n,) each.
        with_covariance: Whether the covariance is known.
        files: Every file read: the table and, if there is one, its `columns.toml`.
        topic: Topic of a ROS log that was read; None for any other file.
    """

    track: TrackFile
    more: Mapping[str, Array] = field(default_factory=dict)
    with_covariance: bool = False
    files: tuple[Path, ...] = ()
    topic: str | None = None

    @property
    def columns(self) -> Mapping[str, Sequence[float]]:
        """Known columns of `track.csv` by name, in the order of `TRACK_UNITS`."""
        poses = self.track.poses
        x, y = poses.position.T.tolist()
        known: dict[str, Sequence[float]] = {"t_s": poses.t.tolist(), "x_m": x, "y_m": y}
        if poses.has_yaw:
            known["yaw_rad"] = poses.yaw.tolist()
        if self.with_covariance:
            upper = zip(COVARIANCE, zip(*np.triu_indices(3), strict=True), strict=True)
            known |= {name: self.track.covariance[:, i, j].tolist() for name, (i, j) in upper}
        known |= {name: column.tolist() for name, column in self.more.items()}
        return {name: known[name] for name in TRACK_UNITS if name in known}

    def since(self, zero: float) -> "ForeignTrack":
        """Return the path with times since `zero` [s], a time of the file."""
        poses = self.track.poses
        return replace(self, track=replace(self.track, poses=replace(poses, t=poses.t - zero)))

    @property
    def tum(self) -> Sequence[str]:
        """Lines of `track.tum`; see `tum_lines`."""
        return tum_lines(self.track.poses).splitlines()


def read_foreign_track(
    path: Path,
    mapping: MappedColumns,
    request: TrajectoryRequest,
    *,
    topic: str | None = None,
    topics: Collection[str] = (),
    sd: PoseSd | None = None,
) -> ForeignTrack:
    """Read a path tracked by another program: a table, a TUM, KITTI or EuRoC trajectory, a ROS log.

    Args:
        path: The file.
        mapping: Header, unit and sign of each column of a table.
        request: How a trajectory is read.
        topic: Topic to read from a ROS log; None for one of `topics`, else the only one with poses.
        topics: Topics of a ROS log to prefer, also such of other messages.
        sd: Standard deviations of the poses of a file without covariance; None if not known.

    Raises:
        NotFound: A file does not exist.
        DataError: As in `read_trajectory` and `track_of_foreign_table`; or there are no times.
        SettingsError: An option does not fit the file, or has no effect on it; or the path extends
            across the plane of the floor, and that is not stated.
    """
    table = None if is_ros_log(path) else _planar_table(path, mapping, request)
    if table is not None:
        _require_unused(path, request)
        return track_of_foreign_table(table, mapping, sd=sd)
    trajectory = read_trajectory(path, request, mapping=mapping, topic=topic, topics=topics)
    if not trajectory.timed:
        raise DataError("has no times; give the file of its times with --times", file=path)
    if trajectory.leaves_plane and request.plane is None:
        raise SettingsError(
            f"{path} extends farther across the plane {trajectory.plane} than in it; state the "
            "plane of the floor, such as xy or xz",
            key="--plane",
        )
    own = replace(mapping, mapped=canonical_columns(MAPPED_UNITS).mapped, keep=())
    track = track_of_foreign_table(_flat(trajectory), own, sd=sd)
    files = tuple(dict.fromkeys((*trajectory.files, *track.files[1:])))
    return replace(track, files=files, topic=trajectory.topic)


def _planar_table(
    path: Path, mapping: MappedColumns, request: TrajectoryRequest
) -> RawTable | None:
    """Return the table of a path in the plane; None for any other trajectory."""
    if number_lines_of(path, request.layout_of(0)) is not None:
        return None
    if request.plane not in (None, Plane.XY):
        return None
    table = read_table_file(path, sheet=mapping.sheet)
    columns = recognised(table, mapping)
    return None if all(columns.has(table, name) for name in QUATERNION) else table


def _require_unused(path: Path, request: TrajectoryRequest) -> None:
    """Raise `SettingsError` for options that a table of plane poses leaves without effect."""
    for option, value in (("--forward", request.forward), ("--times", request.times)):
        if value is not None:
            raise SettingsError(
                f"{path} is a table of poses in the plane, with columns of its own for time and "
                "heading; leave the option out",
                key=option,
            )


def _flat(trajectory: Trajectory) -> RawTable:
    """Return a trajectory as a table of t_s, x_m, y_m, yaw_rad and z_m, as far as known."""
    import pandas as pd

    poses = trajectory.poses
    x, y = poses.position.T
    columns = {"t_s": poses.t, "x_m": x, "y_m": y}
    notes = trajectory.notes
    if poses.has_yaw:
        columns["yaw_rad"] = poses.yaw
        notes = (*notes, *_sideways(trajectory))
        if (covariance := trajectory.planar_covariance) is not None:
            upper = zip(COVARIANCE, zip(*np.triu_indices(3), strict=True), strict=True)
            columns |= {name: covariance[:, i, j] for name, (i, j) in upper}
    if trajectory.in_space:
        columns["z_m"] = trajectory.height
    source = None if trajectory.source == "unknown" else trajectory.source
    return RawTable(
        trajectory.file, {n: pd.Series(v) for n, v in columns.items()}, source=source, notes=notes,
        units={"yaw_rad": "rad"},
    )  # fmt: skip


def _sideways(trajectory: Trajectory) -> tuple[str, ...]:
    """Return a note if the body's forward axis mostly points elsewhere than it travels."""
    poses = trajectory.poses
    apart = float(np.median(np.abs(wrap(poses.yaw - travel_direction(poses)))))
    if apart < _SIDEWAYS or not has_travelled(poses):
        return ()
    return (
        f"{trajectory.file.name}: the heading, that of the {trajectory.forward} axis, is mostly "
        f"{np.degrees(apart):.0f} deg off the direction of travel; is another --forward meant?",
    )


def track_of_foreign_table(
    table: RawTable, mapping: MappedColumns, *, sd: PoseSd | None = None
) -> ForeignTrack:
    """Convert a path in a table of another program to SI and validate it.

    Args:
        table: The table.
        mapping: Header, unit and sign of each column of `TRACK_UNITS`; the headers `t`, `x`, `y`,
            `z` and `yaw` are recognised without an entry.
        sd: Standard deviations of the poses of a table without covariance; None if not known.

    Raises:
        SettingsError: `sd` does not fit the table.
        DataError: Time, x or y is missing, a cell holds no finite number, time does not increase, a
            covariance has a negative eigenvalue, or there are fewer than three poses; names the
            cell.
    """
    import pandas as pd

    read = read_table_columns(table, mapping, TRACK_UNITS, what="track")
    columns = dict(read.columns)
    if sd is not None:
        columns |= sd.columns(columns, table.path)
    si = {name: pd.Series(values) for name, values in columns.items()}
    source = mapping.source or table.source
    checked = RawTable(table.path, si, source=source, notes=(*table.notes, *read.notes),
                       header_line=table.header_line, kept=read.table.kept)  # fmt: skip
    more = {name: columns[name] for name in ("t_sigma", "z_m") if name in columns}
    files = (table.path, *([mapping.file] if mapping.file else []))
    track, with_covariance = track_of_table(checked), set(COVARIANCE) <= set(columns)
    if track.poses.has_yaw and not with_covariance:
        track = replace(track, notes=(*track.notes, f"a fit of walks needs a covariance: {ADVICE}"))
    return ForeignTrack(track, more, with_covariance, files)
