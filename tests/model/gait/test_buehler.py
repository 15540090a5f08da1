# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.buehler import buehler_clock, buehler_reference, centred_time

STANCE = st.floats(0.2, 2.8)
SHARE = st.floats(0.1, 0.9)
TIME = st.floats(-20.0, 20.0)


@given(TIME, st.floats(0.1, 5.0))
def test_centred_time_differs_by_whole_cycles_and_lies_around_mid_stance(t, cycle):
    centred = centred_time(t, cycle)
    assert -cycle / 2 <= centred <= cycle / 2
    cycles = (t - centred) / cycle
    assert cycles == pytest.approx(round(cycles), abs=1e-9)


@given(STANCE, SHARE, st.sampled_from([np.pi, 2 * np.pi]))
def test_clock_is_continuous_within_a_cycle_and_closes_on_its_turn(stance, share, turn):
    t = np.linspace(-0.5, 0.5, 2001)[:-1]
    theta = buehler_clock(t, stance, ground_time=share, cycle_time=1.0, turn=turn)
    steepest = max(stance / share, (turn - stance) / (1 - share))
    assert np.abs(np.diff(theta)).max() <= steepest / 2000 * (1 + 1e-6)
    assert theta[0] == pytest.approx(-turn / 2)
    assert theta[-1] == pytest.approx(turn / 2, abs=steepest / 1999)


@given(st.floats(-0.49, 0.49), STANCE, SHARE)
def test_clock_is_odd_about_mid_stance(t, stance, share):
    one, other = buehler_clock([t, -t], stance, ground_time=share, cycle_time=1.0)
    assert one == pytest.approx(-other, abs=1e-12)


@given(TIME, STANCE, SHARE)
def test_reference_is_the_clock_around_mid_stance_for_both_tripods(t, stance, share):
    mid = 1.4
    legs = buehler_reference(
        mid - stance / 2, mid + stance / 2, ground_time=2 * share, cycle_time=2.0
    )
    expected = buehler_clock([t, t + 1.0], stance, ground_time=2 * share, cycle_time=2.0) + mid
    turned = (legs.angles(t)[0] - expected[[0, 1, 1, 0, 0, 1]]) / (2 * np.pi)
    np.testing.assert_allclose(turned, np.round(turned), atol=1e-8)


def test_reference_starts_in_mid_stance_of_the_left_tripod():
    legs = buehler_reference(0.8, 2.2, ground_time=0.3, cycle_time=1.0)
    np.testing.assert_allclose(legs.angles(0.0)[0, [0, 3, 4]], 1.5)


@pytest.mark.parametrize(("stance", "ground"), [(0.0, 0.5), (7.0, 0.5), (1.0, 0.0), (1.0, 1.0)])
def test_stance_that_does_not_fit_into_the_cycle_is_refused(stance, ground):
    with pytest.raises(DomainError, match=r"stance angle|ground time"):
        buehler_clock(0.0, stance, ground_time=ground, cycle_time=1.0)
