# SPDX-License-Identifier: MIT
"""Which markers a dictionary has, and that no two things wear the same one."""

from collections.abc import Iterable

from tracking.detect import MarkedRobot
from tracking.errors import MarkerError
from tracking.floor import FloorMap
from tracking.markers import dictionary_named


def require_in_dictionary(dictionary: str, numbers: Iterable[int]) -> None:
    """Refuse markers that a dictionary does not have.

    Args:
        dictionary: Its name.
        numbers: Numbers of markers.

    Raises:
        MarkerError: There is no such dictionary, or it has fewer markers.
    """
    count = len(dictionary_named(dictionary).bytesList)
    for number in numbers:
        if number >= count:
            raise MarkerError(
                f"number {number} is not in '{dictionary}', whose markers are 0 to {count - 1}"
            )


def require_apart(robot: MarkedRobot, floor: FloorMap) -> None:
    """Refuse a robot whose marker has the number of one of the floor's.

    Raises:
        MarkerError: It has; sightings are told apart by number.
    """
    number = robot.marker.marker_id
    if number in floor.marker_ids:
        raise MarkerError(
            f"marker {number} is the robot's and one of the floor's; take the one that is not laid "
            "out of floor.toml, or correct the robot's number (id in robot.toml, --marker)"
        )
