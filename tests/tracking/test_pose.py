# SPDX-License-Identifier: MIT
"""The robot's pose comes back from its marker, with the error it states."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracking.camera import Camera, CameraPose, project
from tracking.detect import RobotMarker
from tracking.errors import MarkerError
from tracking.markers import edge_growth
from tracking.pose import (
    BodyPrior,
    body_to_floor,
    fit_pose,
    rotation_with_derivatives,
)
from tracking.shared import CAMERA, EDGES, HEIGHT, LENS, PLACE, SIDE, TURN

GLASS = Camera((1280, 960), np.array([[1394.0, 0, 640], [0, 1394, 480], [0, 0, 1]]), np.zeros(5))
MARKER = RobotMarker(0, 0.12, "4x4_50", (0.01, 0.0, 0.04))
PRIOR = BodyPrior(0.1, height_sd=5e-3, tilt_sd=np.radians(2))
_VIEW = [[1.0, 0, 0], [0, -0.74, -0.67], [0, 0.67, -0.74]]
VIEW = CameraPose.from_matrix(np.linalg.svd(_VIEW)[0] @ np.linalg.svd(_VIEW)[2], [-1.0, 0.55, 3.0])


def corners_of(state, noise_px=0.0, rng=None):
    turn = Rotation.from_euler("ZYX", [state[5], state[4], state[3]]).as_matrix()
    corners = project(GLASS, VIEW, MARKER.points_body @ turn.T + state[:3])
    return corners if rng is None else corners + noise_px * rng.standard_normal(corners.shape)


def fitted(corners, sigma=0.05, view=VIEW, prior=PRIOR):
    return fit_pose(
        GLASS, view, points_body=MARKER.points_body, corners_px=corners,
        covariance=sigma**2 * np.eye(8), prior=prior,
    )  # fmt: skip


@given(x=st.floats(0, 2), y=st.floats(0, 1.5), yaw=st.floats(-3.1, 3.1))
def test_a_level_robot_at_its_height_comes_back_exactly(x, y, yaw):
    corners = corners_of([x, y, 0.1, 0, 0, yaw])
    pose = fitted(corners)
    np.testing.assert_allclose(pose.planar, [x, y, yaw], atol=1e-6)
    np.testing.assert_allclose(corners_of(pose.state), corners, atol=5e-5)


def test_ninety_percent_intervals_cover_ninety_percent():
    rng = np.random.default_rng(0)
    z = []
    for _ in range(600):
        state = np.array([
            rng.uniform(0, 2), rng.uniform(0, 1.5), 0.1 + rng.normal(0, PRIOR.height_sd),
            *rng.normal(0, PRIOR.tilt_sd, 2), rng.uniform(-3, 3),
        ])  # fmt: skip
        pose = fitted(corners_of(state, 0.05, rng))
        z.append((pose.planar - state[[0, 1, 5]]) / np.sqrt(np.diag(pose.planar_covariance)))
    assert np.abs(np.mean(np.abs(z) < 1.645, axis=0) - 0.9).max() < 0.04


def test_an_error_of_the_camera_shows_in_its_own_covariance():
    rng = np.random.default_rng(1)
    spread = np.diag([2e-4, 2e-4, 2e-4, 1e-3, 1e-3, 1e-3]) ** 2
    view = CameraPose(VIEW.rotation_vector, VIEW.translation, spread)
    truth, found = np.array([1.0, 0.5, 0.1, 0, 0, 0.3]), []
    for _ in range(300):
        shift = rng.multivariate_normal(np.zeros(6), spread)
        wrong = CameraPose(VIEW.rotation_vector + shift[:3], VIEW.translation + shift[3:], spread)
        found.append(fitted(corners_of(truth), view=wrong).state)
    by_camera = fitted(corners_of(truth), view=view).by_cause[CAMERA]
    stated = by_camera @ spread @ by_camera.T
    np.testing.assert_allclose(np.std(found, axis=0), np.sqrt(np.diag(stated)), rtol=0.15)


def test_height_ignored_is_an_error_and_modelled_is_not():
    corners = corners_of([0.3, 1.2, 0.1, 0, 0, 0])
    flat = fitted(corners, prior=BodyPrior(0.0, height_sd=1e-4, tilt_sd=1e-4))
    assert np.hypot(*(flat.planar[:2] - [0.3, 1.2])) > 0.05
    assert np.hypot(*(fitted(corners).planar[:2] - [0.3, 1.2])) < 1e-6


@pytest.mark.parametrize("cause", [LENS, SIDE, PLACE, TURN, EDGES, HEIGHT])
def test_a_pose_follows_what_is_shared_by_its_derivative(cause):
    """A small error of lens, marker, edges or height moves the fitted pose as it says."""
    corners = corners_of([1.0, 0.5, 0.104, 0.01, -0.02, 0.3])
    growth = edge_growth(corners)
    sizes = {LENS: np.array([2.0, 1.0, 1.0, -1.0, 1e-3, 0, 1e-4, 1e-4, 0]), SIDE: np.array([1e-4]),
             PLACE: np.array([2e-4, -1e-4]), TURN: np.array([1e-3]), EDGES: np.array([0.02]),
             HEIGHT: np.array([5e-4])}  # fmt: skip
    error = sizes[cause]

    def fit(share):
        lens, marker, prior, seen = GLASS, MARKER, PRIOR, corners
        if cause == LENS:
            lens = GLASS.changed(share * error)
        elif cause == SIDE:
            marker = replace(MARKER, side=MARKER.side + share * error[0])
        elif cause == PLACE:
            x, y, z = MARKER.position
            marker = replace(MARKER, position=(x + share * error[0], y + share * error[1], z))
        elif cause == TURN:
            marker = replace(MARKER, yaw=MARKER.yaw + share * error[0])
        elif cause == EDGES:
            seen = corners - share * error[0] * growth
        else:
            prior = replace(PRIOR, height=PRIOR.height + share * error[0])
        return fit_pose(
            lens, VIEW, points_body=marker.points_body, corners_px=seen,
            covariance=0.05**2 * np.eye(8), prior=prior,
            points_by=marker.derivatives_at(marker.points_body),
            pixels_by={EDGES: growth[:, :, None]},
        )  # fmt: skip

    moved = fit(0.5).state - fit(-0.5).state
    stated = fit(0.0).with_prior(PRIOR)[cause] @ error
    np.testing.assert_allclose(moved, stated, rtol=0.02, atol=1e-7)


@given(st.tuples(*[st.floats(-1, 1)] * 3))
def test_the_rotation_is_the_conventions_and_its_derivative_is_right(angles):
    R, dR = rotation_with_derivatives(*angles)
    np.testing.assert_allclose(R, Rotation.from_euler("ZYX", angles[::-1]).as_matrix(), atol=1e-12)
    for index in range(3):
        step = 1e-6 * np.eye(3)[index]
        ends = [rotation_with_derivatives(*(angles + s * step))[0] for s in (1, -1)]
        np.testing.assert_allclose(dR[index], (ends[0] - ends[1]) / 2e-6, atol=1e-8)


@given(st.tuples(*[st.floats(-1, 1)] * 6))
def test_points_of_the_body_are_turned_and_then_moved_to_the_floor(state):
    turn = Rotation.from_euler("ZYX", [state[5], state[4], state[3]])
    expected = turn.apply(MARKER.points_body) + state[:3]
    np.testing.assert_allclose(
        body_to_floor(MARKER.points_body, np.array(state)), expected, atol=1e-12
    )


def test_a_marker_without_a_side_is_refused():
    with pytest.raises(MarkerError, match="side 0"):
        RobotMarker(0, 0, "4x4_50", (0, 0, 0))


@pytest.mark.reference
def test_the_robots_marker_has_the_corners_of_the_virtual_world(shared):
    file = shared / "virtual-world/photos/camera.json"
    top = json.loads(file.read_text(encoding="utf-8"))["top_marker"]
    robot = RobotMarker(0, 0.12, "4x4_50", (0, 0, 0.0385))
    np.testing.assert_allclose(robot.points_body, top["corners_body"], atol=1e-9)
