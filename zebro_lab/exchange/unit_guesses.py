# SPDX-License-Identifier: MIT
"""Find the unit of a column: stated by the file, or guessed and then in doubt."""

import re
from dataclasses import dataclass
from typing import Final

import numpy as np

from zebro_lab.exchange.column_names import plain_name
from zebro_lab.files.errors import DataError
from zebro_lab.files.units import is_unit_of, may_be_gradian
from zebro_lab.tables.cells import kind_of
from zebro_lab.tables.date_cells import CLOCK
from zebro_lab.tables.raw_table import RawTable

_MEANT: Final = {
    ("Hz", "rad/s"): "rev/s", ("1/s", "rad/s"): "rad/s", ("kg", "N"): "kgf", ("g", "N"): "gf",
    ("lb", "N"): "lbf", ("lbs", "N"): "lbf", ("grad", "rad"): "deg", ("pix", "m"): "mm",
}  # fmt: skip
"""What a unit that measures another quantity probably means, by unit and SI unit."""
_EPOCH: Final = ((1e17, "ns"), (1e14, "us"), (1e11, "ms"))
"""Units of times since 1970, by the least number that a time of our days has in them."""
_CLOCKS: Final = {"millis": "ms", "micros": "us"}  # named by functions of Arduino
_RATIO: Final = 1.5  # a slip ratio beyond is a percentage
_RADIANS: Final = 90.0  # an angle beyond is probably in degrees
_ZONE = re.compile(r".*(Z|[+-]\d\d:?\d\d)")


@dataclass(frozen=True)
class UnitGuess:
    """Unit of a column.

    Attributes:
        unit: The unit as `columns.toml` has it.
        doubt: Why it is not sure; "" if it is.
    """

    unit: str
    doubt: str


def guess_unit(table: RawTable, name: str, si_unit: str, *, si: bool) -> UnitGuess:
    """Find the unit of a column: the one that the file states if it fits, else a doubtful guess.

    A stated unit that measures another quantity is replaced by what it probably means (`_MEANT`).
    Without a stated unit, header and largest number decide.

    Args:
        table: The table.
        name: Header of the column.
        si_unit: SI unit of the canonical column.
        si: Whether a column of this name is in SI where the file states nothing else.
    """
    if si_unit == "s" and (date := _date_unit(table, name)):
        return date
    stated = table.units.get(name) if si else table.unit_of(name, si_unit)
    if stated is not None and not may_be_gradian(stated) and is_unit_of(stated, si_unit):
        return UnitGuess(stated, "")
    if stated is not None:
        meant = _MEANT.get((stated.strip().casefold(), si_unit)) or _MEANT.get((stated, si_unit))
        factor = "" if meant else f"; scale = NUMBER below, if 1 {stated} is NUMBER {si_unit}"
        return UnitGuess(meant or si_unit, f"the file says '{stated}'{factor}")
    if si:
        return UnitGuess(si_unit, "")
    return UnitGuess(_by_numbers(table, name, si_unit), "the file states none")


def _date_unit(table: RawTable, name: str) -> UnitGuess | None:
    """Return the unit of a column of dates or times of day by its first cell; else None.

    A time of day is "h:m:s", a date with a time zone "date", one without "date UTC", in doubt.
    """
    cells = table.columns[name].dropna()
    if not len(cells) or cells.dtype.kind in "if":
        return None
    first = cells.iloc[0]
    if cells.dtype.kind == "M" or hasattr(first, "isoformat"):
        zoned = getattr(first, "tzinfo", None) is not None
    elif kind_of(str(first)) != "value" or re.fullmatch(r"[-+]?[\d.,eE+-]+", str(first)):
        return None
    elif re.fullmatch(r"\d+:\d\d.*", str(first)):
        return UnitGuess(CLOCK, "")
    else:
        zoned = _ZONE.fullmatch(str(first)[10:]) is not None  # after YYYY-MM-DD
    return UnitGuess("date", "") if zoned else UnitGuess("date UTC", "the file has no time zone")


def _by_numbers(table: RawTable, name: str, si_unit: str) -> str:
    """Guess the unit of a column for which the file states none, from header and largest number.

    An angular speed is in rpm if the header has rpm or Drehzahl, a time in ms or us if the header
    is in `_CLOCKS`. Times of 1e11 and more count ms, us or ns since 1970; a ratio above `_RATIO` is
    in percent, an angle above `_RADIANS` in degrees. All else is in SI.
    """
    plain = plain_name(name)
    if si_unit == "rad/s":
        return "rpm" if re.search(r"rpm|drehzahl", plain) else si_unit
    try:
        numbers = table.numbers(name)
    except DataError:
        return si_unit
    largest = float(np.nanmax(np.abs(numbers), initial=0.0))
    if si_unit == "s" and plain in _CLOCKS:
        return _CLOCKS[plain]
    if si_unit == "s":
        return next((unit for least, unit in _EPOCH if largest >= least), si_unit)
    if si_unit == "dimensionless" and largest > _RATIO:
        return "%"
    return "deg" if si_unit == "rad" and largest > _RADIANS else si_unit
