# SPDX-License-Identifier: MIT
"""Exposures of a robot are found by its marker or by how one of them looks, and none is made up."""

import cv2
import numpy as np
import pytest

from support.drawn_board import composite, found_in, steady_walk
from tracking.camera import Camera, CameraPose, project
from tracking.composite import find_exposures, order_exposures
from tracking.detect import RobotMarker
from tracking.errors import CompositeError
from tracking.markers import marker_picture, square_homography
from tracking.pose import BodyPrior, fit_pose, rotation_with_derivatives

LENS = Camera((800, 500), np.array([[900.0, 0, 400], [0, 900, 250], [0, 0, 1]]), np.zeros(5))
_TURN = np.linalg.svd([[1.0, 0, 0], [0, -0.85, -0.53], [0, 0.53, -0.85]])
VIEW = CameraPose.from_matrix(_TURN[0] @ _TURN[2], [0.0, 0.15, 1.8])
MARKER = RobotMarker(3, 0.12, "4x4_50", (0.0, 0.0, 0.03))
PRIOR = BodyPrior(0.1)
WALK = np.array([[-0.2, -0.08, 0.3], [0.0, 0.0, 0.45], [0.2, 0.12, 0.6]])


def exposure_of(planar, rng, number=3):
    """Draw one exposure: a board with a marker on a level floor."""
    u = np.arange(800.0)[None, :] + 0 * np.arange(500.0)[:, None]
    picture = 140 + 8 * np.sin(0.21 * u) + 6 * np.sin(0.05 * u + 0.3 * np.arange(500.0)[:, None])
    R, _ = rotation_with_derivatives(0, 0, planar[2])
    corners = project(LENS, VIEW, MARKER.points_body @ R.T + [planar[0], planar[1], PRIOR.height])
    drawn = marker_picture("4x4_50", number, 32)
    own = np.array([[1, 0, 0.5 - 32], [0, 1, 0.5 - 32], [0, 0, 192]]) / 192
    H = square_homography(corners) @ own
    fine = np.array([[4, 0, 1.5], [0, 4, 1.5], [0, 0, 1.0]])
    layers = [
        cv2.resize(cv2.warpPerspective(layer, fine @ H, (3200, 2000)), (800, 500),
                   interpolation=cv2.INTER_AREA)
        for layer in (200 * drawn + 20, np.ones_like(drawn))
    ]  # fmt: skip
    picture = picture * (1 - layers[1]) + layers[0] * layers[1]
    picture = cv2.GaussianBlur(picture, (0, 0), 0.7) + rng.normal(0, 1.5, picture.shape)
    return np.clip(picture, 0, 255), layers[1] > 0.05


def pasted(pairs):
    whole = pairs[0][0].copy()
    for picture, mask in pairs:
        whole[mask] = picture[mask]
    return colours(whole)


def colours(grey):
    return np.repeat(grey.astype(np.uint8)[:, :, None], 3, axis=2)


def pose_of(sighting):
    return fit_pose(
        LENS, VIEW, points_body=MARKER.points_body, corners_px=sighting.corners_px,
        covariance=sighting.covariance, prior=PRIOR,
    )  # fmt: skip


def exposures_in(picture, **other):
    asked = {"body_size": (0.16, 0.16), "near": (0, 0), "reach": 0.3} | other
    return find_exposures(picture, LENS, VIEW, marker=MARKER, pose_of=pose_of, prior=PRIOR, **asked)


@pytest.fixture(scope="module")
def exposures():
    """Return the exposures of a walk, each with where it shows the robot."""
    rng = np.random.default_rng(0)
    return [exposure_of(planar, rng) for planar in WALK]


@pytest.mark.long
def test_exposures_apart_are_all_found_and_in_order(exposures):
    found = exposures_in(pasted(exposures), reach=0.3)
    poses = np.array([exposure.alignment.pose.planar for exposure in found])
    assert len(poses) == len(WALK)
    error = poses[list(order_exposures(poses))] - WALK
    assert np.abs(error[:, :2]).max() < 5e-3
    assert np.degrees(np.abs(error[:, 2]).max()) < 1.0


@pytest.mark.long
def test_an_exposure_under_its_successor_is_found_and_none_is_made_up():
    walk = np.array([[-0.12, 0.0, 0.0], [-0.025, 0.0, 0.0], [0.17, 0.0, 0.0]])
    rng = np.random.default_rng(1)
    found = exposures_in(pasted([exposure_of(planar, rng) for planar in walk]))
    poses = np.array([exposure.alignment.pose.planar for exposure in found])
    distances = np.hypot(*(poses[:, None, :2] - walk[None, :, :2]).transpose(2, 0, 1))
    assert sorted(distances.argmin(axis=1)) == [0, 1, 2]
    assert distances.min(axis=1).max() < 5e-3
    assert min(exposure.visible for exposure in found) < 0.95


@pytest.mark.parametrize(("planar", "number"), [((9.0, 9.0, 0.0), 3), ((0.0, 0.0, 0.3), 43)])
def test_an_empty_floor_and_another_marker_have_no_exposure(planar, number):
    picture, _ = exposure_of(planar, np.random.default_rng(2), number)
    with pytest.raises(CompositeError, match=r"no exposure .* give the photographs themselves"):
        exposures_in(colours(picture))


def test_exposures_without_a_marker_that_overlap_are_found_in_order_and_none_is_made_up():
    walk = steady_walk((-0.12, -0.05, 0.15), 0.11, 0.12, 3)
    poses = found_in(composite(walk), walk[-1], near=(0.0, 0.0), reach=0.25)
    assert len(poses) == len(walk)
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 5e-3
    assert np.degrees(np.abs(poses[:, 2] - walk[:, 2]).max()) < 2.5


def test_one_exposure_alone_is_no_composite():
    planar = np.array([0.0, 0.0, 0.3])
    with pytest.raises(CompositeError, match=r"no second exposure .* give the photographs themse"):
        found_in(composite(planar[None]), planar, near=(0, 0), reach=0.15)


def test_a_known_exposure_cut_by_the_edge_is_refused():
    picture = composite(np.array([[0.0, 0.0, 0.3]]))
    with pytest.raises(CompositeError, match="edge"):
        found_in(picture, np.array([0.66, 0.0, 0.0]), near=(0.5, 0), reach=0.4)
