# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.errors import DomainError
from model.robot import LEFT, RIGHT, Robot, cuboid_inertia

ROBOT = Robot()


def test_the_default_is_the_sources_robot():
    assert ROBOT.leg_radius == 0.035
    assert ROBOT.mass == 2.17
    assert ROBOT.track == pytest.approx(2 * 0.1156)
    np.testing.assert_allclose(
        ROBOT.principal_inertia, cuboid_inertia(2.17, (0.194, 0.2512, 0.069))
    )


def test_odd_legs_are_left_and_every_leg_has_its_mirror():
    left, right = ROBOT.hips[list(LEFT)], ROBOT.hips[list(RIGHT)]
    assert np.all(left[:, 1] > 0)
    np.testing.assert_array_equal(left * [1, -1, 1], right)
    assert np.all(np.diff(left[:, 0]) < 0)  # front to rear


def test_a_cuboids_moments_are_those_of_its_points():
    size = (0.2, 0.3, 0.1)
    # Midpoints of n cells a side leave out 1/n2 of the moment.
    n = 40
    axes = [length * ((np.arange(n) + 0.5) / n - 0.5) for length in size]
    x, y, z = np.meshgrid(*axes)
    moments = [np.mean(y**2 + z**2), np.mean(x**2 + z**2), np.mean(x**2 + y**2)]
    np.testing.assert_allclose(cuboid_inertia(3.0, size), 3.0 * np.array(moments), rtol=1e-3)


def test_a_given_inertia_replaces_the_cuboids():
    assert replace(ROBOT, inertia=(0.1, 0.2, 0.25)).principal_inertia.tolist() == [0.1, 0.2, 0.25]


def test_lists_do_for_hips_and_offsets():
    robot = replace(ROBOT, hips=ROBOT.hips.tolist(), leg_offset=[0, 0, 1, 0, 0, 0])
    assert robot.hips.dtype == robot.leg_offset.dtype == float
    np.testing.assert_array_equal(robot.hips, ROBOT.hips)


def test_robots_do_not_share_their_arrays():
    Robot().hips[0, 0] = 1.0
    assert Robot().hips[0, 0] == ROBOT.hips[0, 0] == 0.097


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": -1.0}, r"mass is -1 kg; expected more than zero"),
        ({"mass": np.inf}, r"mass is inf kg"),
        ({"leg_radius": 0.0}, r"leg_radius is 0 m"),
        ({"leg_arc": 0.1}, r"leg_arc is 5.7\d* degrees .*; expected 90 to below 360"),
        ({"leg_arc": np.nan}, r"leg_arc is nan degrees"),
        ({"body_size": (0.2, -0.1, 0.1)}, r"the width in body_size is -0.1 m"),
        ({"body_size": (0.2, 0.1)}, r"body_size has shape \(2,\); expected \(3,\)"),
        ({"inertia": (1.0, -2.0, 1.0)}, r"inertia about y is -2 kg m2"),
        ({"inertia": (1.0, 2.0)}, r"inertia has shape \(2,\)"),
        ({"hips": np.zeros((4, 3))}, r"hips has shape \(4, 3\); expected \(6, 3\)"),
        ({"hips": np.full((6, 3), np.nan)}, r"hips is .*nan.*; expected finite numbers"),
        ({"leg_offset": np.zeros(4)}, r"leg_offset has shape \(4,\); expected \(6,\)"),
        ({"leg_offset": [0, 0, np.nan, 0, 0, 0]}, r"leg_offset is .*nan.*; expected finite"),
    ],
)
def test_a_robot_that_cannot_be_is_refused(change, message):
    with pytest.raises(DomainError, match=message):
        replace(ROBOT, **change)
