# SPDX-License-Identifier: MIT
"""Legs of a program: steady cycles are the scheduler's, and nothing lifts before all is down."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.events import scheduled_reference
from model.gait.notation import TETRAPOD, TRIPOD, parse_gait
from model.gait.program import ProgramLegs, cycle_gait
from model.gait.steering import highest_hip
from model.gait.swing import TURN

WAVE = parse_gait("{1} < {4} < {5} < {2} < {3} < {6}")


def gait(groups=TRIPOD, *, cycle=2.0, **changes):
    flight = cycle / max(len(groups.groups), 2)
    return cycle_gait(groups, ground_time=cycle - flight, flight_time=flight, **changes)


def program(*parts):
    """Return the legs of parts: a gait with a number of cycles, or a stand in seconds."""
    legs = ProgramLegs.beginning_with(next(part[0] for part in parts if isinstance(part, tuple)))
    for part in parts:
        if isinstance(part, tuple):
            for _ in range(part[1]):
                legs = legs.with_cycle(part[0])
        else:
            legs = legs.with_stand(part)
    return legs


GAITS = st.builds(
    gait, st.sampled_from([TRIPOD, TETRAPOD, WAVE]), cycle=st.sampled_from([1.5, 2.0, 3.0]),
    steering=st.sampled_from([-1.0, -0.4, 0.0, 0.5, 1.0]),
    direction=st.sampled_from(["left", "right"]), reverse=st.booleans(),
    turn_time=st.sampled_from([0.0, 0.1]), double_stance=st.sampled_from([0.0, 0.05]),
)  # fmt: skip
PARTS = st.lists(
    st.tuples(GAITS, st.integers(1, 3)) | st.sampled_from([0.5, 2.0]), min_size=1, max_size=5
).filter(lambda parts: any(isinstance(part, tuple) for part in parts))


@pytest.mark.parametrize("groups", [TRIPOD, TETRAPOD, WAVE])
def test_cycles_of_one_gait_are_the_schedulers_steady_state(groups):
    one = gait(groups)
    legs = program((one, 4))
    steady = scheduled_reference(one.system, one.touchdown, liftoff=one.liftoff)
    t = np.linspace(0.0, legs.end, 200)
    angles = legs.reference().angles(t)
    last = one.system.steady_state.touchdown[0].max()
    shift = last - one.system.steady_state.touchdown[0][one.system.gait.group_of == 0].min()
    expected = steady.angles(t + shift)
    np.testing.assert_allclose(angles - angles[0], expected - expected[0], atol=1e-6)
    assert legs.end == pytest.approx(4 * one.system.cycle_time)


@given(PARTS)
def test_no_leg_lifts_off_at_a_handover_before_all_are_down(parts):
    legs = program(*parts)
    for before, cycle in zip(legs.cycles, legs.cycles[1:], strict=False):
        assert np.all(cycle.liftoff > before.touchdown - 1e-9)
        if cycle.handed is None:
            continue
        at, _, pause = cycle.handed
        assert cycle.liftoff.min() >= at + pause - 1e-9


STOPS = st.none() | st.floats(0.02, 0.98)


def stopping(parts, stops):
    """Return the legs of parts, each of which is stopped after a share of its last cycle."""
    legs = ProgramLegs.beginning_with(next(part[0] for part in parts if isinstance(part, tuple)))
    for part, stop in zip(parts, stops, strict=False):
        before = legs.end
        if not isinstance(part, tuple):
            legs = legs.with_stand(part)
            continue
        for _ in range(part[1]):
            before, legs = legs.end, legs.with_cycle(part[0])
        if stop is not None:
            legs = legs.stopped_at(before + stop * (legs.end - before))
    return legs


@settings(max_examples=30)
@given(PARTS, st.lists(STOPS, min_size=5, max_size=5))
def test_angles_have_no_steps_and_legs_turn_no_faster_than_in_a_swing(parts, stops):
    legs = stopping(parts, stops)
    if legs.end == 0:
        return
    reference = legs.reference()
    assert reference.t[0] == 0.0
    assert reference.t[-1] == pytest.approx(legs.end)
    speeds = np.abs(np.diff(reference.theta, axis=0)) / np.diff(reference.t)[:, None]
    steady = [part[0].system.steady_state for part in parts if isinstance(part, tuple)]
    shortest = min((each.touchdown[0] - each.liftoff[0]).min() for each in steady)
    assert speeds.max() <= 2.5 * np.pi / shortest + 1e-6


def knots(reference, leg, begin, end):
    """Return the angles between which a leg turns steadily in a time, from 0 to below 360 deg."""
    within = reference.t[(reference.t > begin + 1e-6) & (reference.t < end - 1e-6)]
    theta = reference.angles(np.concatenate([[begin], within, [end]]))[:, leg]
    return theta - TURN * np.floor(theta[0] / TURN)


@settings(max_examples=25)
@given(PARTS, st.lists(STOPS, min_size=5, max_size=5))
def test_no_leg_goes_round_on_the_ground_or_stands_up_in_flight(parts, stops):
    legs = stopping(parts, stops)
    if legs.end == 0:
        return
    reference, slack = legs.reference(), np.radians(1.5)
    for leg, stands in enumerate(legs.stance_intervals()):
        for begin, end in stands:
            theta = knots(reference, leg, begin, end)
            assert theta.min() >= min(theta[0], np.radians(50.0)) - 1e-6
            assert theta.max() <= max(theta[0], np.radians(118.0)) + 1e-6
        for begin, end in zip(stands[:-1, 1], stands[1:, 0], strict=True):
            theta = knots(reference, leg, begin, end)
            tops = highest_hip(np.pi) + TURN * np.arange(-2, 4)
            for low, high in np.sort(np.stack([theta[:-1], theta[1:]], axis=1), axis=1):
                assert not np.any((low + slack < tops) & (tops < high - slack))


@pytest.mark.parametrize(("first", "then"), [(-1.0, 0.5), (1.0, -0.5)])
def test_every_leg_swings_clear_of_the_ground_after_a_change_of_steering(first, then):
    legs = program((gait(steering=first), 2), (gait(steering=then), 2))
    for cycle in legs.cycles[1:]:
        to_and_fro = np.abs(cycle.turned - cycle.lifted) + np.abs(cycle.landed - cycle.turned)
        straight = np.abs(cycle.landed - cycle.lifted)
        assert np.where(np.isnan(to_and_fro), straight, to_and_fro).min() >= np.pi / 2


@settings(max_examples=15)
@given(PARTS, GAITS, st.floats(0, 1))
def test_a_stopped_cycle_holds_its_legs_once_they_are_down(parts, last, share):
    legs = program(*parts)
    whole = legs.with_cycle(last)
    time = legs.end + share * (whole.end - legs.end)
    stopped = whole.stopped_at(time)
    assert time <= stopped.end <= whole.end
    reference, before = stopped.reference(), np.linspace(0.0, time, 40)
    cycle = whole.cycles[-1]
    flies = (cycle.liftoff < time - 1e-9) & (cycle.touchdown > time + 1e-9)
    np.testing.assert_allclose(
        reference.angles(before)[:, ~flies], whole.reference().angles(before)[:, ~flies], atol=1e-5
    )
    after = reference.angles([time, stopped.end])
    np.testing.assert_allclose(after[0][~flies], after[1][~flies], atol=1e-6)
    longer = stopped.with_stand(0.5).with_cycle(last)
    assert longer.cycles[-1].liftoff.min() >= stopped.end + 0.5 - 1e-9


def test_legs_stand_between_touchdown_and_liftoff_also_where_they_are_held_or_stopped():
    legs = program((gait(), 2), 1.5, (gait(steering=-1.0), 1))
    legs = legs.stopped_at(legs.end - 0.5)
    stands = legs.stance_intervals()
    np.testing.assert_allclose(stands[0], [[1.0, 2.0], [3.0, 5.5], [6.5, 7.5]], atol=1e-9)
    t = np.linspace(0.003, legs.end - 0.003, 700)
    down = [((t[:, None] > rows[:, 0]) & (t[:, None] < rows[:, 1])).any(axis=1) for rows in stands]
    assert np.sum(down, axis=0).min() == 3


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"touchdown": np.radians(91.0), "liftoff": 2.0}, "touchdown angle is 91.0 degrees"),
        ({"steering": 1.3}, "expected from -1"),
        ({"steering": np.nan}, "expected from -1"),
        ({"liftoff": 0.5}, "expected beyond touchdown"),
        ({"touchdown": 0.0, "liftoff": np.pi}, "by less than 180 degrees"),
        ({"cycle": 0.0}, "ground time"),
    ],
)
def test_an_impossible_gait_is_refused(changes, message):
    with pytest.raises(DomainError, match=message):
        gait(**changes)
