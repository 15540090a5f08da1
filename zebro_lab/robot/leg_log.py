# SPDX-License-Identifier: MIT
"""Measured leg angles: a table with a time and six angles, checked and unwrapped."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.gait.reference import SampledReference
from model.robot import N_LEGS
from zebro_lab.files.errors import DataError
from zebro_lab.robot.leg_gaps import bridged_gaps
from zebro_lab.tables.columns import COLUMNS_FILE, Columns
from zebro_lab.tables.raw_table import RawTable

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
        """The `columns.toml` that was read; None without one."""
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
        DataError: A column or value is missing, there are fewer than two rows, time does not
            increase or has a gap that `bridged_gaps` refuses, or a leg turns by more than 2.5 rad
            between samples, or by more than pi/2 where angles are wrapped to one turn, or jumps by
            more than a turn; names the cell.
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
    return columns.numbers(table, name, what=f"angle of leg {name[-1]}", advice=_ADVICE)


def _require_unwrapped(table: RawTable, columns: Columns, raw: Array, theta: Array) -> None:
    """Check that unwrapping is not ambiguous: short steps, but for jumps by one turn."""
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
    rate = (len(t) - 1) / (t[-1] - t[0])
    notes = [f"leg log: {len(t)} samples over {t[-1] - t[0]:.4g} s, about {rate:.4g} Hz"]
    if np.any(raw != theta):
        notes.append("leg log: angles were wrapped to one turn and have been unwrapped")
    return notes
