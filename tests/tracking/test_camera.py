# SPDX-License-Identifier: MIT
"""The lens projects and un-projects consistently; calibration finds the lens behind the views."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.camera import (
    Camera,
    CameraPose,
    CharucoBoard,
    Checkerboard,
    SeenBoard,
    calibrate,
    find_board,
    project,
    project_with_derivatives,
    to_floor,
)
from tracking.dictionaries import dictionary_named
from tracking.errors import CalibrationError

LENS = Camera(
    (1280, 960),
    np.array([[1400.0, 0, 630.0], [0, 1395.0, 490.0], [0, 0, 1]]),
    np.array([-0.12, 0.05, 1e-3, -5e-4, 0.01]),
)


def looking_down(x: float = 1.0, y: float = -1.6, z: float = 2.6) -> CameraPose:
    eye, target = np.array([x, y, z]), np.array([1.0, 0.7, 0.0])
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.vstack((right, np.cross(ahead, right), ahead))
    return CameraPose.from_matrix(rotation, -rotation @ eye)


def board_views(lens: Camera, noise_px: float, rng: np.random.Generator) -> list[SeenBoard]:
    column, row = np.meshgrid(np.arange(9), np.arange(6))
    points = np.column_stack((column.ravel(), row.ravel(), np.zeros(54))) * 0.03
    views = []
    for index in range(14):
        tilt = rng.uniform(-0.7, 0.7, 3)
        shift = np.array([rng.uniform(-0.25, 0.1), rng.uniform(-0.2, 0.1), rng.uniform(0.55, 0.8)])
        corners = project(lens, CameraPose(tilt, shift, np.zeros((6, 6))), points)
        corners += noise_px * rng.standard_normal(corners.shape)
        views.append(SeenBoard(f"view {index}", points, corners))
    return views


@given(x=st.floats(-0.3, 2.2), y=st.floats(-0.4, 1.8), height=st.floats(0.0, 0.25))
def test_a_plane_comes_back_from_its_own_picture(x, y, height):
    pose = looking_down()
    pixel = project(LENS, pose, [[x, y, height]])
    np.testing.assert_allclose(to_floor(LENS, pose, pixel, height), [[x, y]], atol=1e-5)


def test_a_pixel_above_the_horizon_shows_no_floor():
    straight = Camera(LENS.size, LENS.matrix, np.zeros(5))
    assert np.isnan(to_floor(straight, looking_down(), [[600.0, -4000.0]])).all()


def test_derivatives_agree_with_finite_differences():
    pose, points = looking_down(), np.array([[0.4, 0.3, 0.1], [1.5, 1.0, 0.0]])
    _, by_point, by_pose = project_with_derivatives(LENS, pose, points)
    step = 1e-6
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        moved = project(LENS, pose, points + shift) - project(LENS, pose, points - shift)
        np.testing.assert_allclose(by_point[:, :, axis], moved / (2 * step), rtol=1e-4, atol=1e-2)
    for axis in range(6):
        shift = step * np.eye(6)[axis]
        ends = [
            CameraPose(pose.rotation_vector + s * shift[:3], pose.translation + s * shift[3:],
                       pose.covariance)
            for s in (1, -1)
        ]  # fmt: skip
        moved = project(LENS, ends[0], points) - project(LENS, ends[1], points)
        np.testing.assert_allclose(by_pose[:, :, axis], moved / (2 * step), rtol=1e-4, atol=1e-2)


def test_a_scaled_picture_shows_the_same_scene():
    # Pixel (u, v) of the small picture covers the middle of pixels 2u, 2u + 1 of the large one.
    large = LENS.scaled((2560, 1920))
    point = [[0.7, 0.4, 0.1]]
    small_px = project(LENS, looking_down(), point)
    large_px = project(large, looking_down(), point)
    np.testing.assert_allclose((large_px + 0.5) / 2 - 0.5, small_px, atol=1e-9)


def test_a_cropped_picture_is_refused():
    with pytest.raises(ValueError, match="1280x720"):
        LENS.scaled((1280, 720))


def test_calibration_finds_the_lens_within_its_own_error():
    rng = np.random.default_rng(3)
    fit = calibrate(board_views(LENS, 0.1, rng), LENS.size)
    found = [*fit.camera.matrix[[0, 1, 0, 1], [0, 1, 2, 2]], *fit.camera.distortion]
    truth = [1400.0, 1395.0, 630.0, 490.0, *LENS.distortion]
    fitted = fit.sd > 0
    z = (np.array(found) - truth)[fitted] / fit.sd[fitted]
    assert np.abs(z).max() < 4
    assert fit.rms == pytest.approx(0.1 * np.sqrt(2), rel=0.1)


def test_a_straight_lens_is_not_given_a_distortion():
    straight = Camera(LENS.size, LENS.matrix, np.zeros(5))
    fit = calibrate(board_views(straight, 0.1, np.random.default_rng(4)), straight.size)
    assert fit.lens_model == "none"


def test_boards_in_the_middle_only_are_reported():
    views = [
        SeenBoard(view.name, view.points, (view.corners_px - [640, 480]) * 0.4 + [640, 480])
        for view in board_views(LENS, 0.05, np.random.default_rng(5))
    ]
    fit = calibrate(views, LENS.size)
    assert fit.coverage < 0.4
    assert "cover" in fit.warnings[0]


def test_a_picture_that_does_not_fit_is_named():
    views = board_views(LENS, 0.05, np.random.default_rng(6))
    spoilt = views[3].corners_px + np.random.default_rng(0).normal(0, 2.0, (54, 2))
    views[3] = SeenBoard("view 3", views[3].points, spoilt)
    assert any(message.startswith("view 3") for message in calibrate(views, LENS.size).warnings)


def test_two_views_are_too_few():
    with pytest.raises(CalibrationError, match="2 pictures"):
        calibrate(board_views(LENS, 0.1, np.random.default_rng(0))[:2], LENS.size)


def test_an_unknown_lens_model_is_named():
    with pytest.raises(CalibrationError, match="fisheye"):
        calibrate(board_views(LENS, 0.1, np.random.default_rng(0)), LENS.size, lens_model="fisheye")


def test_a_charuco_board_is_found_in_part():
    board = CharucoBoard(7, 5, 0.04, 0.03, "4x4_50")
    target = cv2.aruco.CharucoBoard((7, 5), 0.04, 0.03, dictionary_named("4x4_50"))
    picture = np.full((600, 800), 255, np.uint8)
    picture[100:500, 100:660] = target.generateImage((560, 400))
    whole = find_board(picture, board)
    picture[:, 400:] = 255
    part = find_board(picture, board)
    assert whole is not None
    assert part is not None
    assert len(whole.points) == 24
    assert 6 <= len(part.points) < 24
    # 80 px a square, first inner corner one square in; the edge lies between two pixels.
    expected = whole.points[:, :2] / 0.04 * 80 + 100 - 0.5
    np.testing.assert_allclose(whole.corners_px, expected, atol=0.1)


def test_no_board_is_no_view():
    empty = np.full((300, 400), 128, np.uint8)
    assert find_board(empty, Checkerboard(9, 6, 0.03)) is None
    assert find_board(empty, CharucoBoard(7, 5, 0.04, 0.03, "4x4_50")) is None


@pytest.mark.reference
def test_real_checkerboards_give_the_published_focal_length(shared):
    views, size = [], (0, 0)
    for path in sorted((shared / "realdata/checkerboards").glob("left*.jpg")):
        picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        size = (picture.shape[1], picture.shape[0])
        views.append(find_board(picture, Checkerboard(9, 6, 0.025), name=path.name))
    assert len(views) == 13
    assert None not in views
    fit = calibrate(views, size)
    assert fit.camera.matrix[0, 0] == pytest.approx(535.9, rel=0.005)
    assert fit.rms <= 0.42


@pytest.mark.reference
def test_boards_of_the_virtual_world_give_its_camera(shared):
    views = [
        find_board(cv2.imread(str(path)), Checkerboard(9, 6, 0.03), name=path.name)
        for path in sorted((shared / "virtual-world/photos/calib").glob("*.jpg"))
    ]
    fit = calibrate(views, (1280, 960))
    assert fit.lens_model == "none"
    assert abs(fit.camera.matrix[0, 0] - 1394.02) < 3 * fit.sd[0]
    assert abs(fit.camera.matrix[1, 1] - 1394.02) < 3 * fit.sd[1]
