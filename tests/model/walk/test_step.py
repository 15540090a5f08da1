# SPDX-License-Identifier: MIT
"""Forces of one step: contacts that press or do not, and slide."""

import numpy as np
import pytest

from model.robot import GRAVITY, Robot
from model.walk.arrays import Contacts, body_arrays, new_work
from model.walk.dynamics import DEFAULT_OPTIONS, start_state
from model.walk.ground import FLAT
from model.walk.step import (
    SETTLED,
    contact_damping,
    leg_turn,
    one_step,
    settling_error,
)
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
CONTACTS = Contacts(DEFAULT_OPTIONS.stiffness, DEFAULT_OPTIONS.damping)
STANDING = np.full(6, np.pi / 2)


def stepped(state, *, speed=0.0, dt=0.001):
    table = VelocityCoulomb(0.4).table(weight=WEIGHT)
    work = new_work()
    one_step(
        body_arrays(ROBOT), table, FLAT, CONTACTS, state, work, STANDING, np.full(6, speed), dt
    )
    return work


def test_legs_of_a_standing_robot_carry_its_weight():
    work = stepped(start_state(ROBOT, STANDING, DEFAULT_OPTIONS))
    assert work.load.sum() == pytest.approx(WEIGHT, rel=1e-3)
    assert np.all(work.load[:6] > 0)


def test_traction_is_that_of_the_final_slip_where_sliding_feet_almost_take_hold():
    state, dt = start_state(ROBOT, STANDING, DEFAULT_OPTIONS), 0.004
    state.v[0] = 0.02
    work = stepped(state, dt=dt)
    slip = [state.v[0] + state.w[1] * place[2] - state.w[2] * place[1] for place in work.place[:6]]
    traction = 0.4 * work.load[:6] * slip / np.hypot(slip, 1e-3)
    by_traction = 0.02 - dt * traction.sum() / ROBOT.mass
    assert state.v[0] == pytest.approx(by_traction, abs=2 * SETTLED)


def test_a_body_in_the_air_has_no_contact_and_falls():
    state = start_state(ROBOT, STANDING, DEFAULT_OPTIONS)
    state.p[2] = 1.0
    work = stepped(state)
    assert not work.load.any()
    np.testing.assert_allclose(state.v, [0.0, 0.0, -0.001 * GRAVITY], atol=1e-12)


def test_a_legs_turn_over_the_ground_includes_the_pitch_rate_of_the_body():
    w = np.array([0.1, 0.2, 0.3])
    assert leg_turn(np.eye(3), np.full(6, 2.0), w, 0) == pytest.approx(2.2)


@pytest.mark.parametrize("dt", [1e-5, 0.0005, 0.0015, 0.005])
def test_steps_up_to_damping_over_stiffness_damp_alike(dt):
    in_all = contact_damping(CONTACTS, dt) + CONTACTS.stiffness * dt
    assert in_all == pytest.approx(max(CONTACTS.damping, CONTACTS.stiffness * dt))


@pytest.mark.parametrize("dt", [0.0005, 0.005])
def test_where_traction_does_not_grow_with_slip_a_guess_is_off_by_the_settling_error(dt):
    mass, traction, before, off = ROBOT.mass, 12.0, 0.03, 1e-5
    end = before - dt * traction / mass
    guess = end + off
    secant = traction / guess
    solved = mass * before / (mass + dt * secant)
    assert settling_error(abs(solved - guess), secant, mass, dt) == pytest.approx(off, rel=0.01)
