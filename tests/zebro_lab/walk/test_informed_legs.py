# SPDX-License-Identifier: MIT
"""What walks said of legs and floor applies to the robot and the walk that they were of."""

from dataclasses import replace

import numpy as np
import pytest

from model.robot import Robot
from model.walk_fit.prior import WrongLeg
from support.walk_posteriors import KNOCKED, OFF, posterior_of, predict_log, stored
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.informed_legs import informed_legs


def test_a_leg_knocked_off_in_one_walk_is_off_where_that_walk_is_predicted(
    calibration, legs, tmp_path
):
    walks = stored(calibration, legs, posterior_of(KNOCKED))
    own, other = (informed_legs(walks, RobotFile(), logs=[log]) for log in legs[::-1])
    assert (own.index, other.index) == (1, 0)
    assert own.middle.offset[0, 2] == pytest.approx(OFF)
    assert not other.middle.offset.any()
    assert "no independent test" in own.notes[1]
    to_come = informed_legs(walks, RobotFile())
    assert to_come.index is None
    assert not to_come.middle.offset.any()


def test_another_robot_shares_the_floor_alone(calibration, legs):
    walks = stored(calibration, legs, posterior_of(WrongLeg(2)))
    other = replace(RobotFile(), robot=Robot(leg_arc=np.radians(200.0)))
    informed = informed_legs(walks, other)
    assert not informed.middle.offset.any()
    assert "another robot" in informed.notes[0]
    marked = RobotFile(file=legs[0])  # the same robot, from another file
    assert informed_legs(walks, marked).middle.offset[0, 2] == pytest.approx(OFF)


def test_a_walked_path_is_not_given_offsets_twice(calibration, legs, tmp_path):
    stored(calibration, legs, posterior_of(WrongLeg(2)))
    predict_log(tmp_path, legs[0], str(calibration))
    again = predict_log(tmp_path, tmp_path / "prediction", str(calibration), name="again")
    assert not again.informed.middle.offset.any()
