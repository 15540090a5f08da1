# SPDX-License-Identifier: MIT
"""The robot's body as a box, and the pixels that it occludes."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.plane import Plane
from tracking.camera.lens import Camera, CameraPose, project, to_floor
from tracking.pose import body_to_floor


@dataclass(frozen=True)
class BodyBox:
    """A box as long and wide as the robot, from its top to as far below the body's origin.

    It is centred at the body's origin.

    Attributes:
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        size: Length and width of the robot's body [m].
        top: Height of the robot's top over the body's origin [m].
        height: Height of the body's origin over the floor, of a level robot [m].
    """

    camera: Camera
    view: CameraPose
    size: tuple[float, float]
    top: float
    height: float

    @property
    def is_square(self) -> bool:
        """Return whether width and length of the body differ by less than 20 % of the larger."""
        return abs(self.size[0] - self.size[1]) < 0.2 * max(self.size)

    def hidden(self, state: Array, *, margin: float) -> NDArray[np.bool_]:
        """Compute the mask of the pixels of a photograph that the box occludes.

        Args:
            state: Pose of the robot as `BodyPose.state`, shape (6,).
            margin: Margin of background added on all four sides, in lengths of the robot [-].

        Returns:
            True where the box occludes, shape (height, width).
        """
        width, height = self.camera.size
        return _filled(self._outline(state, self._corners(margin)), (height, width))

    def top_seen(self, state: Array) -> NDArray[np.bool_]:
        """Compute the mask of a photograph's pixels on the box's top, shape (height, width).

        Args:
            state: Pose of the robot as `BodyPose.state`, shape (6,).
        """
        width, height = self.camera.size
        # Of the corners every second one is an upper one.
        return _filled(self._outline(state, self._corners(0.0)[1::2]), (height, width))

    def hidden_on(self, plane: Plane, pose: Array, *, margin: float) -> NDArray[np.bool_]:
        """Compute the mask of the points on the plane of the robot's top that the box occludes.

        The box stands level at the pose, and occludes what is behind it as seen from the camera.

        Args:
            plane: Raster on the plane of the robot's top.
            pose: x, y [m] and yaw [rad] of the robot, shape (3,).
            margin: Margin of background added on all four sides, in lengths of the robot [-].

        Returns:
            True where the box occludes, shape (rows, columns); as in `Plane`, row 0 is at the
            largest y and column 0 at the smallest x.
        """
        state = np.array([pose[0], pose[1], self.height, 0.0, 0.0, pose[2]])
        seen = self._outline(state, self._corners(margin))
        xy = to_floor(self.camera, self.view, seen, self.height + self.top)
        points = np.column_stack((xy[:, 0] - plane.low[0], plane.high[1] - xy[:, 1])) / plane.cell
        return _filled(points, plane.seen_px.shape[:2])

    def _corners(self, margin: float) -> Array:
        """Return the box's corners in the body frame, with margins, (8, 3) [m].

        Each lower corner precedes the upper one above it.
        """
        length, width = self.size
        return np.array([
            (side_x * (0.5 + margin) * length, side_y * (0.5 * width + margin * length), z)
            for side_x in (-1, 1)
            for side_y in (-1, 1)
            for z in (-self.top, self.top)
        ])  # fmt: skip

    def _outline(self, state: Array, points_body: Array) -> Array:
        """Project points of the body for a pose (6,), shape (n, 2) [px]."""
        return project(self.camera, self.view, body_to_floor(points_body, state))


def _filled(points: Array, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Fill the convex hull of points (column, row) in a mask; all False if any is not finite."""
    mask = np.zeros(shape, dtype=np.uint8)
    if np.isfinite(points).all():
        cv2.fillConvexPoly(mask, cv2.convexHull(np.round(points).astype(np.int32)), (1,))
    return mask.astype(bool)
