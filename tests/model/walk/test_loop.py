# SPDX-License-Identifier: MIT
"""Steps of the walk against mechanics: free fall, standing, sliding, and its own order."""

import numpy as np
import pytest

from model.robot import GRAVITY, N_LEGS, Robot
from model.walk.arrays import Contacts, body_arrays
from model.walk.dynamics import DEFAULT_OPTIONS, start_state
from model.walk.ground import FLAT
from model.walk.loop import run_steps
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
CONTACTS = Contacts(DEFAULT_OPTIONS.stiffness, DEFAULT_OPTIONS.damping)
STANDING = np.full(N_LEGS, np.pi / 2)


def run(*, n=200, dt=0.001, height=None, velocity=(0.0, 0.0, 0.0), friction=0.38, theta=None):
    """Return the poses and the final state after n steps with legs held, or turned by `theta`."""
    theta = np.tile(STANDING, (n + 1, 1)) if theta is None else theta
    state = start_state(ROBOT, theta[0], DEFAULT_OPTIONS)
    if height is not None:
        state.p[2] = height
    state.v[:] = velocity
    poses, legs = np.empty((n, 7)), np.empty((n, N_LEGS + 1, 6))
    table = VelocityCoulomb(friction).table(weight=ROBOT.mass * GRAVITY)
    done = run_steps(body_arrays(ROBOT), table, FLAT, CONTACTS, state, theta, dt, poses, legs)
    assert done == n
    return poses, state


def test_a_body_in_the_air_falls_freely():
    poses, state = run(n=100, height=1.0)
    t = 0.1
    assert poses[-1, 2] == pytest.approx(1.0 - 0.5 * GRAVITY * t**2, rel=0.002)
    assert state.v[2] == pytest.approx(-GRAVITY * t)
    np.testing.assert_allclose(poses[-1, :2], 0.0, atol=1e-12)


def test_a_standing_robot_stays():
    poses, state = run(n=500)
    np.testing.assert_allclose(poses[-1, :3], poses[0, :3], atol=2e-4)
    np.testing.assert_allclose(state.v, 0.0, atol=1e-3)


def test_a_sliding_robot_is_braked_by_friction():
    mu, t = 0.2, 0.1
    _, state = run(n=100, velocity=(1.0, 0.0, 0.0), friction=mu)
    assert state.v[0] == pytest.approx(1.0 - mu * GRAVITY * t, rel=0.05)


def test_finer_steps_lead_to_the_same_place():
    def walked(dt):
        t = np.arange(0.0, 0.4 + dt / 2, dt)
        theta = STANDING + np.outer(2.0 * t, np.ones(N_LEGS)) - 0.4
        return run(n=len(t) - 1, dt=dt, theta=theta)[0][-1]

    coarse, fine, finest = walked(0.002), walked(0.001), walked(0.0005)
    assert np.abs(fine - finest).max() <= np.abs(coarse - finest).max() + 1e-9
    np.testing.assert_allclose(coarse[:3], finest[:3], atol=2e-3)


def test_steps_end_where_the_state_is_not_finite():
    theta = np.tile(STANDING, (11, 1))
    theta[4] = np.nan
    state = start_state(ROBOT, STANDING, DEFAULT_OPTIONS)
    table = VelocityCoulomb(0.38).table(weight=ROBOT.mass * GRAVITY)
    poses, legs = np.empty((10, 7)), np.empty((0, N_LEGS + 1, 6))
    done = run_steps(body_arrays(ROBOT), table, FLAT, CONTACTS, state, theta, 0.001, poses, legs)
    assert done == 3
