# SPDX-License-Identifier: MIT
"""Guess the canonical columns of a table from its header and numbers."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from model.slip.law import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.units import is_unit_of
from zebro_lab.tables.columns import CANONICAL
from zebro_lab.tables.raw_table import RawTable

_NAMES: Mapping[str, str] = MappingProxyType({
    "t": r"t|et|time|elapsed_time|timestamp|zeit|seconds",
    "omega_leg": r"(omega|w|speed|rate)_?(l|leg|leg_disc|wheel)",
    "omega_ground": r"(omega|w|speed|rate)_?(g|ground|ground_disc|table)",
    "radius_leg": r"(radius|r)_(l|leg)",
    "radius_ground": r"(radius|r)_(g|ground)",
    "slip_ratio": r"(kappa|slip)(_?(ratio|inst|long|x))?|sl|sr|longitudinal_slip",
    "normal_force": r"(avg_|mean_)?(fn|fz|f_n|f_z|load|normal|(normal|vertical)_?(force|load))",
    "traction_force":
        r"(avg_|mean_)?(ft|fx|f_t|f_x|(traction|tangential|longitudinal|friction)(_?force)?)",
    "run": r"run(_?(id|nr|no|number))?",
    "slip_definition": r"slip_definition",
})  # fmt: skip
_BRACKETED = re.compile(r"(?P<name>.*?)[\s_]*[\[(](?P<unit>[^\])]*)[\])]\s*")
_SUFFIXES = {"_rad_s": "rad/s", "_rpm": "rpm", "_ms": "ms", "_s": "s", "_kn": "kN", "_n": "N",
             "_mm": "mm", "_m": "m"}  # fmt: skip
_MOST_SET_POINTS = 200


@dataclass(frozen=True)
class ColumnGuess:
    """Guessed column of a file for a canonical column.

    Attributes:
        name: Header in the file.
        unit: Unit parsed from the header; None without a unit that fits the canonical column.
        negative: Whether the median of the column's numbers is negative.
        others: Other headers that match the canonical column, in the table's order.
    """

    name: str
    unit: str | None
    negative: bool
    others: tuple[str, ...]


def guess_columns(table: RawTable) -> dict[str, ColumnGuess]:
    """Guess which column of a table holds each canonical column, by canonical name.

    Columns are matched by their headers, each at most once; the numbers only determine the sign.
    Of several matches the header that is the canonical name is taken, else the first in the table.
    Canonical columns without a match are omitted.
    """
    guesses: dict[str, ColumnGuess] = {}
    taken: set[str] = set()
    for canonical in CANONICAL:
        fitting = [n for n in table.columns if n not in taken and _fits(n, canonical)]
        fitting.sort(key=lambda name: name != canonical)
        if fitting:
            name, *others = fitting
            taken.add(name)
            numbers = numbers_or_none(table, name)
            negative = numbers is not None and bool(np.nanmedian(numbers) < 0)
            guesses[canonical] = ColumnGuess(name, _unit(name, canonical), negative, tuple(others))
    return guesses


def guess_set_points(table: RawTable) -> list[str]:
    """Return headers of set-point columns: numbers that change, but at less than 10 % of the rows.

    Columns with an empty cell, or with `_MOST_SET_POINTS` changes or more, are left out.
    """
    found = []
    for name in table.columns:
        numbers = numbers_or_none(table, name)
        if numbers is None or np.isnan(numbers).any():
            continue
        changes = int(np.count_nonzero(np.diff(numbers)))
        if 0 < changes < min(_MOST_SET_POINTS, len(numbers) // 10):
            found.append(name)
    return found


def numbers_or_none(table: RawTable, name: str) -> Array | None:
    """Return the numbers of a column; None if it cannot be read as numbers.

    Args:
        table: Table that has the column.
        name: Header of the column.

    Returns:
        Values by row, shape (n,), in the file's unit; None also if none is finite.
    """
    try:
        numbers = table.numbers(name)
    except DataError:
        return None
    return numbers if np.isfinite(numbers).any() else None


def _fits(header: str, canonical: str) -> bool:
    bare, _ = _without_unit(header)
    return bare == canonical or re.fullmatch(_NAMES[canonical], bare) is not None


def _unit(header: str, canonical: str) -> str | None:
    _, unit = _without_unit(header)
    si_unit = CANONICAL[canonical].unit
    return unit if unit and si_unit and is_unit_of(unit, si_unit) else None


def _without_unit(header: str) -> tuple[str, str | None]:
    """Split a header, `FZ [N]` or `t_ms`, into a lower-case name and a unit; None without one.

    Blanks, points and hyphens of the name become underscores.
    """
    if match := _BRACKETED.fullmatch(header):
        return _plain(match["name"]), match["unit"].strip()
    plain = _plain(header)
    for suffix, unit in _SUFFIXES.items():
        if plain.endswith(suffix) and plain not in CANONICAL:
            return plain.removesuffix(suffix), unit
    return plain, None


def _plain(name: str) -> str:
    return re.sub(r"[\s.\-]+", "_", name.strip().casefold())
