# SPDX-License-Identifier: MIT
"""The printed robot marker: dictionary, number and size."""

from dataclasses import dataclass

LARGEST_PRINT = 3.0
"""Largest length of a marker or of a robot's top that is believed without a unit [m]."""


@dataclass(frozen=True)
class MarkerPrint:
    """A printed marker; the defaults are those of the printed kit.

    Attributes:
        dictionary: Name of the marker dictionary.
        number: Number of the marker in the dictionary, counted from 0.
        side: Side of the marker's black square [m].
    """

    dictionary: str = "4x4_50"
    number: int = 0
    side: float = 0.12

    @property
    def text(self) -> str:
        """The marker as "DICTIONARY:NUMBER:SIDE" with the side in mm.

        >>> MarkerPrint().text
        '4x4_50:0:120mm'
        """
        return f"{self.dictionary}:{self.number}:{1e3 * self.side:.12g}mm"


KIT_PRINT = MarkerPrint()
"""The robot marker of the printed kit."""
