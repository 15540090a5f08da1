# SPDX-License-Identifier: MIT
"""The robot's body hides what is behind it, and no more."""

import numpy as np
import pytest

from support.drawn_board import LENS, PRIOR, SIZE, TOP, VIEW, level_plane
from tracking.camera import project
from tracking.composite.body_box import BodyBox

STATE = np.array([0.05, 0.02, PRIOR.height, 0.0, 0.0, 0.4])


@pytest.fixture
def box() -> BodyBox:
    """Return the drawn board's body."""
    return BodyBox(LENS, VIEW, SIZE, TOP, PRIOR.height)


def test_its_top_and_its_middle_are_hidden_and_the_far_floor_is_not(box):
    hidden = box.hidden(STATE, margin=0.0)
    assert hidden.shape == (400, 640)
    assert hidden[box.top_seen(STATE)].all()
    middle = project(LENS, VIEW, STATE[None, :3])[0].astype(int)
    assert hidden[middle[1], middle[0]]
    assert 0.01 < hidden.mean() < 0.15


def test_what_scissors_leave_makes_it_larger_on_all_sides(box):
    close, wide = (box.hidden(STATE, margin=margin) for margin in (0.0, 0.2))
    assert wide[close].all()
    assert wide.sum() > 1.3 * close.sum()


def test_on_a_plane_at_its_top_it_covers_its_own_outline(box):
    plane = level_plane()
    hidden = box.hidden_on(plane, STATE[[0, 1, 5]], margin=0.0)
    rows, columns = np.nonzero(hidden)
    places = np.array([plane.xy_at(*each) for each in zip(rows, columns, strict=True)])
    c, s = np.cos(STATE[5]), np.sin(STATE[5])
    ahead = (places - STATE[:2]) @ [c, s]
    # The near side hangs lower and hides what is nearer to the camera, not what is ahead.
    assert np.abs(ahead).max() < 0.75 * SIZE[0]
    assert len(places) * plane.cell**2 > 0.95 * SIZE[0] * SIZE[1]


def test_a_body_about_as_wide_as_long_is_square(box):
    assert box.is_square
    assert not BodyBox(LENS, VIEW, (0.3, 0.2), TOP, PRIOR.height).is_square
