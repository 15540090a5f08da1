# SPDX-License-Identifier: MIT
"""Straight lines through counted angles, against legs whose motion is known."""

import numpy as np
import pytest

from model.gait.lines import Changes, Log, fitted, knots, rests, split

STEP = np.radians(3.6)
HALF = 0.5 * STEP * (1 + 1e-9)


def counted(angle, *, duration=4.0, rate=100.0):
    """Return the changes of count of a leg whose angle over time is given, and its log's ends."""
    t = np.arange(0.0, duration, 1 / rate)
    count = STEP * np.round(angle(t) / STEP)
    at = np.flatnonzero(np.diff(count))
    changes = Changes(t[at], t[at + 1], count[at], count[at + 1])
    return changes, Log(t[0], count[0], t[-1], count[-1], HALF)


def middles(changes):
    return np.full(len(changes.early), 0.5)


def test_constant_speed_is_one_line_of_that_speed():
    changes, _ = counted(lambda t: 1.7 * t)
    first = split(changes, HALF)
    assert first.tolist() == [0, len(changes.early)]
    lines = fitted(changes, first, middles(changes))
    assert lines.speed[0] == pytest.approx(1.7, rel=2e-3)


def test_a_change_of_speed_is_found_where_it_happened():
    changes, log = counted(lambda t: np.where(t < 2.0, 1.0 * t, 2.0 + 4.0 * (t - 2.0)))
    first = split(changes, HALF)
    assert len(first) == 3
    lines = fitted(changes, first, middles(changes))
    np.testing.assert_allclose(lines.speed, [1.0, 4.0], rtol=0.01)
    rested = rests(lines, changes, first)
    assert not rested.any()
    t, theta = knots(lines, changes, first, rested, 0.0, log)
    assert np.abs(t - 2.0).min() < 0.03
    np.testing.assert_allclose(np.interp([1.0, 3.0], t, theta), [1.0, 6.0], atol=STEP)


def test_a_pause_is_a_plateau_between_two_lines():
    changes, log = counted(lambda t: np.where(t < 1.5, t, np.maximum(1.5, t - 1.0)))
    first = split(changes, HALF)
    lines = fitted(changes, first, middles(changes))
    rested = rests(lines, changes, first)
    assert rested.tolist() == [True]
    t, theta = knots(lines, changes, first, rested, 0.0, log)
    np.testing.assert_allclose(np.interp([1.8, 2.2], t, theta), 1.5, atol=STEP)
