# SPDX-License-Identifier: MIT
"""Straight lines through counted angles, against legs whose motion is known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.gait.lines import FASTEST, Samples, chosen, closest, knots, middle, passing, split

STEP = np.radians(3.6)
HALF = 0.5 * STEP * (1 + 1e-9)


def counted(angle, *, duration=4.0, rate=100.0):
    """Return first and last sample of each stay at a count, of a leg whose angle is given."""
    t = np.arange(0.0, duration, 1 / rate)
    count = STEP * np.round(angle(t) / STEP)
    changes = np.diff(count) != 0
    ends = np.append(True, changes) | np.append(changes, True)
    return Samples(t[ends], count[ends])


def lines_of(samples):
    """Return the first samples of the latest lines, of the earliest, and all that pass both."""
    latest = split(samples, HALF)
    reverse = Samples(-samples.t[::-1].copy(), samples.angle[::-1].copy())
    earliest = len(samples.t) - split(reverse, HALF)[::-1]
    begin, end = latest[:-1].copy(), earliest[1:].copy()
    return earliest, latest, passing(samples, begin, end, np.full(len(begin), HALF))


def walked(samples, lines=None, rest=0.0):
    earliest, latest, found = lines_of(samples)
    return knots(samples, earliest, latest, lines or middle(found), rest, HALF)


def test_the_closest_line_of_exact_angles_is_exact():
    t = np.linspace(0.0, 1.0, 9)
    speed, away = closest(Samples(t, 0.3 - 2.5 * t), 0, len(t))
    assert speed == pytest.approx(-2.5, abs=1e-9)
    assert away == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("at", [2.0, 2.0034, 2.0071])
def test_a_change_of_speed_is_found_where_it_happened(at):
    samples = counted(lambda t: np.where(t < at, 1.0 * t, at + 4.0 * (t - at)))
    t, theta = walked(samples)
    assert len(t) == 3
    assert t[1] == pytest.approx(at, abs=0.001)
    assert theta[1] == pytest.approx(at, abs=0.05 * STEP)


@given(at=st.floats(1.0, 3.0), before=st.floats(-4.0, 4.0), after=st.floats(-4.0, 4.0))
def test_a_corner_lies_between_the_samples_certain_of_its_lines(at, before, after):
    samples = counted(lambda t: before * np.minimum(t, at) + after * np.maximum(t - at, 0.0))
    earliest, latest, found = lines_of(samples)
    assert np.all(earliest <= latest)
    for lines in (middle(found), chosen(found, np.full((len(found.x), 2), 0.9))):
        t, _ = knots(samples, earliest, latest, lines, 0.0, HALF)
        if len(earliest) == 3:
            corner = t[1:-1]
            assert corner.min() >= samples.t[earliest[1] - 1] - 1e-12
            assert corner.max() <= samples.t[latest[1]] + 1e-12


@given(speed=st.floats(-8.0, 8.0), slower=st.floats(0, 1), lower=st.floats(0, 1))
def test_every_line_that_is_said_to_pass_does(speed, slower, lower):
    samples = counted(lambda t: 0.02 + speed * t)
    found = chosen(lines_of(samples)[2], np.array([[slower, lower]]))
    assert abs(found.speed[0]) <= FASTEST
    away = found.angle[0] + found.speed[0] * (samples.t - found.x[0]) - samples.angle
    assert np.abs(away).max() <= 1.001 * HALF


def test_evenly_distributed_places_choose_lines_that_differ_both_ways_from_the_mean():
    found = lines_of(counted(lambda t: 1.7 * t))[2]
    rng = np.random.default_rng(1)
    picked = [chosen(found, rng.uniform(size=(1, 2))) for _ in range(2000)]
    for name in ("angle", "speed"):
        values = np.array([getattr(each, name)[0] for each in picked])
        off = values.mean() - getattr(middle(found), name)[0]
        assert abs(off) < 4 * values.std() / np.sqrt(len(values))
        assert values.std() > 0


def test_a_leg_that_stands_at_first_has_no_speed_until_it_walks():
    samples = counted(lambda t: 0.5 + 2.0 * np.maximum(t - 1.5, 0.0))
    t, theta = walked(samples)
    assert np.ptp(np.interp([0.0, 0.7, 1.4], t, theta)) == 0
    assert np.interp(3.5, t, theta) == pytest.approx(4.5, abs=0.05 * STEP)
