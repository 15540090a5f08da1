# SPDX-License-Identifier: MIT
"""The lens comes back with its error, and what cannot determine it is named."""

import cv2
import numpy as np
import pytest

from support.drawn_boards import LENS
from tracking.camera import (
    Camera,
    CameraPose,
    Checkerboard,
    SeenBoard,
    calibrate,
    find_board,
    project,
)
from tracking.errors import CalibrationError


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


def few_views(seed: int) -> list[SeenBoard]:
    """Draw seven views by a lens that has tangential terms, which seldom show."""
    rng = np.random.default_rng([5, seed])
    bent = np.array([-0.1, 0.02, *rng.normal(0, 5e-4, 2), 0.0])
    return board_views(Camera(LENS.size, LENS.matrix, bent), 0.3, rng)[:7]


def test_terms_that_few_views_leave_out_are_uncertain_unless_said_to_be_zero():
    views = few_views(1)
    chosen, stated = (calibrate(views, LENS.size, lens_model=name) for name in ("auto", "k1"))
    assert chosen.lens_model == "k1"
    assert chosen.camera.matrix == pytest.approx(stated.camera.matrix)
    assert (chosen.sd[5:] > 0).all()
    assert (stated.sd[5:] == 0).all()
    assert chosen.sd[2] > 1.2 * stated.sd[2]


def test_terms_are_fitted_that_left_out_views_do_not_miss_but_all_views_show():
    assert calibrate(few_views(6), LENS.size).lens_model == "k1-k2"
    rng = np.random.default_rng(1)
    bent = np.array([-0.1, 0.02, 2e-3, -2e-3, 0.0])
    views = board_views(Camera(LENS.size, LENS.matrix, bent), 0.3, rng)[:7]
    assert calibrate(views, LENS.size).lens_model == "full"


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


def test_boards_seen_from_afar_by_a_telescope_are_refused():
    far = Camera(LENS.size, LENS.matrix * [[200, 1, 1], [1, 200, 1], [1, 1, 1]], np.zeros(5))
    views = [
        SeenBoard(f"view {k}", view.points, project(far, CameraPose(turn, shift, np.zeros((6, 6))),
                                                    view.points))
        for k, (view, turn, shift) in enumerate(
            (view, np.array([0.5 * np.cos(k), 0.5 * np.sin(k), 0.1 * k]), np.array([0, 0, 140.0]))
            for k, view in enumerate(board_views(LENS, 0.0, np.random.default_rng(6)))
        )
    ]  # fmt: skip
    with pytest.raises(
        CalibrationError, match=r"times the width of the picture|standard deviation"
    ):
        calibrate(views, LENS.size)
