# SPDX-License-Identifier: MIT
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.notation import TETRAPOD
from model.gait.scheduler import straight_system
from model.gait.tetrapod import tetrapod_reference

FILE = Path(__file__).parents[3] / "datasets" / "thesis" / "tables.toml"
SIMULATED = tomllib.loads(FILE.read_text(encoding="utf-8"))["tetrapod_simulated"]
DOWN, UP = SIMULATED["simulated"]["touchdown"], SIMULATED["simulated"]["liftoff"]
SYMMETRIC = st.floats(0.1, 1.4)


def test_times_are_those_of_the_source():
    legs = tetrapod_reference(DOWN, UP, cycle_time=3.0)
    np.testing.assert_allclose(legs.ground_time, SIMULATED["ground_time"])
    np.testing.assert_allclose(legs.flight_time, SIMULATED["flight_time"])


@given(st.floats(0.1, 1.5), st.floats(1.6, 2.9), st.floats(0.5, 5.0))
def test_start_is_eq_5_5_to_5_7_and_eq_5_10_to_5_12(down, up, cycle):
    legs = tetrapod_reference(down, up, cycle_time=cycle)
    middle = np.pi / 2
    np.testing.assert_allclose(legs.angles(0.0)[0], [up, middle, down, up, middle, down])
    ground, flight = legs.ground_speed[0], legs.flight_speed[0]
    np.testing.assert_allclose(
        legs.speeds(0.0)[0], [flight, ground, ground, flight, ground, ground]
    )


@given(SYMMETRIC, st.floats(0.5, 5.0))
def test_each_pair_touches_down_as_the_next_lifts_off(half, cycle):
    legs = tetrapod_reference(np.pi / 2 - half, np.pi / 2 + half, cycle_time=cycle)
    check_rhythm(legs, cycle)


def check_rhythm(legs, cycle):
    stands = legs.stance_intervals((0.0, 4 * cycle))
    for flown, lifting in ((0, 1), (1, 2), (2, 0)):
        downs = stands[flown][stands[flown][:, 0] > 1e-9, 0]
        ups = stands[lifting][:, 1]
        assert all(np.abs(ups - t).min() < 1e-9 * cycle for t in downs if t < 3.9 * cycle)


def test_angles_of_the_robot_keep_the_rhythm_only_from_the_middle_of_their_stance():
    down, up = np.radians([38.0, 117.0])
    check_rhythm(tetrapod_reference(down, up, cycle_time=3.0, middle_start=None), 3.0)
    with pytest.raises(AssertionError):
        check_rhythm(tetrapod_reference(down, up, cycle_time=3.0), 3.0)


@given(SYMMETRIC)
def test_max_plus_schedules_the_same_gait(half):
    legs = tetrapod_reference(np.pi / 2 - half, np.pi / 2 + half, cycle_time=3.0)
    system = straight_system(TETRAPOD, ground_time=2.0, flight_time=1.0)
    assert system.cycle_time == pytest.approx(legs.period)
    down = system.steady_state.touchdown[0]
    late = (down[0] - down) / 3.0 + 2 / 3  # legs 1 and 4 start at lift-off
    np.testing.assert_allclose((late - legs.phase + 0.5) % 1.0, 0.5, atol=1e-9)


def test_start_outside_the_stance_is_refused():
    with pytest.raises(DomainError, match="legs 2 and 5 start at 90 degrees"):
        tetrapod_reference(np.radians(95.0), np.radians(130.0), cycle_time=3.0)
