# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.maxplus import EPSILON
from model.gait.notation import TETRAPOD, TRIPOD, parse_gait
from model.gait.scheduler import straight_system
from model.gait.turning import turning_system
from model.robot import LEFT, RIGHT

TIME = st.integers(1, 40).map(lambda n: n / 8)
MAYBE = st.integers(0, 16).map(lambda n: n / 8)
GAITS = st.sampled_from([TRIPOD, TETRAPOD, parse_gait("{1,2} < {3,4} < {5,6}")])
SIDES = st.sampled_from([LEFT, RIGHT])


def build(gait, inner, f, g, p, d):
    return turning_system(
        gait, inner=inner, ground_time=g, flight_time=f, turn_time=p, double_stance=d
    )


def strongly_connected(matrix):
    reach = np.isfinite(matrix) | np.eye(len(matrix), dtype=bool)
    for _ in range(6):
        reach = (reach.astype(int) @ reach.astype(int)) > 0
    return bool(reach.all())


def test_biped_turn_entry_by_entry():
    e, f, g, p, d = EPSILON, 0.5, 0.75, 0.25, 0.125
    system = build(parse_gait("{1} < {2}"), (0,), f, g, p, d)
    assert system.A0.tolist() == [[e, e, f, e], [e, e, e, f + p], [e, e, e, e], [d, e, e, e]]
    assert system.A1.tolist() == [[0, e, e, e], [e, 0, e, e], [g + p, d, 0, e], [e, g, e, 0]]


@given(GAITS, SIDES, TIME, TIME, MAYBE, MAYBE)
def test_period_is_that_of_the_leg_or_what_double_stance_needs(gait, inner, f, g, p, d):
    expected = max(f + g + p, len(gait.groups) * (f + p + d))
    assert build(gait, inner, f, g, p, d).cycle_time == pytest.approx(expected)


@given(GAITS, SIDES, TIME, TIME, MAYBE)
def test_straight_walk_is_a_turn_without_turn_time(gait, inner, f, g, d):
    turn = build(gait, inner, f, g, 0.0, d)
    straight = straight_system(gait, ground_time=g, flight_time=f, double_stance=d)
    assert turn.cycle_time == pytest.approx(straight.cycle_time)
    np.testing.assert_allclose(turn.events(6).touchdown, straight.events(6).touchdown)
    np.testing.assert_allclose(turn.events(6).liftoff, straight.events(6).liftoff)


@given(GAITS, SIDES, TIME, TIME, MAYBE, MAYBE)
def test_identity_blocks_connect_all_events_and_change_no_time(gait, inner, f, g, p, d):
    system = build(gait, inner, f, g, p, d)
    bare = system.A1.copy()
    np.fill_diagonal(bare, EPSILON)
    without = type(system)(system.A0, bare, gait)
    np.testing.assert_allclose(system.events(6).liftoff, without.events(6).liftoff)
    assert strongly_connected(system.matrix)
    assert not strongly_connected(without.matrix)


@given(SIDES, TIME, TIME, MAYBE, MAYBE)
def test_a_whole_tripod_stands_at_every_instant(inner, f, g, p, d):
    system = build(TRIPOD, inner, f, g, p, d)
    span = (10 * system.cycle_time, 12 * system.cycle_time)
    intervals = system.events(16).stance_intervals(span)
    for t in np.linspace(*span, 60):
        stands = [bool(np.any((leg[:, 0] <= t + 1e-9) & (t <= leg[:, 1] + 1e-9)))
                  for leg in intervals]  # fmt: skip
        assert all(stands[leg] for leg in (0, 3, 4)) or all(stands[leg] for leg in (1, 2, 5))


def test_inner_legs_that_the_gait_has_not_are_refused():
    with pytest.raises(DomainError, match="0 to 1"):
        build(parse_gait("{1} < {2}"), (0, 2), 1.0, 1.0, 0.1, 0.0)


def test_negative_turn_time_is_refused():
    with pytest.raises(DomainError, match=r"turn time is -0\.1 s"):
        build(TRIPOD, LEFT, 1.0, 1.0, -0.1, 0.0)
