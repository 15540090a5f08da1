# SPDX-License-Identifier: MIT
"""Which markers a dictionary has, and that no two things wear the same one."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from tracking.detect import Robot
from tracking.errors import MarkerError
from tracking.floor import FloorMap
from tracking.markers import dictionary_named, find_markers, guess_dictionary


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


def require_apart(robot: Robot, floor: FloorMap) -> None:
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


def strangers(pixels: NDArray[np.uint8], robot: Robot, floor: FloorMap) -> str | None:
    """Say which markers a photograph shows that are not the floor's.

    For the message when the robot's is nowhere: another number or dictionary is the commonest
    reason.

    Args:
        pixels: The photograph.
        robot: The robot.
        floor: The floor's marks.
    """
    names = (robot.marker.dictionary, floor.dictionary, guess_dictionary(pixels))
    for dictionary in dict.fromkeys(name for name in names if name is not None):
        numbers = range(len(dictionary_named(dictionary).bytesList))
        found = {s.marker_id for s in find_markers(pixels, dictionary, wanted=numbers, effort=0)}
        if dictionary == floor.dictionary:
            found -= set(floor.marker_ids)
        if found:
            return f"{', '.join(map(str, sorted(found)))} of '{dictionary}'"
    return None
