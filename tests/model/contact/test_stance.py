# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.contact.stance import ON_GROUND, TRIPLES, resting_stance, stand
from model.errors import DomainError
from model.frames import attitude
from model.leg import contact_angle, contact_in_body, lowest_angle
from model.robot import Robot

ROBOT = Robot()
LONG = Robot(leg_arc=np.radians(200.0))
STANDING = st.lists(st.floats(0.5, 2.4), min_size=6, max_size=6).map(np.array)
ANY = st.lists(st.floats(0.0, 6.28), min_size=6, max_size=6).map(np.array)


@given(STANDING, st.sampled_from([(0, 3, 4), (1, 2, 5), (1, 4, 5)]), st.sampled_from([ROBOT, LONG]))
def test_three_legs_touch_the_ground_in_the_attitude_found(theta, legs, robot):
    stance = stand(robot, theta, legs=legs)
    assert np.abs(stance.clearance[list(legs)]).max() < 1e-12
    R = attitude(stance.roll, stance.pitch, 0.7)
    np.testing.assert_allclose(R[2], stance.up, atol=1e-12)
    phi = lowest_angle(theta, stance.roll, stance.pitch)
    x, z = contact_in_body(theta, contact_angle(phi, robot.toe_beyond), robot.leg_radius)
    points = robot.hips + np.column_stack([x, 0 * x, z])
    np.testing.assert_allclose((points @ R.T)[:, 2] + stance.height, stance.clearance, atol=1e-12)


@given(ANY, st.sampled_from([ROBOT, LONG]))
def test_at_rest_no_leg_is_below_the_ground_and_the_weight_is_inside(theta, robot):
    stance = resting_stance(robot, theta)
    assert stance.feasible
    assert stance.depth >= -ON_GROUND
    assert stance.standing[stance.legs].all()


@given(ANY)
def test_at_rest_no_other_three_legs_would_do_more_level(theta):
    rest = resting_stance(ROBOT, theta)
    for three in TRIPLES:
        if len({leg % 2 for leg in three}) == 2:
            other = stand(ROBOT, theta, legs=three)
            assert not (other.feasible and other.depth > 0 and other.up[2] > rest.up[2] + 1e-12)


@given(ANY)
def test_the_mirrored_robot_rests_mirrored(theta):
    swap = [1, 0, 3, 2, 5, 4]
    left, right = resting_stance(ROBOT, theta), resting_stance(ROBOT, theta[swap])
    assert right.height == pytest.approx(left.height, abs=1e-9)
    assert right.pitch == pytest.approx(left.pitch, abs=1e-9)
    assert right.roll == pytest.approx(-left.roll, abs=1e-9)


def test_two_pairs_of_legs_alike_stand_in_one_plane():
    theta = np.radians([100.0, 250.0, 70.0, 100.0, 250.0, 70.0])
    stance = resting_stance(ROBOT, theta)
    assert np.flatnonzero(stance.standing).tolist() == [0, 2, 3, 5]


def test_legs_of_one_side_cannot_carry():
    with pytest.raises(DomainError, match="legs 1, 3, 5 lie on one line seen from above"):
        stand(ROBOT, np.full(6, np.pi / 2), legs=(0, 2, 4))


def test_a_robot_whose_hips_do_not_surround_its_weight_cannot_rest():
    hips = ROBOT.hips + np.array([0.2, 0.0, 0.0])
    with pytest.raises(DomainError, match="no three legs hold the robot"):
        resting_stance(Robot(hips=hips), np.full(6, np.pi / 2))
