# SPDX-License-Identifier: MIT
"""Join messages that hold some of the legs each to rows of all legs."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.robot.leg_gaps import WIDEST
from zebro_lab.tables.raw_table import RawTable


def joined_readings(table: RawTable, turns: Mapping[str, float]) -> RawTable:
    """Return one row of all legs for each reading of the leg that has the fewest.

    Readings of the other legs are interpolated in time, between two of the same leg. A table with a
    row of all legs is returned as it is: what is missing in others is a fault of theirs.

    Args:
        table: A row per message, `t` [s], NaN where a message does not hold a leg.
        turns: Value of a whole turn of each leg, by its header, in the unit of the column.

    Raises:
        DataError: Stamps of a leg do not increase, or a row lies in a gap of a leg's readings, of
            over 5 of its median steps; or the direction of a wrapped leg is ambiguous.
    """
    angles = {name: table.columns[name].to_numpy(dtype=float) for name in turns}
    known = {name: ~np.isnan(values) for name, values in angles.items()}
    few = min(rows.sum() for rows in known.values()) < 2
    if few or np.all(list(known.values()), axis=0).any():
        return table
    t = table.columns["t"].to_numpy(dtype=float)
    rarest = min(turns, key=lambda name: known[name].sum())
    at = t[known[rarest]]
    begin = max(t[rows].min() for rows in known.values())
    at = at[(at >= begin) & (at <= min(t[rows].max() for rows in known.values()))]
    columns: dict[str, pd.Series] = {"t": pd.Series(at)}
    for name, rows in known.items():
        _require_near(table, name, t[rows], at)
        own = _unwrapped(table, name, angles[name][rows], turns[name])
        columns[name] = pd.Series(np.interp(at, t[rows], own))
    note = (
        f"{table.path.name}: messages hold some of the legs each; they are joined at the "
        f"{len(at)} times of {rarest}, the other legs interpolated between their own readings"
    )
    return replace(table, columns=columns, notes=(*table.notes, note))


def _require_near(table: RawTable, name: str, t: Array, at: Array) -> None:
    """Check that the times of rows lie in no gap of a leg's times `t` [s]."""
    steps = np.diff(t)
    if np.any(steps <= 0):
        raise DataError(
            f"the stamps of {name} do not increase; expected its messages in the order of their "
            "stamps, each once: record them again",
            file=table.path,
        )
    later = np.clip(np.searchsorted(t, at), 1, len(t) - 1)
    wide = np.flatnonzero(steps[later - 1] > WIDEST * np.median(steps))
    if len(wide):
        begin = t[later[wide[0]] - 1]
        raise DataError(
            f"messages hold some of the legs each, and {name} has no reading for "
            f"{steps[later[wide[0]] - 1]:.3g} s, from {begin - t[0]:.3f} s after its first; "
            f"expected at most {WIDEST:g} times the usual {np.median(steps):.4g} s: cut the bag "
            "there, and use each part alone",
            file=table.path,
        )


def _unwrapped(table: RawTable, name: str, values: Array, turn: float) -> Array:
    """Return a leg's readings without jumps by a turn, which are refused where ambiguous."""
    whole = np.unwrap(values, period=turn)
    wrapped = np.abs(np.diff(values)).max() > turn / 2
    if wrapped and np.abs(np.diff(whole)).max() > turn / 4:
        raise DataError(
            f"{name} turns by more than a quarter between two of its messages, or jumps by one "
            "turn; expected less where angles are wrapped, since its direction is ambiguous: check "
            "the unit of the angles, or publish them at a higher rate",
            file=table.path,
        )
    return whole
