# SPDX-License-Identifier: MIT
"""Import a path tracked by another program, from a table or a trajectory."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from model.arrays import Array
from model.poses import wrap
from model.travel import has_travelled, travel_direction
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.tables.columns import Columns
from zebro_lab.track.file import TrackFile, track_of_table, tum_lines
from zebro_lab.track.trajectory.file import Trajectory, read_trajectory
from zebro_lab.track.trajectory.request import TrajectoryRequest
from zebro_lab.track.trajectory.table import COVARIANCE

ADVICE = "import the track with --track-sd '1 mm' --track-sd-yaw '0.2 deg', its standard deviations"
"""What to do about a track without covariance that needs one."""


@dataclass(frozen=True)
class PoseSd:
    """Standard deviations of each pose, whose errors are independent of one another.

    Attributes:
        position: Of x and of y [m].
        yaw: Of the heading [rad]; None if not stated.
    """

    position: float
    yaw: float | None = None

    def columns(self, known: Mapping[str, Array], file: Path) -> Mapping[str, Array]:
        """Return columns of a covariance, by name as in `track.csv`, shape (n,) each.

        Args:
            known: Columns of the track in SI.
            file: Its file, for the message.

        Raises:
            SettingsError: The track has a covariance; or a heading, whose standard deviation is not
                stated, or none.
        """
        if set(COVARIANCE) & set(known):
            raise SettingsError(f"{file} has a covariance; leave the option out", key="--track-sd")
        has_yaw = "yaw_rad" in known
        if has_yaw and self.yaw is None:
            raise SettingsError(
                f"{file} has headings; add their standard deviation, such as --track-sd-yaw "
                "'0.2 deg'",
                key="--track-sd-yaw",
            )
        if self.yaw is not None and not has_yaw:
            raise SettingsError(f"{file} has no headings; leave the option out",
                                key="--track-sd-yaw")  # fmt: skip
        one = np.ones_like(known["t_s"])
        variances = {
            "cov_xx": self.position**2, "cov_yy": self.position**2,
            "cov_yawyaw": (self.yaw or 0.0) ** 2,
        }  # fmt: skip
        return {name: variances.get(name, 0.0) * one for name in COVARIANCE}


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
    mapping: Columns,
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
        DataError: As in `read_trajectory`; or there are no times, fewer than three poses, or a
            covariance has a negative eigenvalue.
        SettingsError: An option does not fit the file, or has no effect on it; or the path extends
            across the plane of the floor, and that is not stated.
    """
    trajectory = read_trajectory(path, request, mapping=mapping, topic=topic, topics=topics)
    if trajectory.is_planar_table:
        _require_unused(path, request)
    if not trajectory.timed:
        raise DataError("has no times; give the file of its times with --times", file=path)
    if request.plane is None and not trajectory.is_planar_table and trajectory.leaves_plane:
        raise SettingsError(
            f"{path} extends farther across the plane {trajectory.plane} than in it; state the "
            "plane of the floor, such as xy or xz",
            key="--plane",
        )
    columns = _planar_columns(trajectory)
    if sd is not None:
        columns |= sd.columns(columns, path)
    notes = (*trajectory.notes, *_sideways(trajectory))
    source = None if trajectory.source == "unknown" else trajectory.source
    series = {name: pd.Series(values) for name, values in columns.items()}
    rows = replace(trajectory.rows, columns=series, units={}, repeated=frozenset(), unreadable={})
    track = track_of_table(replace(rows, source=source, notes=notes))
    with_covariance = set(COVARIANCE) <= set(columns)
    if track.poses.has_yaw and not with_covariance:
        track = replace(track, notes=(*track.notes, f"a fit of walks needs a covariance: {ADVICE}"))
    more = {name: columns[name] for name in ("t_sigma", "z_m") if name in columns}
    own = () if mapping.file is None else (mapping.file,)
    files = tuple(dict.fromkeys((*trajectory.files, *own)))
    return ForeignTrack(track, more, with_covariance, files, trajectory.topic)


def _require_unused(path: Path, request: TrajectoryRequest) -> None:
    """Raise `SettingsError` for options that a table of plane poses leaves without effect."""
    for option, value in (("--forward", request.forward), ("--times", request.times)):
        if value is not None:
            raise SettingsError(
                f"{path} is a table of poses in the plane, with columns of its own for time and "
                "heading; leave the option out",
                key=option,
            )


def _planar_columns(trajectory: Trajectory) -> dict[str, Array]:
    """Return the columns of `track.csv` that are known of a trajectory in its plane, in SI."""
    if trajectory.is_planar_table:
        return {n: trajectory.columns[n] for n in TRACK_UNITS if n in trajectory.columns}
    poses = trajectory.poses
    x, y = poses.position.T
    columns = {"t_s": poses.t, "x_m": x, "y_m": y}
    if poses.has_yaw:
        columns |= {"yaw_rad": poses.yaw, **trajectory.planar_covariance}
    if trajectory.in_space:
        columns["z_m"] = trajectory.height
    return columns


def _sideways(trajectory: Trajectory) -> tuple[str, ...]:
    """Return a note if the body's forward axis mostly points elsewhere than it travels."""
    poses = trajectory.poses
    if trajectory.is_planar_table or not poses.has_yaw:
        return ()
    apart = float(np.median(np.abs(wrap(poses.yaw - travel_direction(poses)))))
    if apart < _SIDEWAYS or not has_travelled(poses):
        return ()
    return (
        f"{trajectory.file.name}: the heading, that of the {trajectory.forward} axis, is mostly "
        f"{np.degrees(apart):.0f} deg off the direction of travel; is another --forward meant?",
    )
