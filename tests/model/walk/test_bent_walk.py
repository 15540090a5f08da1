# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.path_draws import bent_walk
from model.robot import GRAVITY, Robot
from model.walk.bend import Bend
from model.walk.bent_walk import walk_bent
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.ground import FLAT, with_slope
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.1), 2.0)
LAW = VelocityCoulomb(0.5).table(weight=ROBOT.mass * GRAVITY)
OPTIONS = DynamicsOptions()
BEND = Bend(distance=-0.03, curvature=0.4)


def walked(bend, ground=FLAT, law=LAW):
    return walk_bent(ROBOT, GAIT, law, bend=bend, duration=6.0, options=OPTIONS, ground=ground)


def test_on_level_ground_it_is_the_walk_bent_afterwards():
    here = walked(BEND)
    after = bent_walk(walk(ROBOT, GAIT, LAW, duration=6.0), BEND)
    np.testing.assert_allclose(here.position, after.position, atol=1e-3)
    np.testing.assert_allclose(here.orientation, after.orientation, atol=2e-3)
    share = (here.contact == after.contact).mean()
    assert share > 0.995
    same = here.contact & after.contact
    for name in ("traction_force", "slip_velocity"):  # forward and left of the bent heading
        ours, theirs = (getattr(each, name)[same] for each in (here, after))
        assert np.median(np.abs(ours - theirs)) < 0.02 * np.median(np.abs(theirs))


def test_a_path_bent_on_a_slope_stays_on_it():
    slope = with_slope(FLAT, np.radians(5.0), np.radians(-3.0))
    path = walked(Bend(0.05, 1.0), ground=slope)
    over = path.position[:, 2] - slope.slope_x * path.position[:, 0]
    over -= slope.slope_y * path.position[:, 1]
    level = walked(Bend(0.05, 1.0)).position[:, 2]
    assert np.ptp(over) < 1.2 * np.ptp(level) + 1e-3
    assert path.yaw[-1] > 0.4


def test_a_draw_is_bent_as_a_walk_is():
    slope = with_slope(FLAT, np.radians(4.0), 0.0)
    draw = WalkDraw(ROBOT, GAIT, LAW, ground=slope, bend=BEND)
    poses = planar_walk(draw, duration=6.0).poses
    path = walked(BEND, ground=slope)
    np.testing.assert_allclose(poses.position, path.position[:, :2], atol=1e-9)
    np.testing.assert_allclose(poses.yaw, path.poses.yaw, atol=1e-9)
    assert not replace(draw, ground=FLAT).is_alike_everywhere


def test_without_a_bend_nothing_is_moved():
    path, plain = walked(Bend()), walk(ROBOT, GAIT, LAW, duration=6.0)
    assert path.position[-1] == pytest.approx(plain.position[-1], abs=1e-3)
