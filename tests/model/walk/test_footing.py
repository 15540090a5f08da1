# SPDX-License-Identifier: MIT
from functools import cache

import numpy as np
import pytest
from scipy.interpolate import interpn

from model.contact.detection import detect_contacts
from model.contact.sequence import agreement
from model.errors import DomainError
from model.frames import attitude
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import GRAVITY, Robot
from model.walk.dynamics import walk
from model.walk.footing import GroundFooting
from model.walk.ground import FACE, FLAT, sample_ground, with_slope, with_steps
from model.walk.roughness import rough_ground
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
TRIPOD = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
TETRAPOD = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
ROUGH = rough_ground(0.003, 0.06, rng=np.random.default_rng(2))
STEP = with_steps(FLAT, np.array([0.3]), np.array([0.01]))
HIGH = FLAT._replace(height=np.full((1, 1), 0.2), highest=0.2)
LAW = VelocityCoulomb(0.6).table(weight=ROBOT.mass * GRAVITY)


def footing(theta, ground, *, height=0.06, yaw=0.0):
    pose = np.zeros((len(theta), 6))
    pose[:, 2], pose[:, 5] = height, yaw
    return GroundFooting(ROBOT, theta, pose, ground)


@cache
def walked(ground_name):
    ground = {"rough": ROUGH, "step": STEP}[ground_name]
    path = walk(ROBOT, TRIPOD, LAW, duration=5.0, ground=ground)
    pose = np.column_stack([path.position, path.orientation])
    found = GroundFooting(ROBOT, path.theta, pose, ground)
    return path, found, detect_contacts(ROBOT, path.theta, footing=found)


def height_at(ground, x, y):
    """Return the ground's heights at places, by other code than the model's, shape (n,) [m]."""
    steps = sum(np.interp(x, [at - FACE, at], [0.0, rise])
                for at, rise in zip(ground.edge, ground.rise, strict=True))  # fmt: skip
    if ground.height.size == 1:
        return steps + ground.height[0, 0]
    m, n = ground.height.shape
    at = np.column_stack([((x - ground.x) / ground.step) % (m - 1),
                          ((y - ground.y) / ground.step) % (n - 1)])  # fmt: skip
    return steps + interpn((np.arange(m), np.arange(n)), ground.height, at)


def over_ground(found, k, up, height, ground):
    """Return how high each leg's arc is over the ground, by many points of it, shape (6,) [m]."""
    roll, pitch = np.arctan2(up[1], up[2]), -np.arcsin(up[0])
    R = attitude(roll, pitch, found.pose[k, 5])
    least = []
    for leg, theta in enumerate(found.theta[k]):
        psi = np.linspace(theta - ROBOT.toe_beyond, theta + np.pi, 4001)
        centre = ROBOT.hips[leg] + ROBOT.leg_radius * np.array([np.cos(theta), 0, -np.sin(theta)])
        arc = np.stack([np.cos(psi), 0 * psi, -np.sin(psi)], axis=-1) * ROBOT.leg_radius
        x, y, z = ((centre + arc) @ R.T + [*found.pose[k, :2], height]).T
        least.append((z - height_at(ground, x, y)).min())
    return np.array(least)


@pytest.mark.parametrize("gait", [TRIPOD, TETRAPOD])
@pytest.mark.parametrize("ground", [FLAT, HIGH])
def test_on_level_ground_contacts_are_those_of_flat_ground(gait, ground):
    theta = gait.angles(np.arange(750) * 0.004)
    high = ground.height[0, 0]
    flat = detect_contacts(ROBOT, theta)
    found = detect_contacts(ROBOT, theta, footing=footing(theta, ground, height=0.05 + high))
    np.testing.assert_array_equal(found.contact, flat.contact)
    np.testing.assert_allclose(found.height, flat.height + high, atol=1e-9)
    np.testing.assert_allclose(found.roll, flat.roll, atol=1e-9)
    np.testing.assert_allclose(found.pitch, flat.pitch, atol=1e-9)


def test_on_a_slope_the_body_lies_along_it_on_the_legs_of_flat_ground():
    theta, slope = TRIPOD.angles(np.arange(500) * 0.004), np.radians(4.0)
    flat = detect_contacts(ROBOT, theta)
    up = detect_contacts(ROBOT, theta, footing=footing(theta, with_slope(FLAT, slope, 0.0)))
    np.testing.assert_array_equal(up.contact, flat.contact)
    np.testing.assert_allclose(up.pitch, flat.pitch - slope, atol=np.radians(0.02))
    across = footing(theta, with_slope(FLAT, slope, 0.0), yaw=np.pi / 2)
    assert across.rest(0).roll == pytest.approx(flat.roll[0] - slope, abs=np.radians(0.05))


def test_uphill_the_centre_of_mass_is_nearer_to_the_rear_legs_by_height_times_slope():
    theta, slope = np.full((1, 6), np.radians(90.0)), np.radians(5.0)
    level, steep = (footing(theta, with_slope(FLAT, angle, 0.0)) for angle in (0.0, slope))
    one, other = (each.stand(0, np.array([0, 1, 4])) for each in (level, steep))
    # seen from above, leg 1 comes nearer to the centre of mass, which stays over the same place
    ahead = np.cos(slope) * other.points[0, 0] - np.sin(slope) * -other.points[0, 2]
    assert ahead - one.points[0, 0] == pytest.approx(-np.tan(slope) * one.height, abs=1e-3)


def test_a_plane_as_heights_is_a_plane_as_slope():
    theta = TETRAPOD.angles(np.arange(250) * 0.006)
    plane = with_slope(FLAT, np.radians(3.0), np.radians(-2.0))
    grid = sample_ground(lambda x, y: plane.slope_x * x + plane.slope_y * y, x=(-1, 1), y=(-1, 1))
    one, other = (detect_contacts(ROBOT, theta, footing=footing(theta, g)) for g in (plane, grid))
    assert agreement(one.contact, other.contact)[0] > 0.99
    same = (one.contact == other.contact).all(axis=1)
    np.testing.assert_allclose(one.height[same], other.height[same], atol=1e-5)


@pytest.mark.parametrize("name", ["rough", "step"])
def test_legs_that_stand_touch_the_ground_and_no_leg_is_below_it(name):
    path, found, contacts = walked(name)
    for k in range(100, len(contacts), 475):
        stance = found.stand(k, contacts.legs[k])
        over = over_ground(found, k, stance.up, stance.height, found.ground)
        np.testing.assert_allclose(over[contacts.legs[k]], 0.0, atol=2e-5)
        assert over.min() > -2e-5
    assert len(contacts) == len(path.t)


@pytest.mark.parametrize("name", ["rough", "step"])
def test_on_its_ground_detection_agrees_more_with_the_forces_than_on_flat_ground(name):
    path, _, contacts = walked(name)
    flat = detect_contacts(ROBOT, path.theta)
    on_ground, on_flat = (agreement(each.contact, path.contact)[1].mean()
                          for each in (contacts, flat))  # fmt: skip
    assert on_ground > on_flat
    assert on_ground > 0.97
    assert np.abs(contacts.height - path.position[:, 2]).max() < 0.004


def test_legs_on_a_line_are_no_stance():
    with pytest.raises(DomainError, match="legs 1, 3, 5 lie on one line"):
        footing(TRIPOD.angles(0.0), FLAT).stand(0, np.array([0, 2, 4]))


def test_a_robot_that_no_legs_hold_is_said_to_have_none():
    ahead = Robot(hips=ROBOT.hips + np.array([0.3, 0.0, 0.0]))
    pose = np.array([[0.0, 0.0, 0.06, 0.0, 0.0, 0.0]])
    with pytest.raises(DomainError, match="no three legs hold the robot on the ground"):
        GroundFooting(ahead, TRIPOD.angles(0.5), pose, ROUGH).rest(0)
