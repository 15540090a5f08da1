# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.robot import Robot
from model.slip.thesis_curve import thesis_curve
from model.thesis.kinematics import Legs
from model.thesis.loads import Balance
from model.thesis.slip_ratio import along, find_slip, lateral_walk_slip, walk_slip
from model.thesis.step import Machine
from model.thesis.traction import slip_traction
from model.thesis.walk import ThesisOptions
from model.walk.slip import Slip
from model.walk.traction import VelocityCoulomb


@pytest.mark.parametrize(("leg", "ground", "slip"), [(1.0, 0.5, 1.0), (0.5, 1.0, -0.5), (0, 0, 0)])
def test_the_walk_s_slip_is_the_excess_over_the_ground_speed(leg, ground, slip):
    assert walk_slip(float(leg), float(ground), True) == pytest.approx(slip)


def test_slip_on_standing_ground_is_cut_off():
    assert walk_slip(1.0, 1e-9, True) == 100.0


def test_a_leg_that_turns_back_by_a_hair_drives_at_full_grip_in_the_listing_only():
    assert walk_slip(-1e-6, 0.1, False) > 0.9
    assert walk_slip(-1e-6, 0.1, True) == pytest.approx(-1.0, abs=1e-4)


def test_velocity_along_an_axis_counts_rotation_about_the_arm():
    v, arm = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3]), np.array([0.5, -0.4, 0.3])
    full = v[:3] + np.cross(v[3:], arm)
    for axis in np.eye(3):
        assert along(axis, v, arm) == pytest.approx(axis @ full)


ROBOT = Robot()
MACHINE = Machine(
    ROBOT.hips, ROBOT.leg_radius, ROBOT.toe_beyond, ROBOT.mass, ROBOT.principal_inertia, ROBOT.track
)
THREE = np.array([0, 3, 4])
HEIGHT = 0.06


def slip_of(v, phi, law, options):
    """Return the slip of three legs at one phi that turn at -2 rad/s, under a level body."""
    hip, point = ROBOT.hips + np.array([0.0, 0.0, HEIGHT]), ROBOT.hips.copy()
    height = np.full(6, HEIGHT)
    legs = Legs(np.full(6, phi), np.full(6, -2.0), height, height, height, point, hip)
    balance = Balance(np.empty((3, 3)), np.eye(3), np.empty((3, 2)), np.ones(2), np.zeros(2),
                      np.empty((3, 3)))  # fmt: skip
    q = np.array([0.0, 0.0, HEIGHT, 0.0, 0.0, 0.0])
    find_slip(MACHINE, options.manner, law, legs, THREE, q, v, balance)
    np.testing.assert_allclose(balance.arms, point[THREE] - q[:3])
    return balance.slip


ROLLING_PHI, TOE_PHI = 1.8, -0.5
MENDED = ThesisOptions(mend_slip=True)
MAGIC = slip_traction(Slip(thesis_curve(), "thesis"), weight=20.0)


@pytest.mark.parametrize("phi", [ROLLING_PHI, TOE_PHI])
def test_slip_of_legs_that_carry_load_compares_arc_and_ground(phi):
    v = np.array([0.1, 0.02, 0.0, 0.0, 0.0, 0.3])
    slip = slip_of(v, phi, MAGIC, MENDED)
    ground = v[0] - v[5] * ROBOT.hips[THREE, 1]  # yaw adds to the right, takes from the left
    np.testing.assert_allclose(slip[:, 0], [walk_slip(2.0 * HEIGHT, g, True) for g in ground])
    np.testing.assert_allclose(slip[:, 1], lateral_walk_slip(v[0], v[1], True))


def test_pitching_moves_the_ground_at_the_contact_but_not_at_the_hip():
    pitching = np.array([0.1, 0.0, 0.0, 0.0, 0.5, 0.0])
    toe = slip_of(pitching, TOE_PHI, MAGIC, MENDED)[:, 0]
    np.testing.assert_allclose(toe, walk_slip(2.0 * HEIGHT, 0.1 + 0.5 * ROBOT.hips[0, 2], True))
    rolling = slip_of(pitching, ROLLING_PHI, MAGIC, MENDED)[:, 0]
    below = ROBOT.hips[0, 2] - HEIGHT
    np.testing.assert_allclose(rolling, walk_slip(2.0 * HEIGHT, 0.1 + 0.5 * below, True))


def test_a_law_by_slip_velocity_gets_velocities_over_its_scale():
    law = slip_traction(Slip(VelocityCoulomb(0.4, 0.002), "coulomb"), weight=20.0)
    slip = slip_of(np.array([0.1, 0.02, 0.0, 0.0, 0.0, 0.0]), ROLLING_PHI, law, MENDED)
    np.testing.assert_allclose(slip, np.tile([(0.12 - 0.1) / 0.002, -0.02 / 0.002], (3, 1)))
