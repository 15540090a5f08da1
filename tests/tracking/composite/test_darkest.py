# SPDX-License-Identifier: MIT
"""In a picture of darkest values a chain of exposures makes it likelier, point by point."""

import numpy as np
import pytest

from support.drawn_board import composite, likeness
from tracking.composite.darkest import Chain, DarkestReading
from tracking.composite.steps import steady_chain

WALK = steady_chain(np.array([-0.15, -0.05, 0.15]), np.array([0.14, 0.0, 0.1]), 0.0, 2, 0)
APART = np.array([[-0.2, -0.05, 0.2], [0.1, 0.03, 0.35]])


@pytest.fixture(scope="module")
def reading() -> DarkestReading:
    """Return a picture of the darkest values of three exposures, the first one known."""
    picture = likeness(composite(WALK, "darkest"), WALK[0], reach=0.3)
    return DarkestReading.of(picture, cells=24)


def test_true_exposures_make_the_picture_likelier_and_others_do_not(reading):
    assert reading.worth(WALK) > reading.worth(WALK[:2]) > reading.worth(WALK[:1])
    one_more = np.concatenate((WALK, [[-0.1, 0.2, 0.1]]))
    assert reading.worth(one_more) < reading.worth(WALK)
    assert reading.worth(np.concatenate((WALK, WALK[-1:] + 1e-3))) == -np.inf


def test_exposures_are_followed_by_their_last_step_to_the_end_of_the_walk(reading):
    found = np.array(reading.followed([WALK[0], WALK[1]]))
    assert len(found) == len(WALK)
    np.testing.assert_allclose(found[:, :2], WALK[:, :2], atol=0.012)


def test_a_chain_is_fitted_to_the_walk(reading):
    step = np.array([0.13, 0.005, 0.08, 0.0])
    fitted = reading.fitted(WALK[0], Chain(step, 2, 0))
    np.testing.assert_allclose(fitted.poses(WALK[0])[:, :2], WALK[:, :2], atol=0.012)


def test_a_chain_with_some_between_holds_the_chain():
    chain = Chain(np.array([0.2, 0.0, 0.1, 0.0]), 2, 1)
    some = chain.with_some_between.poses(WALK[0])
    assert len(some) == 7
    for pose in chain.poses(WALK[0]):
        assert np.hypot(*(some - pose)[:, :2].T).min() < 3e-3


def test_places_on_a_raster_are_aligned_and_what_is_none_is_dropped():
    picture = likeness(composite(APART, "darkest"), APART[0], reach=0.35)
    near = np.array([APART[0], APART[1] + [0.004, -0.003, 0.02], [0.1, -0.25, 0.3]])
    found = DarkestReading.of(picture).align(near)
    poses = np.array([each.alignment.pose.planar for each in found])
    assert len(poses) == 2
    np.testing.assert_allclose(poses[:, :2], APART[:, :2], atol=1.5e-3)
    np.testing.assert_allclose(poses[:, 2], APART[:, 2], atol=0.02)
    assert [each.visible for each in found] == pytest.approx([0.9, 0.9], abs=0.1)
