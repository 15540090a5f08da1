# SPDX-License-Identifier: MIT
"""The marker of robot.toml lies on the robot as its file says."""

import numpy as np
import pytest

from tracking.pose import BodyPrior
from zebro_lab.errors import SettingsError
from zebro_lab.robot_file import Marker, RobotFile
from zebro_lab.tracked_robot import KIT_MARKER, body_prior, tracked_robot

PRIOR = BodyPrior(0.06)


def test_a_print_without_yaw_has_its_top_ahead():
    robot = tracked_robot(RobotFile(marker=Marker((0.01, 0, 0.04))), KIT_MARKER, prior=PRIOR)
    top_left, top_right, _, bottom_left = robot.marker.points_body
    np.testing.assert_allclose(top_left, [0.07, 0.06, 0.04], atol=1e-12)
    np.testing.assert_allclose(top_right, [0.07, -0.06, 0.04], atol=1e-12)
    np.testing.assert_allclose(bottom_left, [-0.05, 0.06, 0.04], atol=1e-12)


def test_a_print_turned_to_the_left_has_its_top_to_the_left():
    turned = Marker((0, 0, 0.04), (0, 0, np.pi / 2))
    robot = tracked_robot(RobotFile(marker=turned), KIT_MARKER, prior=PRIOR)
    np.testing.assert_allclose(robot.marker.points_body[:2].mean(axis=0), [0, 0.06, 0.04])


def test_the_body_is_as_high_as_its_marker_less_its_place_on_it():
    described = RobotFile(marker=Marker((0, 0, 0.04), height=0.105))
    assert body_prior(described).height == pytest.approx(0.065)
    assert body_prior(described, height=0.07, height_sd=0.001) == BodyPrior(0.07, 0.001)


def test_what_is_missing_or_impossible_is_named():
    with pytest.raises(SettingsError, match="marker"):
        tracked_robot(RobotFile(), KIT_MARKER, prior=PRIOR)
    with pytest.raises(SettingsError, match=r"marker\.height"):
        body_prior(RobotFile(marker=Marker((0, 0, 0.04))))
    with pytest.raises(SettingsError, match="--height-sd"):
        body_prior(RobotFile(), height=0.06, height_sd=0.0)
    tilted = RobotFile(marker=Marker((0, 0, 0.04), (0.3, 0, 0)))
    with pytest.raises(SettingsError, match="level"):
        tracked_robot(tilted, KIT_MARKER, prior=PRIOR)
    with pytest.raises(SettingsError, match="side"):
        tracked_robot(RobotFile(marker=Marker((0, 0, 0.04))), "4x4_50:0:0mm", prior=PRIOR)
