# SPDX-License-Identifier: MIT
"""Pasted exposures are found and aligned by what is visible of them."""

import numpy as np
import pytest

from support.drawn_board import composite, likeness, steady_walk
from tracking.composite.pasted import Pasted, PastedReading

WALK = np.array([[-0.22, -0.06, 0.15], [-0.08, -0.03, 0.25], [0.06, 0.01, 0.35]])


@pytest.fixture(scope="module")
def reading() -> PastedReading:
    """Return a picture of three exposures, of which the last lies on top."""
    picture = likeness(composite(WALK), WALK[-1], reach=0.35)
    return PastedReading.of(picture, cells=30)


def test_all_are_found_from_the_top_down_and_none_is_made_up(reading):
    poses = reading.find()
    assert len(poses) == len(WALK)
    np.testing.assert_allclose(poses[:, :2], WALK[::-1, :2], atol=0.01)


def test_a_place_gains_where_an_exposure_is_and_only_what_is_visible_counts(reading):
    robot = reading.body.read(reading.picture, WALK[-1])
    shown = reading.used.astype(np.float32)
    beside = WALK[-1] + [0.0, 0.3, 0.0]
    gains, shares = reading.gains(np.array([WALK[-1], beside]), robot, shown, reading.body)
    assert gains[0] > 0.5 > 0.0 > gains[1]
    assert shares[0] == 1.0
    none, share = reading.gains(WALK[-1:], robot, 0 * shown, reading.body)
    assert none[0] == share[0] == 0.0


def test_an_exposure_much_nearer_than_the_others_are_is_none(reading):
    robot = reading.body.read(reading.picture, WALK[-1])
    places = [np.array([x, 0.0, 0.0]) for x in (0.0, 0.2, 0.4, 0.6, 0.65)]
    found = [
        Pasted(place, gain, robot) for place, gain in zip(places, (9, 5, 5, 5, 1), strict=True)
    ]
    kept = [each.pose[0] for each in reading.in_step(found)]
    assert kept == [0.0, 0.2, 0.4, 0.6]


def test_pasted_exposures_are_found_in_light_that_changes_and_cut_out_with_floor():
    walk = steady_walk((-0.3, -0.1, 0.1), 0.15, 0.08, 5)
    picture = likeness(
        composite(walk, lights=np.linspace(1.5, 1.0, 5), around_px=22),
        walk[-1],
        reach=0.45,
    )
    reading = PastedReading.of(picture)
    found = reading.align(reading.find())
    poses = np.array([each.alignment.pose.planar for each in found])[::-1]
    assert len(poses) == len(walk)
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 3e-3
