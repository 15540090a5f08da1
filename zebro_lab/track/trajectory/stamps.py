# SPDX-License-Identifier: MIT
"""Time stamps of trajectories: their unit, repeated and unsorted ones."""

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.files.errors import DataError, UnitError
from zebro_lab.files.units import factor_to_si

Fault = Callable[[str, int], DataError]
UNITS: Final = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_SINCE_1970: Final = (6.3e8, 4.2e9)
"""Seconds since 1970 of the years 1990 to 2102: no other unit has such numbers for these years."""
_MOST_REPEATED: Final = 0.01
"""Largest share of rows that repeat a stamp with another pose; beyond, stamps are too coarse."""
_GAPS: Final = (1e-6, 1e4)
"""Range of the median time between poses; outside the unit cannot be right [s]."""


def stamp_factor(t: Array, unit: str, *, fault: Fault) -> tuple[float, tuple[str, ...]]:
    """Return the factor that converts stamps to seconds, and a note if it is not the unit expected.

    Stamps that are times since 1970 in one of `UNITS` say so by their size.

    Args:
        t: Stamps, shape (n,).
        unit: Unit that header or layout state.
        fault: Makes an error that names a row, counted from 0.

    Raises:
        DataError: The unit is none of time, or poses are hours, or less than a microsecond, apart,
            so that it must be another.
    """
    try:
        stated = factor_to_si(unit, "s")
    except UnitError as error:
        raise fault(f"{error}; correct the header", 0) from error
    low, high = _SINCE_1970
    for name, factor in UNITS.items():
        if low <= float(np.abs(t).max()) * factor <= high:
            note = f"stamps are read as times since 1970 in {name}"
            return factor, () if factor == stated else (note,)
    gap = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    if gap and not _GAPS[0] < abs(gap) * stated < _GAPS[1]:
        raise fault(
            f"stamps are {gap:g} {unit} apart, if they are in {unit}; convert them, or name their "
            "unit in a header such as 'timestamp [ms]'",
            0,
        )
    return stated, ()


def kept_stamps(
    t: Array, poses: Array, *, fault: Fault
) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    """Return the rows to keep, the first of each stamp, and notes on those that are left out.

    Args:
        t: Stamps, shape (n,) [s].
        poses: Numbers of each pose, shape (n, columns).
        fault: Makes an error that names a row, counted from 0.

    Raises:
        DataError: A stamp is earlier than the one before, or more than one in a hundred rows repeat
            a stamp with another pose; names both rows and their stamps.
    """
    step = np.diff(t)
    if np.any(step < 0):
        at = int(np.argmax(step < 0)) + 1
        raise fault(
            f"the stamp {float(t[at])!r} s is earlier than {float(t[at - 1])!r} s of row {at}; "
            "expected increasing stamps: sort the rows by time, or, if another recording begins "
            "here, make a file of each",
            at,
        )
    same = np.concatenate([[False], step == 0])
    differing = np.concatenate([[False], np.any(np.diff(poses, axis=0) != 0, axis=1)])
    equal, other = same & ~differing, np.flatnonzero(same & differing)
    if len(other) > _MOST_REPEATED * len(t) + 1:
        raise fault(
            f"{_repeated(t, poses, other[0])}, as in {len(other)} rows; expected increasing "
            "stamps: write them with more digits",
            int(other[0]),
        )
    notes = (f"{equal.sum()} rows repeat the row before and are left out",) if equal.any() else ()
    named = [f"row {at + 1}: {_repeated(t, poses, at)}; row {at} is kept" for at in other[:3]]
    more = len(other) - len(named)
    return np.flatnonzero(~same), (
        *notes,
        *named,
        *([f"more rows with such stamps: {more}"] if more else []),
    )


def _repeated(t: Array, poses: Array, at: int) -> str:
    """Say how a row, counted from 0, differs from the one before, which has the same stamp."""
    column = int(np.argmax(poses[at] != poses[at - 1]))
    before, now = float(poses[at - 1, column]), float(poses[at, column])
    return (
        f"the stamp {float(t[at])!r} s is that of row {at}, with another pose (number {column + 2} "
        f"is {now!r}, there {before!r})"
    )
