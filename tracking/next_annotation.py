# SPDX-License-Identifier: MIT
"""Which photograph to annotate next for the least uncertainty of a track without a marker.

Clicks in a further photograph measure its pose without the error of the template that all poses
share. With S the joint covariance of the poses and R the covariance of a pose by clicks in
photograph k, and by finding what was cut out there again, the covariance falls by
S_:k (S_kk + R)^-1 S_k: (conditioning of a Gaussian). Mean height and tilt of the body are wrong for
these clicks too: that part of S is left out of the gain. A further template of its own, which such
clicks also give, is not counted.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from tracking.body import TopPlate, expected_covariance
from tracking.camera.lens import Camera, CameraPose, project
from tracking.path import Track
from tracking.pose import PLANAR, BodyPrior, body_to_floor, fit_pose
from tracking.shared import HEIGHT, TILT

_MOST = 150  # photographs that are compared, evenly spread over the walk
_WORTH = 0.1  # of a standard deviation


@dataclass(frozen=True)
class NextAnnotation:
    """The photograph to annotate next, and by which part standard deviations would fall.

    Attributes:
        photo: Name of the photograph.
        position: Fall of the root mean variance of x and y, over its value [-].
        yaw: The same of yaw [-].
    """

    photo: str
    position: float
    yaw: float

    @property
    def sentence(self) -> str:
        """Say what to do, and what it brings."""
        return (
            f"to shrink them, annotate the robot's top in {self.photo} too: that would lower the "
            f"standard deviations of x and y by {self.position:.0%}, that of yaw by {self.yaw:.0%}"
        )


def next_annotation(
    track: Track, views: dict[str, CameraPose], *, camera: Camera, prior: BodyPrior,
    plate: TopPlate, corner_sd_px: float, annotated: Iterable[str], by_edges: bool = False,
) -> NextAnnotation | None:  # fmt: skip
    """Find the photograph whose annotation would lower the track's variance most.

    Args:
        track: The track.
        views: By name of photograph, the pose of the camera.
        camera: Camera intrinsics and distortion.
        prior: Prior of height and tilt.
        plate: The robot's flat top.
        corner_sd_px: Standard deviation of u and of v of a click [px].
        annotated: Names of the photographs that are annotated already.
        by_edges: Whether the edges of the top are clear, so that they refine clicks.

    Returns:
        The photograph; None where no annotation would lower either standard deviation by a tenth.
    """
    rows = np.unique(np.linspace(0, len(track.t) - 1, min(_MOST, len(track.t))).round().astype(int))
    whole = _mean_variances(np.einsum("nii->ni", track.covariance[rows]))
    causes = [cause for cause in (HEIGHT, TILT) if cause in track.shared.slots]
    known = replace(track.joint, errors=track.shared.given(causes)).part(rows).dense
    done, best = set(annotated), None
    for place, row in enumerate(rows):
        seen = track.observations[row]
        if seen.photo in done or seen.photo not in views:
            continue
        own = slice(3 * place, 3 * place + 3)
        clicks = _by_clicks(track.poses[row], views[seen.photo], camera, prior, plate, corner_sd_px,
                            by_edges)  # fmt: skip
        again = clicks + seen.pose.planar_covariance
        gained = np.linalg.solve(known[own, own] + again, known[own])
        fall = _mean_variances(np.einsum("ij,ij->j", known[own], gained).reshape(-1, 3))
        part = 1 - np.sqrt(np.maximum(1 - fall / whole, 0.0))
        if best is None or part.sum() > best.position + best.yaw:
            best = NextAnnotation(seen.photo, float(part[0]), float(part[1]))
    return best if best is not None and max(best.position, best.yaw) > _WORTH else None


def _mean_variances(variances: Array) -> Array:
    """Return the means of the variances (n, 3) of x plus y, and of yaw, shape (2,)."""
    mean = variances.mean(axis=0)
    return np.array([mean[0] + mean[1], mean[2]])


def _by_clicks(
    planar: Array, view: CameraPose, camera: Camera, prior: BodyPrior, plate: TopPlate, sd: float,
    by_edges: bool,
) -> Array:  # fmt: skip
    """Compute the covariance (3, 3) of a pose by clicks on the corners of the top, or by edges."""
    state = np.array([planar[0], planar[1], prior.height, 0.0, 0.0, planar[2]])
    seen = project(camera, view, body_to_floor(plate.corners_body, state))
    covariance = expected_covariance(seen, sd_px=sd) if by_edges else sd**2 * np.eye(8)
    pose = fit_pose(camera, view, points_body=plate.corners_body, corners_px=seen,
                    covariance=covariance, prior=prior)  # fmt: skip
    return pose.covariance[np.ix_(PLANAR, PLANAR)]
