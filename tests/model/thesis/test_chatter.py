# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.gait.steering import tripod_angles, tripod_reference
from model.robot import GRAVITY, Robot
from model.thesis.legs import SwitchedLegs
from model.thesis.traction import paired_sum
from model.thesis.walk import ThesisOptions, walk_thesis
from support.chatter import largest_stable_step, sign_changes_per_second

STIFFNESS = 34.34 * 1.564 * 0.3798 * GRAVITY
LEGS = SwitchedLegs.of(tripod_reference(tripod_angles(np.radians(50.0), 1.1), 2.0))


def path(dt, duration=4.0):
    return walk_thesis(Robot(), LEGS, duration=duration, options=ThesisOptions(dt=dt))


def chatter(dt):
    return sign_changes_per_second(path(dt))


def test_at_a_millisecond_slip_changes_sign_at_nearly_every_step():
    assert chatter(0.001) > 900


def test_below_the_stable_step_the_chatter_is_gone():
    assert chatter(0.0001) < 10
    assert chatter(0.0002) < 10


def test_chatter_starts_where_the_linearised_step_turns_unstable():
    """Front and rear legs add a rotation mode that is stiffer still, so it is gone a bit below."""
    stable = largest_stable_step(0.083, STIFFNESS)
    assert stable == pytest.approx(0.083 / 100, rel=0.01)
    assert chatter(1.1 * stable) > 500
    assert chatter(0.4 * stable) < 20


def test_the_linearised_step_alternates_beyond_the_limit_and_decays_below():
    v_r, speed = 0.1, 0.1
    for factor, grows in ((1.05, True), (0.95, False)):
        dt, v = factor * largest_stable_step(speed, STIFFNESS), v_r * (1 + 1e-6)
        for _ in range(200):
            v += dt * STIFFNESS / speed * (v_r - v)
        assert (abs(v - v_r) > v_r * 1e-6) == grows


def test_the_chatter_hardly_moves_the_path():
    coarse, fine = path(0.001), path(0.0001)
    assert np.linalg.norm(coarse.position[-1] - fine.position[-1]) < 0.003


def test_pairing_cancels_a_force_that_alternates():
    force = np.where(np.arange(1001) % 2, 3.0, -3.0) + 0.1
    np.testing.assert_allclose(paired_sum(force), 0.2)


@given(st.integers(3, 40))
def test_pairs_are_those_of_the_listing(n):
    force = np.arange(n, dtype=float)[:, None] * np.ones(2)
    evens, odds = force[1::2], force[2::2]  # 2, 4, ... and 3, 5, ... counted from 1
    pairs = min(len(evens), len(odds))
    np.testing.assert_array_equal(paired_sum(force), evens[:pairs] + odds[:pairs])


def test_the_net_force_of_the_chattering_walk_is_a_fraction_of_what_it_swings():
    coarse = path(0.001, duration=1.0)
    standing = coarse.traction_force[100:800, 0, 0]
    assert np.abs(paired_sum(standing) / 2).mean() < 0.3 * np.abs(standing).mean()
