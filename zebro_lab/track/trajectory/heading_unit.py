# SPDX-License-Identifier: MIT
"""Find headings that are taken for radians but fit their path in degrees."""

from typing import Final

import numpy as np

from model.arrays import Array
from model.poses import Poses
from model.travel import has_travelled, travel_direction

_FITS: Final = 0.9
"""Alignment of heading and travel above which a unit fits the path [-]."""
_CLEARLY: Final = 5.0
"""Factor by which radians must lack more alignment than degrees do [-].

Degrees that grow by 6 to 7 from pose to pose are nearly whole turns as radians, and align well too.
"""
_LEAST: Final = 0.05
"""Alignment that radians must lack at least [-]: a heading that stays fits in both units."""


def are_degrees(heading: Array, position: Array) -> bool:
    """Return whether headings above 2 pi fit the direction of travel in degrees alone.

    The alignment is the length of the mean of unit vectors at heading minus direction of travel:
    1 where they differ by a constant, about 0 where they have nothing to do with one another.

    Args:
        heading: Headings as in the file, shape (n,).
        position: Positions in the plane, shape (n, 2) [m].
    """
    if len(heading) == 0 or np.abs(heading).max() <= 2 * np.pi:
        return False
    poses = Poses(np.arange(len(heading), dtype=float), position, heading)
    if not has_travelled(poses):
        return False
    travel = travel_direction(poses)
    in_radians, in_degrees = (
        np.abs(np.exp(1j * (each - travel)).mean()) for each in (heading, np.radians(heading))
    )
    return bool(in_degrees > _FITS and 1 - in_radians > _CLEARLY * (1 - in_degrees) + _LEAST)
