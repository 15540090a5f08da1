# SPDX-License-Identifier: MIT
"""A template is aligned with a photograph to a fraction of a pixel, and with its error."""

import numpy as np
import pytest

from support.drawn_plate import LENS, PLATE, PRIOR, VIEW, annotated, picture_of
from tracking.body import align, make_template

PLANAR = np.array([0.1, 0.05, 0.8])


@pytest.fixture(scope="module")
def template():
    """Cut the plate's picture out of a photograph."""
    pixels = picture_of((0.0, 0.0, 0.4), np.random.default_rng(0))
    return make_template(pixels, LENS, VIEW, pose=annotated((0.0, 0.0, 0.4)), plate=PLATE)


def aligned(template, start, **other):
    pixels = picture_of(PLANAR, np.random.default_rng(1))
    return align(pixels, LENS, VIEW, template=template, prior=PRIOR, start=start, **other)


def test_a_start_that_is_off_ends_where_the_robot_is(template):
    found = aligned(template, np.add(PLANAR, [0.01, -0.008, 0.05]))
    assert found is not None
    assert found.score > 0.9
    np.testing.assert_allclose(found.pose.planar, PLANAR, atol=3e-3)
    sd = np.sqrt(np.diag(found.pose.planar_covariance))
    assert (sd > 1e-6).all()
    assert (sd < 5e-3).all()


def test_a_place_without_the_robot_aligns_with_little_or_nothing(template):
    found = aligned(template, np.array([-0.35, 0.4, 0.0]))
    assert found is None or found.score < 0.6


def test_where_nothing_is_visible_nothing_is_aligned(template):
    hidden = np.zeros((480, 640), dtype=bool)
    assert aligned(template, PLANAR, visible=hidden) is None
