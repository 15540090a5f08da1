# SPDX-License-Identifier: MIT
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.cyclic import CyclicReference

SHARE = st.floats(0.05, 0.95)


@st.composite
def references(draw):
    """Draw six legs of one period with any angles, shares, phases, pauses and offsets."""

    def six(values):
        return np.array([draw(values) for _ in range(6)])

    period = draw(st.floats(0.2, 5.0))
    down = six(st.floats(-1.0, 1.5))
    ground = period * six(SHARE)
    return CyclicReference(
        touchdown=down,
        liftoff=down + six(st.floats(0.1, 4.0)),
        ground_time=ground,
        flight_time=period - ground,
        phase=six(st.floats(0.0, 1.0)),
        pause=(period - ground) * six(st.floats(0.0, 0.9)),
        offset=six(st.floats(-0.2, 0.2)),
    )


def simple(**changes):
    """Make a leg with stance from 1 to 2 rad in the first second of three."""
    one = {"touchdown": 1.0, "liftoff": 2.0, "ground_time": 1.0, "flight_time": 2.0}
    values = {**one, "phase": np.zeros(6), **changes}
    arrays: dict[str, Any] = {name: np.asarray(value) for name, value in values.items()}
    return CyclicReference(**arrays)


@given(references(), st.floats(-10.0, 10.0))
def test_every_leg_grows_by_a_turn_a_period(legs, t):
    grown = legs.angles(t + legs.period) - legs.angles(t)
    np.testing.assert_allclose(grown, 2 * np.pi, atol=1e-8)


@given(references())
def test_angles_are_continuous_and_never_fall(legs):
    t = np.linspace(-1.0, 3.0, 4001) * legs.period
    steps = np.diff(legs.angles(t), axis=0)
    fastest = np.maximum(legs.ground_speed, legs.flight_speed)
    assert np.all(steps >= -1e-9)
    assert np.all(steps <= fastest * legs.period / 1000 * (1 + 1e-6) + 1e-9)


@given(references())
def test_speeds_are_the_slopes_of_the_angles(legs):
    t = np.linspace(-1.0, 2.0, 3001) * legs.period + 1e-4 * legs.period
    dt = legs.period * 1e-7
    slopes = (legs.angles(t + dt) - legs.angles(t)) / dt
    smooth = legs.speeds(t) == legs.speeds(t + dt)
    assert smooth.mean() > 0.99
    np.testing.assert_allclose(slopes[smooth], legs.speeds(t)[smooth], rtol=1e-4, atol=1e-4)


@given(references())
def test_leg_is_at_touchdown_and_liftoff_when_its_stance_begins_and_ends(legs):
    span = (0.0, 4 * legs.period)
    for leg, stands in enumerate(legs.stance_intervals(span)):
        inside = stands[(stands[:, 0] > span[0]) & (stands[:, 1] < span[1])]
        assert len(inside) >= 3
        at = [legs.angles(column)[:, leg] - legs.offset[leg] for column in inside.T]
        turned = np.array(at) / (2 * np.pi)
        expected = np.array([legs.touchdown[leg], legs.liftoff[leg]]) / (2 * np.pi)
        off = (turned - expected[:, None] + 0.5) % 1 - 0.5
        np.testing.assert_allclose(off, 0.0, atol=1e-8)


def test_speed_at_a_kink_is_that_from_the_right():
    legs = simple(pause=0.5)
    t = 3.0 * np.arange(1000)
    assert np.all(legs.speeds(t) == 1.0)
    assert np.all(legs.speeds(t + 1.0) == 0.0)
    np.testing.assert_allclose(legs.speeds(t + 1.5), (2 * np.pi - 1) / 1.5)


def test_start_is_exactly_at_touchdown_and_liftoff():
    legs = simple(liftoff=2.3, phase=np.array([0.0, 1 / 3, 0.0, 1 / 3, 0.0, 1 / 3]))
    assert legs.angles(0.0)[0].tolist() == [1.0, 2.3] * 3


@given(references(), st.floats(-5.0, 5.0))
def test_mirror_image_exchanges_left_and_right_and_undoes_itself(legs, t):
    image = legs.mirrored()
    swapped = image.angles(t)[:, [1, 0, 3, 2, 5, 4]]
    np.testing.assert_allclose(swapped, legs.angles(t), rtol=1e-14, atol=1e-14)
    np.testing.assert_allclose(image.mirrored().angles(t), legs.angles(t), rtol=1e-14, atol=1e-14)


def test_two_legs_have_no_mirror_image():
    with pytest.raises(DomainError, match="2 legs"):
        simple(phase=np.zeros(2)).mirrored()


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"liftoff": 0.5}, "leg 1 touches down at 57.2958 and lifts off at 28.6479 degrees"),
        ({"liftoff": 1.0 + 2 * np.pi}, "by less than 360"),
        ({"ground_time": 0.0}, "leg 1 spends 0 s on the ground"),
        ({"flight_time": [2.0, 2.0, 2.0, 1.9, 2.0, 2.0]}, "leg 4 has a period of 2.9 s"),
        ({"pause": 2.0}, "leg 1 pauses for 2 s of its 2 s in flight"),
        ({"pause": -0.1}, "pauses for -0.1 s"),
        ({"touchdown": np.nan}, "touchdown is"),
        ({"phase": np.zeros(5), "touchdown": np.ones(6)}, "shapes do not match"),
    ],
)  # fmt: skip
def test_legs_that_cannot_walk_are_refused(changes, fault):
    with pytest.raises(DomainError) as caught:
        simple(**changes)
    assert fault in str(caught.value)
