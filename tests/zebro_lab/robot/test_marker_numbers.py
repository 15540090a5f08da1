# SPDX-License-Identifier: MIT
"""Markers have numbers of their dictionary, and no number twice."""

import pytest

from tracking.errors import MarkerError
from tracking.pose import BodyPrior
from zebro_lab.robot.marker_numbers import require_apart, require_in_dictionary
from zebro_lab.robot.marker_print import MarkerPrint
from zebro_lab.robot.robot_file import Marker, RobotFile
from zebro_lab.track.camera.kit import FLOOR_MARKERS, starter_floor
from zebro_lab.track.inputs import tracked_robot


@pytest.mark.parametrize(
    ("dictionary", "last"), [("4x4_50", 49), ("5x5_100", 99), ("apriltag_36h11", 586)]
)
def test_numbers_of_a_dictionary_end_with_its_last_marker(dictionary, last):
    require_in_dictionary(dictionary, (0, last))
    message = f"marker {last + 1} is not in the dictionary '{dictionary}' of 0 to {last}"
    with pytest.raises(MarkerError, match=message):
        require_in_dictionary(dictionary, (0, last + 1))


def test_an_unknown_dictionary_is_named():
    with pytest.raises(MarkerError, match="3x3"):
        require_in_dictionary("3x3", ())


def test_the_robots_number_is_not_laid_out_on_the_floor():
    for number in (FLOOR_MARKERS[0], max(FLOOR_MARKERS) + 1):
        marker = Marker((0, 0, 0.04), printed=MarkerPrint(number=number))
        robot = tracked_robot(RobotFile(marker=marker), prior=BodyPrior(0.06))
        if number in FLOOR_MARKERS:
            with pytest.raises(
                MarkerError, match=f"marker {number} is listed both for the robot and for"
            ):
                require_apart(robot, starter_floor())
        else:
            require_apart(robot, starter_floor())
