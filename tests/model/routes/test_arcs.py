# SPDX-License-Identifier: MIT
"""Arcs and straights lead to the place, and the heading, that they are asked to lead to."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from model.routes.arcs import (
    Arc,
    arc_and_straight_to,
    arc_straight_arc_to,
    arc_to,
    two_arcs_to,
)

coordinates = st.floats(-3, 3)
angles = st.floats(-np.pi, np.pi)
RADIUS = 0.15
few = settings(max_examples=40)


def end(arcs):
    """Return x, y, and cosine and sine of the heading at the end of arcs from the origin."""
    x = y = heading = 0.0
    for arc in arcs:
        chord = arc.length * np.sinc(arc.turn / (2 * np.pi))
        x += chord * np.cos(heading + arc.turn / 2)
        y += chord * np.sin(heading + arc.turn / 2)
        heading += arc.turn
    return np.array([x, y, np.cos(heading), np.sin(heading)])


@few
@given(coordinates, coordinates)
def test_one_arc_leads_to_a_place(x, y):
    assume(np.hypot(x, y) > 1e-3)
    arc = arc_to(x, y)
    assume(arc is not None and arc.length < 100)  # nearly straight behind
    np.testing.assert_allclose(end([arc])[:2], [x, y], atol=1e-6)


def test_no_arc_leads_straight_behind():
    assert arc_to(-1.0, 0.0) is None
    assert arc_to(1.0, 0.0) == Arc(1.0, 0.0)


@few
@given(coordinates, coordinates)
def test_an_arc_and_a_straight_lead_to_a_place_outside_the_circle(x, y):
    found = arc_and_straight_to(x, y, RADIUS)
    if np.hypot(x, abs(y) - RADIUS) <= RADIUS:
        assert found is None
        return
    assume(found is not None)
    np.testing.assert_allclose(end(found)[:2], [x, y], atol=1e-6)
    assert found[0].length == pytest.approx(RADIUS * abs(found[0].turn))


@few
@given(coordinates, coordinates, angles)
def test_two_arcs_lead_to_a_pose(x, y, heading):
    assume(np.hypot(x, y) > 1e-2)
    found = two_arcs_to(x, y, heading)
    assume(found is not None and sum(arc.length for arc in found) < 100)
    np.testing.assert_allclose(
        end(found), [x, y, np.cos(heading), np.sin(heading)], atol=1e-5
    )  # fmt: skip


@few
@given(coordinates, coordinates, angles)
def test_arc_straight_and_arc_lead_to_every_pose(x, y, heading):
    found = arc_straight_arc_to(x, y, heading, RADIUS)
    np.testing.assert_allclose(
        end(found), [x, y, np.cos(heading), np.sin(heading)], atol=1e-5
    )  # fmt: skip
    for arc in (found[0], found[2]):
        assert arc.length == pytest.approx(RADIUS * abs(arc.turn))


@few
@given(coordinates, st.floats(0.01, 3), angles)
def test_to_the_mirrored_pose_arcs_are_mirrored(x, y, heading):
    assume(abs(heading) < np.pi - 1e-3)
    left, right = arc_to(x, y), arc_to(x, -y)
    assert right == Arc(left.length, -left.turn)
    pairs = two_arcs_to(x, y, heading), two_arcs_to(x, -y, -heading)
    assume(None not in pairs)
    for one, other in zip(*pairs, strict=True):
        assume(abs(one.turn) < 2 * np.pi - 1e-3)
        assert other.turn == pytest.approx(-one.turn, abs=1e-6)
