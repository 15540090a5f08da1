# SPDX-License-Identifier: MIT
"""Path of a walk: observations of the pose in photographs, sorted by time and smoothed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracking.camera.lens import Array
from tracking.errors import PathError
from tracking.pose import PLANAR, BodyPose
from tracking.smooth import Process, SmoothPath, smooth

TRACK_COLUMNS = (
    "t_s", "t_sigma", "x_m", "y_m", "yaw_rad", "cov_xx", "cov_xy", "cov_xyaw", "cov_yy",
    "cov_yyaw", "cov_yawyaw", "z_m", "source", "score", "photo",
)  # fmt: skip
"""Columns of `track.csv`, in order; `_s` [s], `_m` [m], `_rad` [rad], `t_sigma` [s]; `cov_` of x,
y [m] and yaw [rad]."""


@dataclass(frozen=True)
class PoseObservation:
    """The robot's pose in one photograph, with covariance.

    Attributes:
        photo: Name of the photograph, or of the exposure in a composite one.
        t: Time [s].
        t_sd: Standard deviation of `t` [s].
        planar: x, y [m] and yaw [rad] of the body, shape (3,).
        covariance: Covariance of `planar` from errors of this photograph alone, shape (3, 3).
        camera_covariance: Covariance of `planar` from the error of the camera's pose, which
            photographs from one camera position share, shape (3, 3).
        z: Height of the body's origin over the floor [m].
        score: Correlation of the photograph with the marker or template, 1 at best and of a pose
            that a person set [-].
        source: How the pose was found: "marker", "body" (template) or "hand" (set by a person; a
            pose of which only head and tail were exchanged keeps its source).
    """

    photo: str
    t: float
    t_sd: float
    planar: Array
    covariance: Array
    camera_covariance: Array
    z: float
    score: float
    source: str

    @classmethod
    def of(
        cls, photo: str, pose: BodyPose, *, t: float, t_sd: float, score: float, source: str
    ) -> "PoseObservation":
        """Build an observation from a fitted pose: its x, y, yaw, their covariances, and its z.

        Args:
            photo: Name of the photograph.
            pose: The robot's pose with its covariances.
            t: Time [s].
            t_sd: Standard deviation of `t` [s].
            score: Correlation with the marker or template, 1 at best [-].
            source: "marker", "body" or "hand".
        """
        shared = pose.camera_covariance[np.ix_(PLANAR, PLANAR)]
        return cls(
            photo, t, t_sd, pose.planar, pose.planar_covariance, shared, float(pose.state[2]),
            score, source,
        )  # fmt: skip


@dataclass(frozen=True)
class Track:
    """The smoothed path of a walk with its covariance, one sample for each photograph.

    Attributes:
        observations: The robot's observed poses, in order of time.
        smoothed: The path smoothed from `observations`, at their times.
        covariance: Covariance of the smoothed x, y [m] and yaw [rad], including the error of the
            camera's pose, shape (n, 3, 3).
    """

    observations: tuple[PoseObservation, ...]
    smoothed: SmoothPath
    covariance: Array

    @property
    def t(self) -> Array:
        """Times of the observations, shape (n,) [s]."""
        return np.array([seen.t for seen in self.observations])

    @property
    def poses(self) -> Array:
        """Smoothed x, y [m] and yaw [rad], shape (n, 3)."""
        return self.smoothed.poses

    @property
    def residuals(self) -> Array:
        """Observed minus smoothed x, y [m] and yaw [rad], yaw in -pi to pi, shape (n, 3)."""
        difference = np.array([seen.planar for seen in self.observations]) - self.poses
        difference[:, 2] = np.angle(np.exp(1j * difference[:, 2]))
        return difference

    @property
    def gap_before(self) -> NDArray[np.bool_]:
        """Whether a gap in time interrupts the path just before each sample, shape (n,)."""
        return self.smoothed.gap_before

    @property
    def columns(self) -> dict[str, list[float] | list[str]]:
        """The table `track.csv`: for each name in `TRACK_COLUMNS` a list of n values.

        x, y, yaw and covariance are the smoothed ones, the other columns as observed.
        """
        x, y, yaw = self.poses.T.tolist()
        upper = [
            self.covariance[:, i, j].tolist() for i, j in zip(*np.triu_indices(3), strict=True)
        ]
        of = self.observations
        columns = (
            [seen.t for seen in of], [seen.t_sd for seen in of], x, y, yaw, *upper,
            [seen.z for seen in of], [seen.source for seen in of], [seen.score for seen in of],
            [seen.photo for seen in of],
        )  # fmt: skip
        return dict(zip(TRACK_COLUMNS, columns, strict=True))

    @property
    def tum(self) -> tuple[str, ...]:
        """Lines of a TUM file, smoothed poses: t x y z qx qy qz qw [s, m, -], roll and pitch 0."""
        rows = zip(self.observations, self.poses, strict=True)
        return tuple(
            f"{seen.t:.6f} {x:.6f} {y:.6f} {seen.z:.6f} 0 0 {np.sin(yaw / 2):.9f} "
            f"{np.cos(yaw / 2):.9f}"
            for seen, (x, y, yaw) in rows
        )


def assemble_track(
    observations: Sequence[PoseObservation],
    *,
    gap: float | None = None,
    process: Process | None = None,
) -> Track:
    """Sort observations by time and smooth their poses with `tracking.smooth.smooth`.

    Args:
        observations: Poses of the robot, one for each photograph, in any order.
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        process: Noise densities of the motion model; None to estimate them.

    Returns:
        The path; the covariance from the camera's pose is added after smoothing, since more
        photographs from the same place do not average it away.

    Raises:
        PathError: When there is no observation or two photographs have the same time.
    """
    if not observations:
        raise PathError("the robot is found in no photograph, or corrections delete all its poses")
    ordered = tuple(sorted(observations, key=lambda seen: seen.t))
    path = smooth(
        [seen.t for seen in ordered],
        np.array([seen.planar for seen in ordered]),
        covariance=np.array([seen.covariance for seen in ordered]),
        time_sd=[seen.t_sd for seen in ordered],
        gap=gap,
        process=process,
    )
    shared = np.array([seen.camera_covariance for seen in ordered])
    return Track(ordered, path, path.covariance + shared)
