# SPDX-License-Identifier: MIT
"""Synthetic composite pictures of a blue board on a brown floor."""

import cv2
import numpy as np

from tracking.body import TopPlate, floor_in_view
from tracking.body.plane import Plane
from tracking.camera import Camera, CameraPose, project
from tracking.composite import find_exposures_like, order_exposures
from tracking.composite.known import KnownExposure
from tracking.markers import square_homography
from tracking.pose import BodyPose, BodyPrior

LENS = Camera((640, 400), np.array([[760.0, 0, 320], [0, 760, 200], [0, 0, 1]]), np.zeros(5))
_TURN = np.linalg.svd([[1.0, 0, 0], [0, -0.85, -0.53], [0, 0.53, -0.85]])
VIEW = CameraPose.from_matrix(_TURN[0] @ _TURN[2], [0.0, 0.15, 1.6])
SIZE, TOP = (0.20, 0.20), 0.03  # m
PLATE = TopPlate(0.19, 0.19, TOP)
PRIOR = BodyPrior(0.06, 1e-3, 5e-3)


def floor(rng):
    """Draw a brown floor with a pattern in light."""
    pattern = cv2.GaussianBlur(rng.normal(0, 1, (400, 640)).astype(np.float32), (0, 0), 2)
    light = 110 + 9 * pattern / pattern.std()
    return light[..., None] * np.array([0.75, 0.95, 1.1])


def robot():
    """Draw a blue board with a red head and patches, without any symmetry."""
    picture = np.tile(np.array([120.0, 60, 30]), (80, 80, 1))
    picture[:10, 25:55] = (30, 30, 190)
    for row, column, colour in (
        (20, 12, (60, 140, 90)), (45, 50, (200, 190, 180)), (55, 15, (30, 30, 30)),
        (25, 45, (140, 90, 170)),
    ):  # fmt: skip
        picture[row : row + 16, column : column + 20] = colour
    return picture


def exposure(planar, rng, ground, light=1.0):
    """Draw one photograph of the board.

    Args:
        planar: x, y [m] and yaw [rad] of the board, shape (3,).
        rng: Random numbers for the noise.
        ground: Picture of the floor, shape (400, 640, 3).
        light: Factor on the board's brightness [-].

    Returns:
        The photograph, and the mask of pixels that show the board.
    """
    c, s = np.cos(planar[2]), np.sin(planar[2])
    corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * 0.5 * np.array(SIZE)
    corners = corners @ np.array([[c, s], [-s, c]]) + planar[:2]
    seen = project(LENS, VIEW, np.column_stack((corners, np.full(4, PRIOR.height + TOP))))
    own = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 80]]) / 80
    H = square_homography(seen) @ own
    drawn = cv2.warpPerspective(light * robot(), H, (640, 400), flags=cv2.INTER_AREA)
    mask = cv2.warpPerspective(np.ones((80, 80)), H, (640, 400))[..., None]
    picture = cv2.GaussianBlur(ground * (1 - mask) + drawn * mask, (0, 0), 0.6)
    return np.clip(picture + rng.normal(0, 1.2, picture.shape), 0, 255), mask[..., 0] > 0.05


def composite(walk, seed=0, lights=None, around_px=0):
    """Draw exposures of a walk and paste them into one picture, later ones on top.

    Args:
        walk: Poses x, y [m] and yaw [rad], shape (n, 3).
        seed: Seed of floor and noise.
        lights: Factor on the brightness of each exposure, or None for 1 [-].
        around_px: Margin of floor that is cut out with a pasted exposure [px].
    """
    rng = np.random.default_rng(seed)
    ground = floor(rng)
    lights = np.ones(len(walk)) if lights is None else lights
    pictures, masks = zip(
        *(exposure(planar, rng, ground, light) for planar, light in zip(walk, lights, strict=True)),
        strict=True,
    )
    whole = pictures[0].copy()
    scissors = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * around_px + 1,) * 2)
    for picture, mask in zip(pictures, masks, strict=True):
        cut = cv2.dilate(mask.astype(np.uint8), scissors) > 0
        whole[cut] = picture[cut]
    return whole.astype(np.uint8)


def steady_walk(start, step, turn, count):
    """Return poses that begin at x, y, yaw and go on by equal steps and turns, shape (count, 3)."""
    poses = [np.asarray(start, dtype=float)]
    for _ in range(count - 1):
        x, y, yaw = poses[-1]
        along = yaw + turn / 2
        poses.append(np.array([x + step * np.cos(along), y + step * np.sin(along), yaw + turn]))
    return np.array(poses)


def known_at(planar):
    state = np.array([planar[0], planar[1], PRIOR.height, 0, 0, planar[2]])
    return BodyPose(state, np.zeros((6, 6)))


def found_in(picture, planar, **other):
    found = find_exposures_like(
        picture, LENS, VIEW, known=known_at(planar), plate=PLATE, body_size=SIZE, prior=PRIOR,
        **other,
    )  # fmt: skip
    poses = np.array([each.alignment.pose.planar for each in found])
    return poses[list(order_exposures(poses))]


def likeness(picture, planar, *, reach):
    """Make a `KnownExposure` for a search around the middle of the picture.

    Args:
        picture: The composite picture.
        planar: x, y [m] and yaw [rad] of the known exposure, shape (3,).
        reach: Half width of the area to search [m].
    """
    area = floor_in_view(LENS, VIEW, PRIOR.height + TOP, (0.0, 0.0), reach)
    hidden = np.zeros(picture.shape[:2], dtype=bool)
    return KnownExposure(picture, LENS, VIEW, PRIOR, known_at(planar), PLATE, SIZE, hidden, area)


def level_plane():
    low, high = np.array([-0.5, -0.4]), np.array([0.5, 0.4])
    return Plane.over(LENS, VIEW, height=PRIOR.height + TOP, low=low, high=high, cell=0.006)
