# SPDX-License-Identifier: MIT
"""Import a path tracked by another program, from a table or a trajectory."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from model.arrays import Array
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.tables.columns import Columns
from zebro_lab.track.file import TrackFile, track_of_table
from zebro_lab.track.trajectory.file import Trajectory, read_trajectory
from zebro_lab.track.trajectory.request import Layout, Plane, TrajectoryRequest
from zebro_lab.track.trajectory.table import COVARIANCE

ADVICE = "import the track with --track-sd '1 mm' --track-sd-yaw '0.2 deg', its standard deviations"
"""What to do about a track without covariance that needs one."""
TRACK_UNITS: Final[Mapping[str, str]] = {
    "t_s": "s", "t_sigma": "s", "x_m": "m", "y_m": "m", "yaw_rad": "rad", **COVARIANCE, "z_m": "m",
}  # fmt: skip
"""SI unit of each column of a path in the plane, in the order of `track.csv`."""


@dataclass(frozen=True)
class ForeignTrack:
    """Path tracked by another program, validated.

    Attributes:
        track: Poses and their covariance.
        columns: Known columns of `track.csv` in SI by name, in its order, shape (n,) each.
        files: Every file read: the table and, if there is one, its `columns.toml`.
        topic: Topic of a ROS log that was read; None for any other file.
    """

    track: TrackFile
    columns: Mapping[str, Array]
    files: tuple[Path, ...] = ()
    topic: str | None = None

    def since(self, zero: float) -> "ForeignTrack":
        """Return the path with times since `zero` [s], a time of the file."""
        t = self.track.poses.t - zero
        track = replace(self.track, poses=replace(self.track.poses, t=t))
        return replace(self, track=track, columns={**self.columns, "t_s": t})


def read_foreign_track(
    path: Path,
    mapping: Columns,
    request: TrajectoryRequest,
    *,
    topic: str | None = None,
    topics: Collection[str] = (),
    sd: tuple[float, float | None] | None = None,
) -> ForeignTrack:
    """Read a path tracked by another program: a table, a TUM, KITTI or EuRoC trajectory, a ROS log.

    Args:
        path: The file.
        mapping: Header, unit and sign of each column of a table.
        request: How a trajectory is read.
        topic: Topic to read from a ROS log; None for one of `topics`, else the only one with poses.
        topics: Topics of a ROS log to prefer; those without poses are ignored.
        sd: Standard deviations of positions [m] and headings [rad] (None if not stated) of the
            poses of a file without covariance, independent of one another; None if not known.

    Raises:
        NotFound: A file does not exist.
        DataError: As in `read_trajectory`; or there are no times, fewer than three poses, or a
            covariance has a negative eigenvalue.
        SettingsError: An option does not fit the file, or has no effect on it; or the path extends
            across the plane of the floor, and that is not stated.
    """
    trajectory = read_trajectory(path, request, mapping=mapping, topic=topic, topics=topics)
    if request.times is not None and trajectory.layout is not Layout.KITTI:
        raise SettingsError(f"{path} has times of its own; leave the option out", key="--times")
    if not trajectory.timed:
        raise DataError("has no times; give the file of its times with --times", file=path)
    if request.plane is None and trajectory.leaves_plane:
        raise SettingsError(
            f"{path} extends farther across the plane {trajectory.plane} than in it; state the "
            "plane of the floor, such as xy or xz",
            key="--plane",
        )
    columns = _planar_columns(trajectory, sd)
    source = None if trajectory.source == "unknown" else trajectory.source
    series = {name: pd.Series(values) for name, values in columns.items()}
    rows = replace(trajectory.rows, columns=series, units={}, repeated=frozenset(), unreadable={})
    track = track_of_table(replace(rows, source=source, notes=trajectory.notes))
    if "yaw_rad" in columns and "cov_xx" not in columns:
        track = replace(track, notes=(*track.notes, f"a fit of walks needs a covariance: {ADVICE}"))
    return ForeignTrack(track, columns, trajectory.files, trajectory.topic)


def _planar_columns(
    trajectory: Trajectory, sd: tuple[float, float | None] | None
) -> dict[str, Array]:
    """Return the columns of `track.csv` that are known of a trajectory in its plane, in SI.

    A covariance is left out unless complete. That of a table whose plane is not xy is left out too,
    unless `sd` gives it, since its columns refer to x and y of the table.

    Args:
        trajectory: The trajectory.
        sd: Standard deviations that give a covariance, see `read_foreign_track`; None without.
    """
    poses = trajectory.poses
    x, y = poses.position.T
    known = {**trajectory.columns, "x_m": x, "y_m": y}
    if poses.has_yaw:
        known["yaw_rad"] = poses.yaw
    if trajectory.in_space:
        known["z_m"] = trajectory.height
    if sd is not None:
        known |= _covariance(*sd, known, trajectory.file)
    in_plane = trajectory.layout is not Layout.TABLE or trajectory.plane is Plane.XY
    whole = (in_plane or sd is not None) and set(COVARIANCE) <= set(known)
    left_out = () if whole else COVARIANCE
    return {name: known[name] for name in TRACK_UNITS if name in known and name not in left_out}


def _covariance(
    position: float, yaw: float | None, known: Mapping[str, Array], file: Path
) -> dict[str, Array]:
    """Return columns of a covariance by standard deviations of position [m] and heading [rad].

    Raises:
        SettingsError: The track already has a covariance; it has headings, but `yaw` is None; or it
            has no headings, but `yaw` is given.
    """
    has_yaw = "yaw_rad" in known
    for key, wrong, problem in (
        ("--track-sd", set(COVARIANCE) & set(known), "has a covariance; leave the option out"),
        ("--track-sd-yaw", has_yaw and yaw is None,
         "has headings; add their standard deviation, such as --track-sd-yaw '0.2 deg'"),
        ("--track-sd-yaw", not has_yaw and yaw is not None,
         "has no headings; leave the option out"),
    ):  # fmt: skip
        if wrong:
            raise SettingsError(f"{file} {problem}", key=key)
    variances = {"cov_xx": position**2, "cov_yy": position**2, "cov_yawyaw": (yaw or 0.0) ** 2}
    return {name: np.full_like(known["t_s"], variances.get(name, 0.0)) for name in COVARIANCE}
