# SPDX-License-Identifier: MIT
"""Measured leg angles: a table with a time and six angles, checked and unwrapped."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.format_distinct import format_distinct
from model.gait.reference import SampledReference
from model.robot import N_LEGS
from zebro_lab.files.errors import DataError
from zebro_lab.tables.columns import COLUMNS_FILE, Columns
from zebro_lab.tables.raw_table import RawTable

WIDEST: Final = 5.0
"""Longest step of time that is not a gap [median steps]."""
LONGEST_BRIDGED: Final = 0.25
"""Longest gap that is bridged: in more time a leg may swing and come to rest unseen [s]."""
_BESIDE: Final = 0.1  # s before and after a gap, of which the legs' speeds are taken
_FEWEST: Final = 3  # samples there
_APART: Final = 0.15
"""Largest distance of the angle behind a gap from that at an unchanged speed [rad].

Two counts of an encoder of 100 a turn; a leg that begins or ends its swing in 0.1 s is further off.
"""


def bridged_gaps(
    table: RawTable, column: str, t: Array, theta: Array, *, advice: str
) -> tuple[str, ...]:
    """Check the gaps of a leg log, and return a note on each that is bridged by straight lines.

    A step of time is a gap if it is longer than `WIDEST` median steps. It is bridged if it lasts at
    most `LONGEST_BRIDGED`, and the angle of every leg behind it is, within `_APART`, what the leg
    reaches at its speed before the gap, and also at its speed after it.

    Args:
        table: Table of the log.
        column: Name of its column of times.
        t: Times, increasing, shape (n,) [s].
        theta: Unwrapped angles, shape (n, 6) [rad].
        advice: What to do about a gap that is not bridged.

    Raises:
        DataError: A gap is longer, or a leg changes its speed in it; names the row.
    """
    steps = np.diff(t)
    usual = float(np.median(steps))
    gaps = np.flatnonzero(steps > WIDEST * usual)
    notes = []
    for at in gaps:
        before, now = format_distinct(t[at], t[at + 1])
        if why := _why_not(t, theta, int(at), gaps):
            raise table.fault(
                f"time jumps from {before} to {now} s, and {why}; expected at most {WIDEST:g} "
                f"times the usual {usual:.4g} s, or {LONGEST_BRIDGED:g} s in which every leg keeps "
                f"its speed: {advice}",
                column,
                int(at) + 1,
            )
        notes.append(
            f"WARNING: leg log: no samples from {before} to {now} s; every leg keeps its speed, "
            "and straight lines bridge this gap"
        )
    return tuple(notes)


def _why_not(t: Array, theta: Array, at: int, gaps: NDArray[np.intp]) -> str | None:
    """Return why the gap after sample `at` is not bridged; None if it is, see `bridged_gaps`.

    The speeds are those over `_BESIDE` before and after the gap, where there must be `_FEWEST`
    samples each and no other of `gaps`, the samples before each gap.
    """
    length = t[at + 1] - t[at]
    if length > LONGEST_BRIDGED:
        return f"that is {length:.3g} s"
    first = np.searchsorted(t, t[at] - _BESIDE - 1e-9)  # rounding must not leave out a sample
    last = np.searchsorted(t, t[at + 1] + _BESIDE + 1e-9) - 1
    if at - first < _FEWEST - 1 or last - at - 1 < _FEWEST - 1:
        return "too few samples beside it tell the legs' speeds"
    if np.any((gaps != at) & (gaps >= first) & (gaps < last)):
        return "another gap is too near to tell the legs' speeds"
    turned = theta[at + 1] - theta[at]
    before = (theta[at] - theta[first]) / (t[at] - t[first])
    after = (theta[last] - theta[at + 1]) / (t[last] - t[at + 1])
    off = np.abs(np.stack([before, after]) * length - turned).max(axis=0)
    if off.max() > _APART:
        return f"leg {int(off.argmax()) + 1} changes its speed in that time"
    return None


ANGLES = tuple(f"theta{leg}" for leg in range(1, N_LEGS + 1))
LEG_UNITS: Mapping[str, str] = {"t": "s", **dict.fromkeys(ANGLES, "rad")}
LONGEST_TURN = 2.5  # rad between samples; from pi on the direction of rotation is ambiguous
_ADVICE = (
    "fill in the cell, delete rows in which no leg has an angle, or all up to it or from it on"
)
LONGEST_WRAPPED = np.pi / 2  # the same where a whole turn may have been cut off between samples


@dataclass(frozen=True)
class LegLog:
    """Measured leg angles.

    Attributes:
        reference: Angles of the six legs over time [rad], unwrapped, with the canonical sign.
        source: Source as stated, such as "real" or "sim:what"; "unknown" if not stated.
        files: Every file read, the column map last, if there is one.
        notes: Notes, one line each.
    """

    reference: SampledReference
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()

    @property
    def columns_file(self) -> Path | None:
        """The `columns.toml` that was read; None without one, or if it has another name."""
        return next((file for file in self.files if file.name == COLUMNS_FILE), None)


def legs_of_table(
    table: RawTable,
    mapping: Columns,
    *,
    files: Sequence[Path],
    leg_sign: Sequence[int] = (1,) * N_LEGS,
    mending: str = "split the file before this row, use each part alone",
) -> LegLog:
    """Check and unwrap the leg angles of a table.

    Args:
        table: Table with a time and six leg angles.
        mapping: Column map with the canonical names of `LEG_UNITS`.
        files: Files that the table was read from.
        leg_sign: Factor 1 or -1 for the angle of each leg, shape (6,).
        mending: What to do about a gap that cannot be bridged, for the message.

    Raises:
        DataError: A column or value is missing, there are fewer than two rows, time does not fit
            seconds though no unit is stated, does not increase or has a gap that `bridged_gaps`
            refuses, or a leg turns by more than 2.5 rad between samples, or by more than pi/2 where
            angles are wrapped to one turn, or jumps by more than that on top of one turn; names the
            cell.
    """
    t = mapping.times(table, "t", advice=_ADVICE)
    angles = [_angle(table, name, mapping) for name in ANGLES]
    time_column = mapping.mapped["t"].name
    if len(t) < 2:
        raise DataError(f"has {len(t)} row; expected two or more rows", file=files[0])
    table.require_increasing(time_column, t)
    raw = np.column_stack(angles) * np.asarray(leg_sign, dtype=float)
    theta = np.unwrap(raw, axis=0)
    bridged = bridged_gaps(table, time_column, t, theta, advice=mending)
    _require_unwrapped(table, mapping, raw, theta)
    return LegLog(
        SampledReference(t, theta),
        source=mapping.source or table.source or "unknown",
        files=(*files, *([mapping.file] if mapping.file else [])),
        notes=(*table.notes, *mapping.conversions(table), *bridged, *_notes(t, raw, theta)),
    )


def _angle(table: RawTable, name: str, columns: Columns) -> Array:
    """Return a leg's angle by its canonical name, finite throughout, shape (n,) [rad]."""
    return columns.numbers(table, name, what=f"angle of leg {name[-1]}", advice=_ADVICE)


def _require_unwrapped(table: RawTable, columns: Columns, raw: Array, theta: Array) -> None:
    """Check that unwrapping the angles is not ambiguous.

    Raises:
        DataError: A leg turns by more than `LONGEST_TURN` between samples; or, where angles of any
            leg are wrapped to one turn, by more than `LONGEST_WRAPPED`; or it jumps by more than
            that on top of one turn. Names the cell.
    """
    jumps, turns = np.abs(np.diff(raw, axis=0)), np.abs(np.diff(theta, axis=0))
    wrapped = bool((jumps > np.pi).any())
    most = LONGEST_WRAPPED if wrapped else LONGEST_TURN
    bad = (turns > most) | (jumps > 2 * np.pi + most)
    if not bad.any():
        return
    row, leg = (int(i[0]) for i in np.nonzero(bad))
    found = jumps[row, leg] if jumps[row, leg] > 2 * np.pi + most else turns[row, leg]
    turn = ", or a jump by one turn, since these angles are wrapped" if wrapped else ""
    raise table.fault(
        f"leg {leg + 1} turns by {found:.3g} rad between two samples; expected at most "
        f"{most:.3g} rad{turn}; else its direction is ambiguous: check the unit of the angles (are "
        "they degrees or counts?), or record at a higher rate",
        columns.mapped[ANGLES[leg]].name,
        row + 1,
    )


def _notes(t: Array, raw: Array, theta: Array) -> list[str]:
    """Return a note on number, duration and rate of samples, and one if angles were unwrapped."""
    rate = (len(t) - 1) / (t[-1] - t[0])
    notes = [f"leg log: {len(t)} samples over {t[-1] - t[0]:.4g} s, about {rate:.4g} Hz"]
    if np.any(raw != theta):
        notes.append("leg log: angles were wrapped to one turn and have been unwrapped")
    return notes
