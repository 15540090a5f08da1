# SPDX-License-Identifier: MIT
"""Edges of the robot's top refine clicks on its corners, where they are clear and agree."""

import cv2
import numpy as np
import pytest

from support.synthetic import look_at
from tracking.body import AnnotatedPose, TopPlate, refine_corners
from tracking.camera import Camera, CameraPose, project, to_floor
from tracking.pose import BodyPrior, fit_pose, rotation_with_derivatives

SIZE = (480, 360)
DRAWN = look_at((0.1, -0.7, 1.0), (0.0, 0.0, 0.0), width=SIZE[0], height=SIZE[1])
VIEW = CameraPose.from_matrix(DRAWN.rotation, DRAWN.translation)
LENS = Camera(SIZE, DRAWN.matrix, np.array([-0.25, 0.05, 0.0, 0.0, 0.0]))
PLATE = TopPlate(0.176, 0.15, 0.0385)
TRUE = np.array([0.05, -0.02, 0.0645, 0.0, 0.0, 0.4])
PRIOR = BodyPrior(0.0645, 5e-3, 0.02)
GREY, BLUE, WOOD = (160, 160, 165), (140, 70, 30), (90, 130, 170)


def corners(plate: TopPlate = PLATE, yaw: float = TRUE[5]) -> np.ndarray:
    """Project the corners of the top at the true pose."""
    R, _ = rotation_with_derivatives(0.0, 0.0, yaw)
    return project(LENS, VIEW, plate.corners_body @ R.T + TRUE[:3])


def around(plate: TopPlate, yaw: float) -> tuple[slice, slice]:
    """Return the rows and columns that hold the top and 40 mm around it."""
    larger = TopPlate(plate.length + 0.08, plate.width + 0.08, plate.height)
    at = corners(larger, yaw)
    low, high = np.floor(at.min(axis=0)), np.minimum(np.ceil(at.max(axis=0)), SIZE)
    (left, top), (right, bottom) = np.maximum(low, 0).astype(int), high.astype(int)
    return slice(top, bottom), slice(left, right)


def drawn(
    *, stripe: float | None = None, rim: tuple[int, int, int] = BLUE, beside: float | None = None,
    covered: float = 0.0, bulge: float = 0.0, plate: TopPlate = PLATE, yaw: float = TRUE[5],
):  # fmt: skip
    """Draw the top on a body 20 mm wider, with 4 x 4 samples a pixel of it, blur and noise.

    A stripe of the rim's colour may run inside the left edge, up to so many metres from it. The
    left edge may be missing, and another one so many metres beside it. A part of the left side may
    be covered by a bar across it, and the left side bulge out in the middle.
    """
    rows, columns = around(plate, yaw)
    u, v = np.meshgrid(
        np.arange(4 * columns.start, 4 * columns.stop), np.arange(4 * rows.start, 4 * rows.stop)
    )
    at = np.column_stack((u.ravel(), v.ravel())) / 4 - 0.375
    x, y = (to_floor(LENS, VIEW, at, TRUE[2] + plate.height)[:, :2] - TRUE[:2]).T
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = c * x + s * y, -s * x + c * y
    length, half = plate.length / 2, plate.width / 2
    left = half + (beside or 0.0) + bulge * (1 - np.minimum(np.abs(x) / length, 1) ** 2)
    outside = np.max([np.abs(x) - length, y - left, -half - y], axis=0)
    colours = np.select(
        [(outside < 0)[:, None], (outside < 0.02)[:, None]], [np.array(GREY), np.array(rim)], WOOD
    ).astype(float)
    if stripe is not None:
        inside = half - y
        colours[(inside > stripe / 2) & (inside < stripe) & (outside < 0)] = rim
    colours[(x < length) & (x > length - 2 * length * covered) & (np.abs(y - half) < 0.03)] = WOOD
    picture = np.full((SIZE[1], SIZE[0], 3), WOOD, dtype=float)
    picture[rows, columns] = colours.reshape(
        rows.stop - rows.start, 4, columns.stop - columns.start, 4, 3
    ).mean(axis=(1, 3))
    picture = cv2.GaussianBlur(picture, (0, 0), 0.8)
    picture += np.random.default_rng(0).normal(0, 2.0, picture.shape)
    return np.clip(np.round(picture), 0, 255).astype(np.uint8)


PICTURE = drawn()


def clicked(clicks: np.ndarray, sd: float = 0.5, plate: TopPlate = PLATE) -> AnnotatedPose:
    """Fit the pose to clicks."""
    pose = fit_pose(
        LENS, VIEW, points_body=plate.corners_body, corners_px=clicks,
        covariance=sd**2 * np.eye(8), prior=PRIOR,
    )  # fmt: skip
    return AnnotatedPose(LENS, VIEW, pose, PRIOR, plate.corners_body)


def refined(pixels: np.ndarray, clicks: np.ndarray, sd: float = 0.5, plate: TopPlate = PLATE):
    """Refine clicks."""
    return refine_corners(pixels, clicked(clicks, sd, plate), clicks, sd_px=sd)


def test_edges_bring_corners_and_heading_nearer_to_the_truth_than_clicks():
    rng, errors, squared, yaw = np.random.default_rng(1), [], [], []
    for _ in range(40):
        clicks = corners() + rng.normal(0, 0.5, (4, 2))
        found = refined(PICTURE, clicks)
        assert found.sides == 4
        off = (found.corners_px - corners()).ravel()
        errors.append(off)
        squared.append(off @ np.linalg.solve(found.covariance, off))
        pose = fit_pose(LENS, VIEW, points_body=PLATE.corners_body, corners_px=found.corners_px,
                        covariance=found.covariance, prior=PRIOR)  # fmt: skip
        yaw.append((pose.planar[2] - TRUE[5], clicked(clicks).pose.planar[2] - TRUE[5]))
    assert np.sqrt(np.mean(np.square(errors))) < 0.25
    by_edges, by_clicks = np.sqrt(np.mean(np.square(yaw), axis=0))
    assert by_edges < 0.25 * by_clicks
    # Plate and edges are perfect here: what is claimed for a real plate is more.
    assert 0.05 < np.mean(squared) / 8 < 1.0


def test_a_top_clicked_inside_its_edges_keeps_its_middle_and_heading():
    small = TopPlate(PLATE.length - 0.008, PLATE.width - 0.008, PLATE.height)
    clicks = corners(small) + np.random.default_rng(2).normal(0, 0.3, (4, 2))
    found = refined(PICTURE, clicks, plate=small)
    assert found.sides == 4
    pose = fit_pose(LENS, VIEW, points_body=small.corners_body, corners_px=found.corners_px,
                    covariance=found.covariance, prior=PRIOR)  # fmt: skip
    assert np.abs(pose.planar - TRUE[[0, 1, 5]]) == pytest.approx(0, abs=2e-3)


def test_edges_that_clicks_contradict_are_left_out_and_said():
    clicks = np.add(corners(), [2.5, 0.0])
    found = refined(PICTURE, clicks, sd=0.3)
    assert found.contradicts
    assert found.sides == 0
    np.testing.assert_array_equal(found.corners_px, clicks)
    np.testing.assert_array_equal(found.covariance, 0.09 * np.eye(8))


def test_a_side_with_two_edges_is_left_out():
    found = refined(drawn(stripe=0.008), corners())
    assert found.sides == 3
    assert np.abs(found.corners_px - corners()).max() < 0.3


@pytest.mark.parametrize("drawing", [{"covered": 0.55}, {"bulge": 0.012}])
def test_a_side_that_is_half_covered_or_no_line_is_left_out(drawing):
    assert refined(drawn(**drawing), corners()).sides == 3


def test_an_edge_beside_the_top_is_contradicted_by_the_others():
    picture = drawn(beside=0.009)  # 3 px outside the left edge, which is not seen
    for seed in range(2):
        clicks = corners() + np.random.default_rng(seed).normal(0, 0.3, (4, 2))
        found = refined(picture, clicks, sd=0.3)
        assert found.sides < 4
        off = (found.corners_px - corners()).ravel()
        assert off @ np.linalg.solve(found.covariance, off) < 30  # of 8 degrees of freedom


def test_the_border_of_the_picture_is_no_edge():
    yaw = float(np.arctan2(0.1, 0.7))
    level = corners(yaw=yaw)  # its right side runs along the rows
    lowest = round(level[:, 1].max()) + 3
    found = refined(np.ascontiguousarray(drawn(rim=GREY, yaw=yaw)[:lowest]), level)
    assert found.sides == 0
    np.testing.assert_array_equal(found.corners_px, level)


@pytest.mark.parametrize("rim", [GREY, tuple(np.subtract(GREY, 6))])
def test_without_edges_the_clicks_are_kept(rim):
    clicks = corners() + 0.2
    found = refined(drawn(rim=rim), clicks)
    assert found.sides == 0
    assert not found.contradicts
    np.testing.assert_array_equal(found.corners_px, clicks)


def test_a_top_of_a_few_pixels_keeps_its_clicks():
    tiny = TopPlate(0.018, 0.018, PLATE.height)
    picture = drawn(plate=tiny)
    assert np.ptp(corners(tiny), axis=0).max() < 15
    assert refined(picture, corners(tiny), plate=tiny).sides == 0
