# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.maxplus import EPSILON, otimes, solve_implicit
from model.gait.notation import TETRAPOD, TRIPOD, parse_gait
from model.gait.scheduler import straight_system

TIME = st.integers(1, 40).map(lambda n: n / 8)  # exact in binary
GAITS = st.sampled_from(
    [
        TRIPOD,
        TETRAPOD,
        parse_gait("{1} < {2}"),
        parse_gait("{1,2,3,4,5,6}"),
        parse_gait("{1} < {6} < {3} < {2} < {5} < {4}"),
        parse_gait("{1,4} < {2,3} < {5,8} < {6,7}"),
    ]
)


def test_biped_is_eq_2_12_entry_by_entry():
    e, f, g, d = EPSILON, 0.5, 0.75, 0.125
    system = straight_system(parse_gait("{1} < {2}"), ground_time=g, flight_time=f, double_stance=d)
    assert system.A0.tolist() == [[e, e, f, e], [e, e, e, f], [e, e, e, e], [d, e, e, e]]
    # Eq. (2-12) prints tau_Delta in the last row too; Eq. (2-11) and Q have nothing there.
    assert system.A1.tolist() == [[e, e, e, e], [e, e, e, e], [g, d, e, e], [e, g, e, e]]


@given(TIME, TIME, TIME)
def test_the_entry_that_eq_2_12_prints_too_many_changes_nothing(f, g, d):
    system = straight_system(parse_gait("{1} < {2}"), ground_time=g, flight_time=f, double_stance=d)
    printed = system.A1.copy()
    printed[3, 0] = d
    explicit = solve_implicit(system.A0, printed)
    x = system.events(3)
    y = np.zeros(4)
    for k in range(1, 4):
        y = otimes(explicit, y)
        np.testing.assert_array_equal(y, [*x.touchdown[k], *x.liftoff[k]])


@given(GAITS, TIME, TIME, TIME)
def test_cycle_time_is_that_of_the_leg_or_of_the_groups(gait, f, g, d):
    system = straight_system(gait, ground_time=g, flight_time=f, double_stance=d)
    assert system.cycle_time == pytest.approx(max(g + f, len(gait.groups) * (f + d)))


@given(GAITS, TIME, TIME, TIME)
def test_schedule_settles_on_its_steady_state(gait, f, g, d):
    system = straight_system(gait, ground_time=g, flight_time=f, double_stance=d)
    events = system.events(8)
    np.testing.assert_allclose(np.diff(events.touchdown[4:], axis=0), system.cycle_time)
    late = events.touchdown[-1] - system.steady_state.touchdown[0]
    np.testing.assert_allclose(late, late[0], atol=1e-9)


@given(GAITS, TIME, TIME, TIME, st.integers(0, 2**32 - 1))
def test_constraints_hold_from_any_start(gait, f, g, d, seed):
    system = straight_system(gait, ground_time=g, flight_time=f, double_stance=d)
    start = np.random.default_rng(seed).uniform(0.0, 5.0, 2 * gait.n_legs)
    events = system.events(6, start=start)
    t, lift = events.touchdown, events.liftoff
    np.testing.assert_allclose(t[1:], lift[1:] + f)
    assert np.all(lift[1:] >= t[:-1] + g - 1e-12)
    group = gait.group_of
    for leg in range(gait.n_legs):
        cycle_before = group[leg] == 0
        waits_for = group == (group[leg] - 1) % len(gait.groups)
        touched = (t[:-1] if cycle_before else t[1:])[:, waits_for].max(axis=1)
        assert np.all(lift[1:, leg] >= touched + d - 1e-12)


@pytest.mark.parametrize(
    ("name", "value"),
    [("ground_time", 0.0), ("flight_time", -1.0), ("double_stance", -0.1), ("flight_time", np.nan)],
)
def test_impossible_times_are_refused(name, value):
    times = {"ground_time": 1.0, "flight_time": 1.0, "double_stance": 0.0, name: value}
    with pytest.raises(DomainError, match=f"{name.replace('_', ' ')} is {value:g} s"):
        straight_system(TRIPOD, **times)


def test_start_without_two_events_a_leg_is_refused():
    system = straight_system(TRIPOD, ground_time=1.0, flight_time=1.0)
    with pytest.raises(DomainError, match=r"expected \(12,\)"):
        system.events(2, start=np.zeros(6))
