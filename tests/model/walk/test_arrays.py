# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.robot import Robot
from model.walk.arrays import body_arrays, copy_state, new_state, new_work


def test_a_body_holds_its_robot():
    robot = Robot()
    body = body_arrays(robot)
    np.testing.assert_array_equal(body.hips, robot.hips)
    assert (body.mass, body.leg_radius) == (robot.mass, robot.leg_radius)
    assert body.toe_cos**2 + body.toe_sin**2 == pytest.approx(1.0)
    np.testing.assert_allclose(2 * body.half_size, robot.body_size)
    np.testing.assert_array_equal(body.inertia, robot.principal_inertia)


def test_a_copied_state_is_its_own():
    one, other = new_state(), new_state()
    for array in one:
        array[:] = np.random.default_rng(1).random(array.shape)
    copy_state(one, other)
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)
    one.p[:] = 7.0
    assert not np.any(other.p == 7.0)


def test_new_work_presses_no_contact():
    work = new_work()
    assert not work.load.any()
    assert not work.secant.any()
    assert work.place.shape == (14, 3)
    assert work.A.shape == (6, 6)
