# SPDX-License-Identifier: MIT
"""The printed robot marker: dictionary, number and size."""

from dataclasses import dataclass

from zebro_lab.files.errors import SettingsError
from zebro_lab.files.units import option_to_si

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
        """The marker as "DICTIONARY:NUMBER:SIDE" with the side in mm, as `parse_marker` reads.

        >>> MarkerPrint().text
        '4x4_50:0:120mm'
        """
        return f"{self.dictionary}:{self.number}:{1e3 * self.side:.12g}mm"


KIT_PRINT = MarkerPrint()
"""The robot marker of the printed kit."""


def parse_marker(text: str) -> MarkerPrint:
    """Parse a marker written as "DICTIONARY:NUMBER:SIDE"; a side without a unit is in m.

    Raises:
        SettingsError: The string has another form, NUMBER is not a whole number, or the side is not
            a length above 0 or, without a unit, above `LARGEST_PRINT`.

    >>> parse_marker("apriltag_36h11:4:10cm")
    MarkerPrint(dictionary='apriltag_36h11', number=4, side=0.1)
    """
    parts = text.rsplit(":", 2)
    if len(parts) != 3 or not parts[1].isdigit():
        raise SettingsError(
            f"found '{text}'; expected DICTIONARY:NUMBER:SIDE such as {KIT_PRINT.text}",
            key="--marker",
        )
    side = option_to_si(parts[2], "m", key="--marker", usual=LARGEST_PRINT)
    if side <= 0:
        raise SettingsError(f"found '{text}'; expected a side above 0", key="--marker")
    return MarkerPrint(parts[0], int(parts[1]), side)
