# SPDX-License-Identifier: MIT
"""Check that marker numbers exist in a dictionary, and differ between robot and floor."""

from collections.abc import Iterable

from tracking.detect import MarkedRobot
from tracking.errors import MarkerError
from tracking.floor import FloorMap
from tracking.markers import marker_family


def require_in_dictionary(dictionary: str, numbers: Iterable[int]) -> None:
    """Check that a marker dictionary contains marker numbers.

    Args:
        dictionary: Name of the marker dictionary, e.g. "4x4_50".
        numbers: Marker numbers, counted from 0.

    Raises:
        MarkerError: There is no such dictionary, or a number is not below its count of markers.
    """
    count = marker_family(dictionary).count
    for number in numbers:
        if number >= count:
            raise MarkerError(
                f"marker {number} is not in the dictionary '{dictionary}' of 0 to {count - 1}; "
                "correct the number or the dictionary"
            )


def require_apart(robot: MarkedRobot, floor: FloorMap) -> None:
    """Check that no floor marker has the number of the robot marker.

    Args:
        robot: Robot with its marker.
        floor: Map of the floor markers.

    Raises:
        MarkerError: A floor marker has the robot marker's number; detections are identified by
            number.
    """
    number = robot.marker.marker_id
    if number in floor.marker_ids:
        raise MarkerError(
            f"marker {number} is listed both for the robot and for the floor; remove it from "
            "floor.toml, or correct the robot's number (marker.id in robot.toml)"
        )
