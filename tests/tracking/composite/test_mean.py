# SPDX-License-Identifier: MIT
"""A mean of exposures is a sum of one robot's picture."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_board import SIZE, TOP, composite, found_in, level_plane
from tracking.composite.body_raster import BodyRaster
from tracking.composite.chain import steady_chain
from tracking.composite.mean import Fit, MeanSearch


def test_exposures_beyond_reach_of_each_other_are_found_in_a_mean():
    walk = np.array([[-0.4, -0.12, 0.2], [-0.05, -0.03, 0.3], [0.3, 0.08, 0.4]])
    poses = found_in(composite(walk, "mean"), walk[1], "mean")
    assert len(poses) == 3
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 3e-3


def test_a_robot_is_told_from_a_sum_of_itself():
    body, plane = BodyRaster.over(SIZE, 0.006, margin=4), level_plane()
    rng = np.random.default_rng(2)
    shape = (*plane.seen_px.shape[:2], 3)
    picture, used = rng.normal(100, 5, shape).astype(np.float32), np.ones(shape[:2], bool)
    reading = MeanSearch(plane, picture, used, body, SIZE[0], TOP)
    own = cv2.GaussianBlur(rng.normal(0, 60, (*body.x.shape, 3)).astype(np.float32), (0, 0), 2)
    poses = steady_chain(np.array([-0.25, 0.0, 0.0]), np.array([0.1, 0.0, 0.1]), 0.0, 4, 0)
    change = reading.sum_of(poses, own)
    seen = np.mean([body.read(change, plane, pose) for pose in poses], axis=0)
    solved = reading.robot_at(poses, change)
    assert np.corrcoef(solved.ravel(), own.ravel())[0, 1] > 0.97
    assert np.corrcoef(seen.ravel(), own.ravel())[0, 1] < 0.9  # what many others would take


def test_of_a_mean_what_is_weaker_or_less_like_the_robot_than_is_usual_is_dropped():
    body, plane = BodyRaster.over(SIZE, 0.006, margin=4), level_plane()
    picture = np.zeros((*plane.seen_px.shape[:2], 3), np.float32)
    reading = MeanSearch(plane, picture, np.ones(picture.shape[:2], bool), body, SIZE[0], TOP)
    poses = steady_chain(np.array([-0.4, 0.0, 0.0]), np.array([0.1, 0.0, 0.0]), 0.0, 6, 0)
    scores = np.array([0.1, 0.9, 0.9, 0.65, 0.9, 0.9, 0.7])
    strengths = np.array([0.1, 1.0, 1.0, 1.0, 0.4, 1.0, 1.0])
    held = reading.held(Fit(poses, picture, scores, strengths, 0.0, 0.0))
    np.testing.assert_array_equal(held, poses[[0, 1, 2, 5, 6]])
    faint = np.full(len(poses), 0.55)
    assert len(reading.held(Fit(poses, picture, faint, np.ones(len(poses)), 0.0, 0.0))) == 7
    assert len(reading.held(Fit(poses, picture, 0.9 * faint, strengths, 0.0, 0.0))) == 1


@given(count=st.integers(2, 20), own=st.floats(0.01, 0.2), grown=st.floats(0.6, 1.6))
def test_one_exposure_more_must_explain_its_cost_whatever_else_it_changes(count, own, grown):
    fewer = explaining(0.5, count, own)
    cost = 0.5 * (own + grown * own)
    more = explaining(0.5 + 1.01 * cost, count + 1, grown * own)
    assert more.gain(fewer) > 0
    assert fewer.gain(more) == pytest.approx(-more.gain(fewer))
    assert explaining(0.5 + 0.99 * cost, count + 1, grown * own).gain(fewer) < 0
    assert explaining(0.6, count, grown * own).gain(fewer) == pytest.approx(0.1)


def explaining(share, count, cost):
    """Return a set of exposures that explains a share of a picture."""
    return Fit(
        np.zeros((count, 3)), np.zeros((1, 1, 3)), np.ones(count), np.ones(count), share, cost
    )
