# SPDX-License-Identifier: MIT
"""Camera pose from the floor's marks in one photograph (PnP)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from scipy.optimize import least_squares

from model.arrays import Array
from tracking.camera.lens import Camera, CameraPose, project, project_with_derivatives
from tracking.errors import FloorError
from tracking.floor.marks import FloorMap
from tracking.markers import Sighting

_MISFIT_PX = 8.0
"""Largest root mean square distance of the marks' points from their projection [px]."""


@dataclass(frozen=True)
class FloorView:
    """Pixels of the floor's marks in one photograph, with covariance.

    Attributes:
        photo: Name of the photograph.
        pixels: By key of `FloorMap.marks`, pixels of the mark's points, shape (n, 2): 4 corners
            of a marker, 1 clicked point [px]; other keys are ignored.
        covariances: By the same keys, covariance of the raveled pixels, shape (2n, 2n) [px²].
    """

    photo: str
    pixels: Mapping[int | str, Array]
    covariances: Mapping[int | str, Array]

    @classmethod
    def of(cls, photo: str, sightings: Sequence[Sighting] = ()) -> "FloorView":
        """Build a view from the markers detected in a photograph.

        Args:
            photo: Name of the photograph.
            sightings: Markers detected in it. Markers whose number occurs more than once are left
                out, since at most one of them is the right one.
        """
        numbers = [sighting.marker_id for sighting in sightings]
        single = [s for s in sightings if numbers.count(s.marker_id) == 1]
        return cls(
            photo,
            {s.marker_id: s.corners_px for s in single},
            {s.marker_id: s.covariance for s in single},
        )

    def with_clicked(
        self, clicked: Mapping[str, tuple[float, float]], *, click_sd: float = 0.7
    ) -> "FloorView":
        """Return the view with added floor points that a person clicked on.

        Args:
            clicked: Pixel column u and row v of the click, by name of the floor point [px].
            click_sd: Standard deviation of u and of v of a click [px].
        """
        pixels = {name: np.array([pixel], dtype=float) for name, pixel in clicked.items()}
        covariances = {name: click_sd**2 * np.eye(2) for name in clicked}
        return FloorView(self.photo, {**self.pixels, **pixels}, {**self.covariances, **covariances})


def locate_camera(camera: Camera, floor: FloorMap, view: FloorView) -> CameraPose:
    """Compute the camera's pose from one photograph, taking the floor's map as exact.

    Args:
        camera: Camera intrinsics and distortion.
        floor: The floor's marks.
        view: Pixels of the marks in the photograph.

    Returns:
        The camera's pose of least misfit, with a covariance from the pixel residuals alone.

    Raises:
        FloorError: When the photograph shows no mark or fewer than 4 points, no solution exists,
            the camera would be below the floor, the map is mirrored, or the root mean square
            distance of points from their projection exceeds 8 px.
    """
    pose, misfit = _best_pose(camera, floor, view)
    if misfit > _MISFIT_PX or pose.position[2] <= 0:
        _explain(camera, floor, view, misfit)
    return pose


def seen_keys(floor: FloorMap, view: FloorView) -> list[int | str]:
    """List the marks of the floor that a photograph shows, in the map's order.

    Args:
        floor: The floor's marks.
        view: Pixels of the marks in the photograph.

    Returns:
        Keys of `floor.marks`: numbers of markers and names of points.
    """
    return [key for key in floor.marks if key in view.pixels]


def _best_pose(camera: Camera, floor: FloorMap, view: FloorView) -> tuple[CameraPose, float]:
    """Return the camera pose of least misfit over all starting poses, and the misfit (RMS) [px].

    Raises:
        FloorError: No mark or fewer than 4 points are seen, or there is no solution.
    """
    keys = seen_keys(floor, view)
    if not keys:
        expected = ", ".join(str(key) for key in floor.marks)
        raise FloorError(
            f"{view.photo}: none of the floor's marks ({expected}) is seen; check dictionary "
            f"'{floor.dictionary}' in floor.toml, or click on points: `zebro-lab annotate --click`"
        )
    points = np.concatenate([floor.marks[key].points for key in keys])
    pixels = np.concatenate([view.pixels[key] for key in keys])
    if len(points) < 4:
        raise FloorError(
            f"{view.photo}: {len(points)} points of the floor are seen; expected at least 4 (a "
            f"marker has 4): click on more with `zebro-lab annotate --click`"
        )
    starts = _starting_poses(camera, points, pixels)
    poses = [_polish(camera, pose, points, pixels) for pose in starts]
    if not poses:
        raise FloorError(f"{view.photo}: marks and clicks fit no pose of the camera; check both")
    return min(poses, key=lambda found: found[1])


def _starting_poses(camera: Camera, points: Array, pixels: Array) -> list[CameraPose]:
    """Solve the PnP problem without a first guess: all finite solutions, possibly none.

    Points (n, 3) of one height count as a flat target; OpenCV wants such a target at z = 0.
    """
    flat = np.ptp(points[:, 2]) < 1e-9
    level = points - [0.0, 0.0, points[0, 2] if flat else 0.0]
    # IPPE gives both solutions for a flat target, but for one view in a hundred none is finite.
    methods = (cv2.SOLVEPNP_IPPE, cv2.SOLVEPNP_SQPNP) if flat else (cv2.SOLVEPNP_SQPNP,)
    poses = []
    for rotation, translation in _solutions(camera, level, pixels, methods):
        R = np.asarray(cv2.Rodrigues(rotation)[0], dtype=float)
        shift = R @ (points[0] - level[0])
        poses.append(CameraPose.from_matrix(R, translation - shift))
    return poses


def _solutions(
    camera: Camera, points: Array, pixels: Array, methods: tuple[int, ...]
) -> list[tuple[Array, Array]]:
    """Solve for rotation vector and translation, shape (3,) each, by each of OpenCV's PnP methods.

    Solutions that are not finite are left out, as are methods that fail; empty if all do.
    """
    found = []
    for method in methods:
        try:
            _, rotations, translations, _ = cv2.solvePnPGeneric(
                points, pixels, camera.matrix, camera.distortion, flags=method
            )
        except cv2.error:
            continue
        pairs = zip(rotations, translations, strict=True)
        found += [(np.ravel(R).astype(float), np.ravel(t).astype(float)) for R, t in pairs]
    return [pair for pair in found if np.isfinite(pair).all()]


def _polish(
    camera: Camera, start: CameraPose, points: Array, pixels: Array
) -> tuple[CameraPose, float]:
    """Refine a camera pose by robust least squares; return it with covariance, RMS misfit [px]."""

    def pose_of(x: Array) -> CameraPose:
        """Return the camera pose of the six unknowns, rotation vector and translation."""
        return CameraPose(x[:3], x[3:], start.covariance)

    def residual(x: Array) -> Array:
        """Compute projected minus seen pixels, shape (2n,) [px]."""
        return (project(camera, pose_of(x), points) - pixels).ravel()

    def jacobian(x: Array) -> Array:
        """Compute the derivative of `residual` by the unknowns, shape (2n, 6)."""
        return project_with_derivatives(camera, pose_of(x), points)[2].reshape(-1, 6)

    x0 = np.concatenate((start.rotation_vector, start.translation))
    # Robust loss: a misplaced mark must not bias the pose and spread its error over all marks.
    fit = least_squares(
        residual, x0, jac=jacobian,  # pyright: ignore[reportArgumentType] # scipy has no types
        loss="soft_l1", f_scale=2.0, x_scale="jac",
    )  # fmt: skip
    J, r = jacobian(fit.x), residual(fit.x)
    misfit = float(np.sqrt(2 * np.mean(r**2)))
    noise = max(misfit**2 / 2, 1e-4)  # variance of u and of v, at least that of 0.01 px
    covariance = noise * np.linalg.pinv(J.T @ J)
    return CameraPose(fit.x[:3], fit.x[3:], covariance), misfit


def _explain(camera: Camera, floor: FloorMap, view: FloorView, misfit: float) -> None:
    """Raise `FloorError` for a pose that does not fit, and say whether the map is mirrored.

    It is if the map with y reversed fits within `_MISFIT_PX` and either the camera is then above
    the floor, or the misfit is below 0.3 of the given one [px].
    """
    other, other_misfit = _best_pose(camera, floor.mirrored(), view)
    if other_misfit < min(0.3 * misfit, _MISFIT_PX) or (
        other.position[2] > 0 and other_misfit < _MISFIT_PX
    ):
        raise FloorError(
            f"{view.photo}: the map of the floor is mirrored (off by {misfit:.0f} px or seen from "
            f"below; by {other_misfit:.1f} px with y reversed); y must grow left of x from above"
        )
    raise FloorError(
        f"{view.photo}: the floor's marks are off by {misfit:.0f} px (rms) from where floor.toml "
        f"has them (limit {_MISFIT_PX:g} px), or seen from below; check x, y, yaw_deg and side of "
        f"each mark, clicked points, and that camera.toml is of this camera, zoom and focus"
    )
