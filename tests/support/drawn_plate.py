# SPDX-License-Identifier: MIT
"""Synthetic pictures of a plate with a stripe at its head on a wooden floor."""

import cv2
import numpy as np

from tracking.body import TopPlate
from tracking.camera import Camera, CameraPose, project
from tracking.pose import BodyPrior, fit_pose, rotation_with_derivatives

LENS = Camera((640, 480), np.array([[700.0, 0, 320], [0, 700, 240], [0, 0, 1]]), np.zeros(5))
_TURN = np.linalg.svd([[1.0, 0, 0], [0, -0.85, -0.53], [0, 0.53, -0.85]])
VIEW = CameraPose.from_matrix(_TURN[0] @ _TURN[2], [0.0, 0.2, 2.0])
PLATE = TopPlate(0.24, 0.16, 0.03, margin=0.01, front_margin=0.01)
PRIOR = BodyPrior(0.1)


def picture_of(planar, rng, *, noise=2.0):
    """Draw a plate with a bright stripe at its head on a wooden floor, by inverse mapping."""
    u, v = np.meshgrid(np.arange(640.0), np.arange(480.0))
    ground = _on_plane(u, v, 0.0)
    top = _on_plane(u, v, PRIOR.height + PLATE.height)
    shade = 120 + 10 * np.sin(40 * ground[1]) + 6 * np.sin(9 * ground[0] + 20 * ground[1])
    picture = np.stack((0.7 * shade, shade, 1.2 * shade), axis=-1)
    c, s = np.cos(planar[2]), np.sin(planar[2])
    dx, dy = top[0] - planar[0], top[1] - planar[1]
    x, y = c * dx + s * dy, -s * dx + c * dy
    picture[(np.abs(x) < 0.12) & (np.abs(y) < 0.08)] = (150, 70, 30)
    picture[(np.abs(x - 0.09) < 0.015) & (np.abs(y) < 0.06)] = (220, 220, 230)
    picture[(np.abs(x + 0.03) < 0.02) & (np.abs(y - 0.03) < 0.02)] = (40, 40, 200)
    picture = cv2.GaussianBlur(picture, (0, 0), 0.8) + noise * rng.standard_normal(picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8)


def _on_plane(u, v, height):
    ahead = np.stack(((u - 320) / 700, (v - 240) / 700, np.ones_like(u)), axis=-1) @ VIEW.rotation
    eye = VIEW.position
    reach = (height - eye[2]) / ahead[..., 2]
    return eye[0] + reach * ahead[..., 0], eye[1] + reach * ahead[..., 1]


def annotated(planar):
    state = np.array([planar[0], planar[1], PRIOR.height, 0, 0, planar[2]])
    R, _ = rotation_with_derivatives(0, 0, planar[2])
    corners = project(LENS, VIEW, PLATE.corners_body @ R.T + state[:3])
    return fit_pose(
        LENS, VIEW, points_body=PLATE.corners_body, corners_px=corners,
        covariance=0.1 * np.eye(8), prior=PRIOR,
    )  # fmt: skip
