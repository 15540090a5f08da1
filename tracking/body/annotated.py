# SPDX-License-Identifier: MIT
"""Errors of a template that was cut out at a pose fitted to clicks: alike in all photographs.

With an annotated pose that is wrong, the template's points lie elsewhere on the robot than is
assumed. A point q of the body frame, on the flat top, is cut out at the pixel to which the
annotated pose takes it. If the true pose is the annotated one plus d (six coordinates), what is
there belongs to the point q + u of the top with

    (d pixel / d q) u + (d pixel / d pose) d = 0 .

Of d = (x, y, z, roll, pitch, yaw), x, y and yaw shift and turn the template on the body; z makes it
too large and shifts it along the line of sight; roll and pitch foreshorten it.
"""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from tracking.camera.lens import Camera, CameraPose, project, project_with_derivatives
from tracking.pose import HELD, BodyPose, BodyPrior, body_to_floor, rotation_with_derivatives
from tracking.shared import ANNOTATION, HEIGHT, TILT


@dataclass(frozen=True)
class AnnotatedPose:
    """A pose of the robot fitted to clicks, at which a template is cut out.

    Its errors are given in the body frame: x and y along the body, then z, roll, pitch and yaw.

    Attributes:
        camera: Camera intrinsics and distortion.
        view: Pose of the camera in the annotated photograph.
        pose: The pose, by `tracking.pose.fit_pose` to the clicks.
        prior: Prior of height and tilt with which it was fitted.
        corners_body: Corners of the robot's top in the body frame, shape (4, 3) [m].
    """

    camera: Camera
    view: CameraPose
    pose: BodyPose
    prior: BodyPrior
    corners_body: Array

    @property
    def corners_px(self) -> Array:
        """Corners of the top in the photograph, projected at the pose, shape (4, 2) [px]."""
        corners = body_to_floor(self.corners_body, self.pose.state)
        return project(self.camera, self.view, corners)

    @property
    def covariance(self) -> Array:
        """Covariance of the errors, by clicks and by height and tilt in that photograph, (6, 6)."""
        into_body = self._along_body.T
        return into_body @ self.pose.covariance @ into_body.T

    @property
    def by_mean(self) -> Array:
        """Derivative of the errors by those of the prior's height, roll and pitch, shape (6, 3)."""
        by_mean = self.pose.covariance[:, HELD] @ np.linalg.inv(self.prior.covariance)
        return self._along_body.T @ by_mean

    @property
    def _along_body(self) -> Array:
        """Rotation of x and y of the body to those of the floor, others as they are, (6, 6)."""
        turn = np.eye(6)
        c, s = np.cos(self.pose.state[5]), np.sin(self.pose.state[5])
        turn[:2, :2] = [[c, -s], [s, c]]
        return turn

    def points_by(self, points_body: Array) -> dict[str, Array]:
        """Compute how a template's points move on the body with the errors (u of the module).

        Args:
            points_body: Points of the template in the body frame, shape (n, 3) [m].

        Returns:
            Derivative of the points by the errors (`ANNOTATION`, shape (n, 3, 6)), by the mean
            height (n, 3, 1) and the mean tilt of the body (n, 3, 2).
        """
        R, dR = rotation_with_derivatives(*self.pose.state[3:])
        at = points_body @ R.T + self.pose.state[:3]
        seen = project_with_derivatives(self.camera, self.view, at)
        by_pose = np.empty((len(points_body), 3, 6))
        by_pose[:, :, :3] = np.eye(3)
        by_pose[:, :, 3:] = np.einsum("kab,nb->nak", dR, points_body)
        on_top = seen.by_point @ R[:, :2]
        moved = np.zeros((len(points_body), 3, 6))
        moved[:, :2] = -np.linalg.solve(on_top, seen.by_point @ by_pose @ self._along_body)
        by_mean = moved @ self.by_mean
        return {ANNOTATION: moved, HEIGHT: by_mean[:, :, :1], TILT: by_mean[:, :, 1:]}

    def as_a_whole(self, yaw: float) -> dict[str, Array]:
        """Differentiate a pose found with the template by the errors, the template moving rigidly.

        For aligners that do not tell how they follow each point. A least-squares shift and turn
        stand for the movement of the points; size and foreshortening are left out.

        Args:
            yaw: Heading of the robot where it was found [rad].

        Returns:
            Derivative of the pose (6, k) by the causes of `points_by`.
        """
        x, y = self.corners_body[:, :2].T
        rigid = np.zeros((2 * len(x), 3))  # x and y of each corner by shift and turn
        rigid[0::2, 0] = rigid[1::2, 1] = 1.0
        rigid[0::2, 2], rigid[1::2, 2] = -y, x
        c, s = np.cos(yaw), np.sin(yaw)
        found = {}
        for cause, moved in self.points_by(self.corners_body).items():
            flat = moved[:, :2].reshape(len(rigid), -1)
            shift = np.linalg.lstsq(rigid, flat, rcond=None)[0]
            found[cause] = np.zeros((6, flat.shape[1]))
            found[cause][:2] = -np.array([[c, -s], [s, c]]) @ shift[:2]
            found[cause][5] = -shift[2]
        return found
