# SPDX-License-Identifier: MIT
"""A mean of exposures is a sum of one robot's picture."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_board import composite, found_in, likeness
from tracking.composite.mean import Fit, MeanReading
from tracking.composite.steps import steady_chain


def test_exposures_beyond_reach_of_each_other_are_found_in_a_mean():
    walk = np.array([[-0.4, -0.12, 0.2], [-0.05, -0.03, 0.3], [0.3, 0.08, 0.4]])
    poses = found_in(composite(walk, "mean"), walk[1], "mean")
    assert len(poses) == 3
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 3e-3


def test_of_a_mean_what_is_weaker_or_less_like_the_robot_than_is_usual_is_dropped():
    picture = np.zeros((400, 640, 3), np.uint8)
    reading = MeanReading.of(likeness(picture, np.zeros(3), reach=0.3))
    poses = steady_chain(np.array([-0.4, 0.0, 0.0]), np.array([0.1, 0.0, 0.0]), 0.0, 6, 0)
    scores = np.array([0.1, 0.9, 0.9, 0.65, 0.9, 0.9, 0.7])
    strengths = np.array([0.1, 1.0, 1.0, 1.0, 0.4, 1.0, 1.0])
    kept = reading.accepted(Fit(poses, picture, scores, strengths, 0.0, 0.0))
    np.testing.assert_array_equal(kept, poses[[0, 1, 2, 5, 6]])
    faint = np.full(len(poses), 0.55)
    assert len(reading.accepted(Fit(poses, picture, faint, np.ones(len(poses)), 0.0, 0.0))) == 7
    assert len(reading.accepted(Fit(poses, picture, 0.9 * faint, strengths, 0.0, 0.0))) == 1


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
