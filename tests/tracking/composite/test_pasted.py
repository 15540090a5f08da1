# SPDX-License-Identifier: MIT
"""Pasted exposures are found under each other by how the one on top looks."""

import numpy as np
import pytest

from support.drawn_board import SIZE, composite, likeness
from tracking.composite.pasted import Pasted, PastedSearch

WALK = np.array([[-0.22, -0.06, 0.15], [-0.08, -0.03, 0.25], [0.06, 0.01, 0.35]])


@pytest.fixture(scope="module")
def search() -> PastedSearch:
    """Return a picture of three exposures, of which the last lies on top."""
    picture = likeness(composite(WALK, "pasted"), WALK[-1], reach=0.35)
    return PastedSearch(*picture.raster(SIZE[0] / 30), picture.box, False)


def test_all_are_found_from_the_top_down_and_none_is_made_up(search):
    poses, gain = search.find(WALK[-1])
    assert len(poses) == len(WALK)
    np.testing.assert_allclose(poses[:, :2], WALK[::-1, :2], atol=0.01)
    assert gain > 1.0


def test_a_place_gains_where_an_exposure_is_and_only_what_is_visible_counts(search):
    robot = search.body.read(search.picture, search.plane, WALK[-1])
    shown = search.used.astype(np.float32)
    beside = WALK[-1] + [0.0, 0.3, 0.0]
    gains, shares = search.gains(np.array([WALK[-1], beside]), robot, shown, search.body)
    assert gains[0] > 0.5 > 0.0 > gains[1]
    assert shares[0] == 1.0
    none, share = search.gains(WALK[-1:], robot, 0 * shown, search.body)
    assert none[0] == share[0] == 0.0


def test_an_exposure_much_nearer_than_the_others_are_is_none(search):
    robot = search.body.read(search.picture, search.plane, WALK[-1])
    places = [np.array([x, 0.0, 0.0]) for x in (0.0, 0.2, 0.4, 0.6, 0.65)]
    found = [
        Pasted(place, gain, robot) for place, gain in zip(places, (9, 5, 5, 5, 1), strict=True)
    ]
    kept = [each.pose[0] for each in search.in_step(found)]
    assert kept == [0.0, 0.2, 0.4, 0.6]
