# SPDX-License-Identifier: MIT
"""Units that measurement programs state in settings above a header: LabVIEW and Motive."""

from collections.abc import Mapping, Sequence
from typing import Final

_LVM_END: Final = "***End_of_Header***"
_LVM_HEADERS: Final = 2  # of the file and of its segment
_LVM_TIME: Final = ("x_value", "x value")
_MOTIVE: Final = "Format Version"


class SeveralSegments(ValueError):
    """A LabVIEW measurement file has several segments; the text says what to do."""


def after_lvm_header(lines: Sequence[tuple[int, str]]) -> Sequence[tuple[int, str]]:
    """Return the lines below the last header of a LabVIEW measurement file; others as they are.

    Args:
        lines: Number and text of each line.

    Raises:
        SeveralSegments: There is more than one segment, each with a header of its own.
    """
    ends = [i for i, (_, line) in enumerate(lines) if line.strip().startswith(_LVM_END)]
    if len(ends) > _LVM_HEADERS:
        raise SeveralSegments(
            "has several segments of measurement, each with a header; that of the second ends in "
            f"line {lines[ends[_LVM_HEADERS]][0]}: make a file of each"
        )
    return lines[ends[-1] + 1 :] if ends else lines


def stated_units(settings: Sequence[Sequence[str]], names: Sequence[str]) -> Mapping[str, str]:
    """Return the units that settings above a header state, by header.

    Those of LabVIEW stand in `Y_Unit_Label`, each in the column of its channel; a column of times
    is the first, or before each channel. That of Motive is one of all positions, `Length Units`.

    Args:
        settings: Cells of each line above the header.
        names: Header of each column.

    >>> stated_units([["Y_Unit_Label", "N"], ["X_Dimension", "Time"]], ["X_Value", "Fz", "Comment"])
    {'Fz': 'N', 'X_Value': 's'}
    >>> stated_units([["Format Version", "1.23", "Length Units", "Meters"]], ["Time", "Position X"])
    {'Position X': 'meters'}
    """
    lines = {cells[0]: list(cells[1:]) for cells in settings if len(cells) > 1}
    if _MOTIVE in lines and "Length Units" in lines[_MOTIVE][:-1]:
        unit = lines[_MOTIVE][lines[_MOTIVE].index("Length Units") + 1].casefold()
        return {name: unit for name in names if "Position" in name.split()}
    if "Y_Unit_Label" not in lines:
        return {}
    times = [name for name in names if name.casefold().startswith(_LVM_TIME)]
    labels = {name: unit for name, unit in zip(names[1:], lines["Y_Unit_Label"], strict=False)
              if unit and name not in times}  # fmt: skip
    in_time = lines.get("X_Dimension", [""])[0].casefold() == "time"
    return {**labels, **(dict.fromkeys(times, "s") if in_time else {})}
