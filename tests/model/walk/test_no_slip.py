# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.errors import DomainError, WalkError
from model.frames import attitude, rotation_z
from model.gait.cyclic import CyclicReference
from model.gait.notation import TRIPOD
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.thesis.legs import SwitchedLegs
from model.walk.no_slip import walk_no_slip, walk_wheels
from model.walk.path import turning_radius

ROBOT = Robot()
LONG = Robot(leg_arc=np.radians(200.0))
CYCLE = 2.0


def gait(steering, *, robot=ROBOT, cycle=CYCLE, direction="left", inner_deg=50.0):
    angles = tripod_angles(np.radians(inner_deg), steering, leg_arc=robot.leg_arc)
    return tripod_reference(angles, cycle, direction=direction)


def radius(path, dt=0.001):
    strides = slice(None, None, round(CYCLE / dt))
    return turning_radius(path.position[strides, :2], path.yaw[strides])


@pytest.mark.parametrize(("steering", "no_slip", "wheels"), [(1.1, 2.66, 2.43), (1.3, 0.99, 0.89)])
def test_turning_radii_are_those_of_the_models(steering, no_slip, wheels):
    reference = gait(steering)
    assert radius(walk_no_slip(ROBOT, reference, duration=8.0)) == pytest.approx(no_slip, abs=0.006)
    assert radius(walk_wheels(ROBOT, reference, duration=8.0)) == pytest.approx(wheels, abs=0.006)


def test_wheels_turn_about_the_point_that_the_steering_factor_says():
    path = walk_wheels(ROBOT, gait(1.2), duration=4.0)
    assert radius(path) == pytest.approx(0.5 * ROBOT.track * 2.2 / 0.2)


def test_a_straight_walk_covers_the_legs_hip_travel():
    reference = gait(1.0)
    path = walk_no_slip(ROBOT, reference, duration=CYCLE)
    down, up, r = reference.touchdown[0], reference.liftoff[0], ROBOT.leg_radius
    # The integral of the hip's height over the leg's angle, on the arc and then on the toe.
    step = r * (np.pi / 2 - down + np.cos(down)) - 2 * r * np.cos(up)
    assert path.position[-1, 0] == pytest.approx(2 * step, rel=1e-5)
    assert np.abs(path.position[:, 1]).max() < 1e-9


def test_legs_that_walk_straight_need_not_slip():
    path = walk_no_slip(ROBOT, gait(1.0), duration=CYCLE / 2 - 0.01)
    assert np.abs(path.slip_velocity[1:]).max() < 1e-12


def test_in_a_turn_legs_slip_sideways_and_hardly_forward():
    path = walk_no_slip(ROBOT, gait(1.3), duration=CYCLE / 2 - 0.01)
    slip = np.abs(path.slip_velocity[1:]).max(axis=(0, 1))
    assert slip[1] > 1e-3 > 10 * slip[0]


def test_the_path_moves_a_toe_by_the_slip_it_claims():
    dt, leg, at = 0.0005, 0, 1600  # leg 1, on its toe at 0.8 s
    path = walk_no_slip(ROBOT, gait(1.2), duration=0.9, dt=dt)

    def toe(k):
        angle = path.theta[k, leg]
        straight = 2 * ROBOT.leg_radius * np.array([np.cos(angle), 0, -np.sin(angle)])
        return path.position[k] + attitude(*path.orientation[k]) @ (ROBOT.hips[leg] + straight)

    speed = rotation_z(-path.yaw[at]) @ (toe(at + 1) - toe(at - 1)) / (2 * dt)
    np.testing.assert_allclose(speed[:2], path.slip_velocity[at, leg], atol=1e-6)
    assert speed[2] == pytest.approx(0.0, abs=1e-6)


def test_time_scales_out():
    slow, fast = (
        walk_no_slip(ROBOT, gait(1.2, cycle=c), duration=2 * c, dt=c / 1000) for c in (1.0, 2.0)
    )
    np.testing.assert_allclose(slow.position, fast.position, atol=1e-9)


def test_left_and_right_turns_mirror():
    left = walk_no_slip(ROBOT, gait(1.2), duration=4.0)
    # A right turn starts on the same tripod, so the left one's mirror is half a cycle later.
    later = replace(gait(1.2, direction="right"), phase=gait(1.2).phase + 0.5)
    right = walk_no_slip(ROBOT, later, duration=4.0)
    np.testing.assert_allclose(right.position, left.position * [1, -1, 1], atol=1e-9)
    np.testing.assert_allclose(right.orientation, left.orientation * [-1, 1, -1], atol=1e-9)


def test_the_path_converges_with_the_square_of_the_step():
    ends = [
        walk_no_slip(ROBOT, gait(1.3), duration=4.0, dt=dt).position[-1]
        for dt in (0.04, 0.02, 0.0005)
    ]
    coarse, fine = (np.linalg.norm(end[:2] - ends[-1][:2]) for end in ends[:2])
    assert coarse / fine > 3.5


def test_a_longer_arc_at_matched_heights_hardly_changes_the_radius():
    circles = [
        radius(walk_no_slip(robot, gait(1.2, robot=robot), duration=8.0)) for robot in (ROBOT, LONG)
    ]
    assert circles[1] == pytest.approx(circles[0], rel=0.01)


def test_leg_offsets_turn_a_straight_walk():
    offset = np.zeros(6)
    offset[2] = np.radians(-5.0)
    path = walk_no_slip(Robot(leg_offset=offset), gait(1.0), duration=4.0)
    assert abs(path.yaw[-1]) > np.radians(0.5)
    np.testing.assert_allclose(path.theta[:, 2] - path.theta[:, 5], offset[2], atol=1e-9)


def test_forces_are_unknown_on_the_ground_and_zero_in_the_air():
    path = walk_wheels(ROBOT, gait(1.1), duration=1.0)
    assert np.isnan(path.normal_force[path.contact]).all()
    assert np.all(path.normal_force[~path.contact] == 0.0)
    assert np.isnan(path.slip_ratio).all()


def test_no_time_is_refused():
    with pytest.raises(DomainError, match="duration is 0 s"):
        walk_no_slip(ROBOT, gait(1.1), duration=0.0)


def test_a_robot_that_falls_over_is_an_error_with_its_time():
    ahead = Robot(hips=ROBOT.hips + np.array([0.2, 0.0, 0.0]))
    with pytest.raises(WalkError, match=r"at t = 0 s.*no three legs hold"):
        walk_no_slip(ahead, gait(1.1), duration=1.0)


# --- reference data


def listing(shared, name):
    import pandas as pd

    return pd.read_csv(shared / f"reference/listing/{name}.csv.gz")


@pytest.mark.reference
def test_a_straight_walk_is_the_references_exact_no_slip_path(shared):
    table = listing(shared, "g")
    down, up = np.radians([50.0, 118.0])
    reference = CyclicReference(
        np.array(down), np.array(up), np.array(1.0), np.array(1.0), 0.5 * TRIPOD.group_of
    )
    turned = SwitchedLegs.of(reference).motion(0.001, 14_002)
    sampled = SampledReference(0.001 * np.arange(14_002), turned.theta)
    path = walk_no_slip(ROBOT, sampled, duration=14.0).part(slice(1, None, 10))
    n = len(path.t)
    np.testing.assert_allclose(path.position[:, 0], table["kx"][:n], atol=2e-5)
    np.testing.assert_allclose(path.position[:, 1], table["ky"][:n], atol=2e-5)


@pytest.mark.reference
@pytest.mark.parametrize(("name", "steering", "inner_deg"), [("a_left", 1.2, 45), ("c", 1.1, 50)])
def test_turns_are_the_references_no_slip_paths_but_for_late_switching(
    shared, name, steering, inner_deg
):
    """The listing's legs switch speed up to a step late, which ours by the clock do not."""
    table = listing(shared, name)
    cycle = {"a_left": 1.0, "c": 2.0}[name]
    reference = gait(steering, cycle=cycle, inner_deg=inner_deg)
    path = walk_no_slip(ROBOT, reference, duration=float(table["t"].iloc[-1]))
    off = path.position[::10, :2] - table[["kx", "ky"]].to_numpy()[: len(path.t[::10])]
    assert np.linalg.norm(off, axis=1).max() < 0.01
    assert path.yaw[-1] == pytest.approx(table["kyaw"].iloc[-1], rel=0.01)
