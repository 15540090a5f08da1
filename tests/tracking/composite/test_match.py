# SPDX-License-Identifier: MIT
"""The robot's picture is turned and found where it is, best first."""

import numpy as np

from support.drawn_board import composite, known_at, likeness
from tracking.composite.match import TURNS, match_whole
from tracking.composite.pasted import PastedReading

PLANAR = np.array([0.05, 0.0, 2 * np.pi * 3 / TURNS])


def matches(pixels, least=0.5):
    picture = likeness(composite(PLANAR[None]), PLANAR, reach=0.3)
    template = picture.body_template()
    plane = PastedReading.of(picture, cells=22).plane
    return match_whole(plane.read_smooth(pixels), plane, template=template, least=least)


def test_the_best_match_is_where_the_robot_is():
    assert known_at(PLANAR).planar[2] == PLANAR[2]
    found = matches(composite(PLANAR[None], seed=1))
    assert found[0].score > 0.9
    np.testing.assert_allclose(found[0].planar[:2], PLANAR[:2], atol=0.01)
    assert abs(found[0].planar[2] - PLANAR[2]) < 1e-9
    assert [each.score for each in found] == sorted((m.score for m in found), reverse=True)


def test_an_empty_floor_has_no_match():
    empty = composite(np.array([[5.0, 5.0, 0.0]]))
    assert matches(empty, least=0.6) == []
