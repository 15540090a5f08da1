# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.accuracy.engine_ground import engine_ground, rough
from benchmarks.accuracy.rigid_engine.stepping import Friction
from benchmarks.accuracy.rigid_engine.walking import EVERY, walk
from model.robot import GRAVITY, N_LEGS, Robot

STANDING = np.radians([118.0, 50.0, 50.0, 118.0, 118.0, 50.0])
pytestmark = pytest.mark.long


def stand(friction, seconds=0.3, **options):
    t = np.array([0.0, seconds])
    return walk(Robot(), t, np.tile(STANDING, (2, 1)), friction, **options)


def test_legs_that_stand_carry_the_weight_and_stay():
    path = stand(Friction(0.38, 1e-3))
    assert path.load[-1].sum() == pytest.approx(Robot().mass * GRAVITY, rel=1e-3)
    assert np.abs(path.position[-1, :2]).max() < 1e-4
    assert path.angle_error < np.radians(0.02)


def test_a_robot_on_ice_slides_down_a_slope_as_fast_as_gravity_lets_it():
    from benchmarks.accuracy.rigid_engine.arcs import FLAT

    slope = np.tan(np.radians(5.0))
    path = stand(Friction(0.0, 1e-3), heights=FLAT._replace(rise_x=slope))
    fall = 0.5 * GRAVITY * np.sin(np.radians(5.0)) * np.cos(np.radians(5.0)) * path.t[-1] ** 2
    assert path.position[-1, 0] == pytest.approx(-fall, rel=0.02)


def test_a_robot_put_on_rough_ground_rests_there_before_it_walks():
    case = rough(10)[-1]
    heights, _ = engine_ground(case)
    path = stand(Friction(3.0, 1e-3), heights=heights)
    np.testing.assert_allclose(path.position[0, :2], 0.0, atol=1e-9)
    assert np.abs(path.position[-1] - path.position[0]).max() < 2e-4


def test_legs_that_turn_together_walk_at_the_speed_of_their_arcs():
    theta = np.radians([[50.0] * N_LEGS, [80.0] * N_LEGS])
    path = walk(Robot(), np.array([0.0, 1.0]), theta, Friction(0.38, 1e-3))
    rolled = Robot().leg_radius * (np.radians(30.0) + np.cos(theta[0, 0]) - np.cos(theta[1, 0]))
    assert path.position[-1, 0] == pytest.approx(rolled, rel=0.03)
    assert len(path.t) == round(1.0 / EVERY) + 1
