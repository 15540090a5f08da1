# SPDX-License-Identifier: MIT
"""Laws of traction that differs along and across a leg's rolling direction."""

import numpy as np
import pytest

from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.leg import ROLLING
from model.robot import GRAVITY, N_LEGS, Robot
from model.slip import MagicFormula
from model.walk.anisotropy import effective_size, find_across, sideways
from model.walk.arrays import new_work
from model.walk.dynamics import DynamicsOptions, Start, walk
from model.walk.ensemble import WalkDraw, walk_ensemble
from model.walk.traction import law_table
from model.walk.traction_lookup import traction_secant

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
VALUES = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
CURVE = law_table(MagicFormula("peak"), VALUES, weight=WEIGHT)
LOAD = 7.0
FACTORS = [(1.3, 0.7), (0.6, 1.7), (1.0, 2.0), (2.0, 1.0), (1.5, 1.5)]


def directed(grip, stiffness, table=CURVE):
    return table._replace(lateral_grip=grip, lateral_stiffness=stiffness)


def force(law, slip, *, contact=0, yaw=0.3):
    """Return traction at a slip velocity along and across a leg that turns at 0.1 m/s."""
    work = new_work()
    c, s = np.cos(yaw), np.sin(yaw)
    work.R[:] = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
    work.normal[contact] = 0.0, 0.0, 1.0
    find_across(law, work, contact)
    lateral, across = work.lateral[contact], work.across[contact]
    world = work.R @ [*slip, 0.0]
    G = traction_secant(law, ROLLING, LOAD, effective_size(lateral, across, *world), 0.1)
    found = -G * (world + sideways(lateral, across, world) * across)
    return (work.R.T @ found)[:2]


@pytest.mark.parametrize(("grip", "stiffness"), FACTORS)
def test_lateral_slip_has_its_factor_on_the_peak_and_on_the_slope(grip, stiffness):
    law = directed(grip, stiffness)
    speeds = 0.1 * np.geomspace(1e-6, 3.0, 3000)
    along = np.array([force(law, (speed, 0.0)) for speed in speeds])
    across = np.array([force(law, (0.0, speed)) for speed in speeds])
    isotropic = np.array([force(CURVE, (speed, 0.0)) for speed in speeds])
    np.testing.assert_allclose(along[:, 0], isotropic[:, 0], rtol=1e-12)
    np.testing.assert_allclose(along[:, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(across[:, 0], 0.0, atol=1e-12)
    assert across[:, 1].min() == pytest.approx(grip * along[:, 0].min(), rel=1e-4)
    assert across[0, 1] == pytest.approx(stiffness * along[0, 0], rel=1e-4)


@pytest.mark.parametrize(("grip", "stiffness"), [*FACTORS, (0.05, 20.0), (20.0, 0.05)])
def test_traction_takes_energy_out_of_any_slip(grip, stiffness):
    for angle in np.linspace(0.0, 2 * np.pi, 25):
        for speed in (1e-4, 0.003, 0.1):
            slip = speed * np.array([np.cos(angle), np.sin(angle)])
            assert force(directed(grip, stiffness), slip) @ slip < 0.0


@pytest.mark.parametrize("angle", np.linspace(0.1, 1.5, 5))
def test_forces_lie_within_an_ellipse_of_the_two_peaks(angle):
    peak = -min(force(CURVE, (v, 0.0))[0] for v in 0.1 * np.geomspace(1e-3, 3.0, 500))
    for speed in 0.1 * np.geomspace(1e-3, 3.0, 50):
        x, y = force(directed(1.4, 0.8), speed * np.array([np.cos(angle), np.sin(angle)]))
        assert np.hypot(x, y / 1.4) <= peak * (1 + 1e-4)


def test_corners_of_the_body_and_isotropic_laws_have_no_direction():
    slip = np.array([0.002, 0.001])
    expected = force(CURVE, slip)
    np.testing.assert_allclose(force(directed(1.4, 0.7), slip, contact=N_LEGS), expected)
    np.testing.assert_array_equal(expected, force(directed(1.0, 1.0), slip))
    assert expected[0] * slip[1] == pytest.approx(expected[1] * slip[0])  # against the slip


def gait(side="left", steering=1.3):
    return tripod_reference(tripod_angles(np.radians(50.0), steering), 1.0, direction=side)


def test_factors_of_one_leave_a_walk_as_it_is_bit_for_bit():
    options = DynamicsOptions(dt=0.005)
    one, other = (
        walk(ROBOT, gait(), law, duration=2.0, options=options)
        for law in (CURVE, directed(1.0, 1.0))
    )
    np.testing.assert_array_equal(one.position, other.position)
    np.testing.assert_array_equal(one.traction_force, other.traction_force)


def test_a_turn_to_the_left_is_the_mirror_image_of_one_to_the_right():
    law = directed(0.7, 1.4)
    other = [
        int(np.argmin(np.linalg.norm(ROBOT.hips - hip * [1, -1, 1], axis=1))) for hip in ROBOT.hips
    ]
    t = np.arange(0.0, 1.6, 0.005)
    theta = gait().angles(t)
    left, right = (
        walk(
            ROBOT, SampledReference(t, each), law, duration=1.5, options=DynamicsOptions(dt=0.002)
        ).poses.states
        for each in (theta, theta[:, other])
    )
    assert abs(left[-1, 2]) > 0.1
    np.testing.assert_allclose(left, right * [1.0, -1.0, -1.0], atol=1e-6)


def test_directions_are_those_of_the_leg_wherever_the_body_heads():
    law, options = directed(0.6, 1.5), DynamicsOptions(dt=0.002)
    ahead, turned = (
        walk(ROBOT, gait(), law, duration=1.5, start=Start(yaw=yaw), options=options).poses.states
        for yaw in (0.0, 2.0)
    )
    c, s = np.cos(2.0), np.sin(2.0)
    np.testing.assert_allclose(turned[:, 2] - 2.0, ahead[:, 2], atol=1e-5)
    np.testing.assert_allclose(turned[:, :2], ahead[:, :2] @ np.array([[c, s], [-s, c]]), atol=2e-6)


def test_a_turn_depends_on_lateral_grip_and_a_straight_walk_hardly():
    t = np.arange(0.0, 6.0, 0.01)
    moved = {}
    for name, steering in (("straight", 1.0), ("turn", 1.3)):
        log = SampledReference(t, gait(steering=steering).angles(t))
        ends = walk_ensemble(
            [WalkDraw(ROBOT, log, each) for each in (directed(0.7, 1.0), directed(1.4, 1.0))],
            np.array([0.0, 5.0]), options=DynamicsOptions(dt=0.005),
        ).poses.states[:, -1]  # fmt: skip
        moved[name] = np.abs(np.ptp(ends, axis=0))
    assert moved["turn"][2] > 5 * moved["straight"][2]
    assert moved["turn"][:2].max() > 5 * moved["straight"][:2].max()
