# SPDX-License-Identifier: MIT
"""Assign the rows of a table to runs, and check their times."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.slip.law import Array
from zebro_lab.tables.mapped_columns import require_usual_steps
from zebro_lab.tables.rig_table import RigTable


@dataclass(frozen=True)
class Runs:
    """The runs of one table.

    Attributes:
        index: Index into `names` for every kept row, non-decreasing, shape (n,).
        names: Name of each run.
        rule: Description of the rule that separated the runs, for a note.
    """

    index: NDArray[np.intp]
    names: tuple[str, ...]
    rule: str


def separate_runs(table: RigTable, label: str) -> Runs:
    """Assign every kept row to a run by `[runs]`, else by the `run` column, else to a single run.

    Runs are found on all rows, before [rows] keep is applied, which therefore splits none in two.

    Args:
        table: The table, with the rule in its column map.
        label: Name of the table; prefix of every run's name.

    Raises:
        DataError: A column to separate by, or the time for `gap`, is missing or cannot be read.
    """
    rule, mapped_run = table.columns.runs, table.source_of("run")
    if rule.each_row:
        names = tuple(f"{label} row {row + 1}" for row in table.rows)
        return Runs(np.arange(len(names)), names, "each row is one run")
    if rule.gap is not None:
        starts = _after_pauses(table, rule.gap)
        return _named(table, starts, label, None, f"separated by pauses of over {rule.gap:g} s")
    by = rule.by or ((mapped_run.name,) if mapped_run else ())
    if by:
        starts = _at_changes(table, by)
        changes = f"separated by changes of {', '.join(map(repr, by))}"
        return _named(table, starts, label, by, changes)
    return Runs(np.zeros(len(table.rows), dtype=np.intp), (label,), "each file is one run")


def run_times(table: RigTable, runs: Runs) -> Array | None:
    """Return the time of every kept row, and check that it increases within each run.

    Args:
        table: Rig table.
        runs: Run of each kept row.

    Returns:
        Times, shape (n,) [s]; None if the table has no time column or every row is a trial.

    Raises:
        DataError: Time repeats or decreases within a run, is not a finite number, or is mapped to
            a header that the table lacks; or it is in no unit that is stated, and does not fit
            seconds.
    """
    if table.columns.runs.each_row or table.source_of("t") is None:
        return None
    time = table.si("t")
    step = np.diff(time, prepend=-np.inf)
    inside = np.diff(runs.index, prepend=-1) == 0
    advice = (
        f"if a new run begins here, state in {table.columns.stated_in} what separates runs, by one "
        'of [runs] by = ["COLUMN"] or, for a table of means of trials, each_row = true'
    )
    table.require(
        "t",
        ~inside | (step >= 0),
        lambda value: f"time goes back to {value}; sort the rows by time, or {advice}",
    )
    table.require(
        "t",
        ~inside | (step > 0),
        lambda value: f"time {value} repeats within a run; delete the copy, or {advice}",
    )
    source = table.required("t")
    if not (table.raw.path.is_dir() or source.unit_stated or table.raw.unit_of(source.name, "s")):
        require_usual_steps(table.raw, source.name, step[inside], "columns.t")
    return time


def _after_pauses(table: RigTable, gap: float) -> NDArray[np.bool_]:
    source = table.source_of("t")
    if source is None:
        problem = (
            "is missing, but [runs] gap needs times; map them in "
            f"{table.columns.stated_in}: [columns.t]"
        )
        raise table.raw.fault(problem, "t")
    time = source.in_si(table.raw)
    known = np.flatnonzero(np.isfinite(time))  # a row without time belongs to the run before it
    starts = np.zeros(len(time), dtype=bool)
    starts[known[1:][np.diff(time[known]) > gap]] = True
    return starts


def _at_changes(table: RigTable, names: tuple[str, ...]) -> NDArray[np.bool_]:
    import pandas as pd

    starts = np.zeros(len(table.raw), dtype=bool)
    for name in names:
        codes, _ = pd.factorize(table.raw.column(name))
        starts[1:] |= codes[1:] != codes[:-1]
    return starts


def _named(
    table: RigTable,
    starts: NDArray[np.bool_],
    label: str,
    by: tuple[str, ...] | None,
    rule: str,
) -> Runs:
    run_of_row = np.cumsum(starts)[table.rows]
    kept, index = np.unique(run_of_row, return_inverse=True)
    if by is None:
        return Runs(index, tuple(f"{label} run {k}" for k in range(1, len(kept) + 1)), rule)
    first = table.rows[np.searchsorted(run_of_row, kept)]
    columns = [table.raw.column(name).iloc[first] for name in by]
    names = [
        " ".join([label, *(f"{name}={_shown(cell)}" for name, cell in zip(by, cells, strict=True))])
        for cells in zip(*columns, strict=True)
    ]
    return Runs(index, _unique(names), rule)


def _shown(cell: object) -> str:
    return f"{cell:g}" if isinstance(cell, (int, float, np.number)) else str(cell)


def _unique(names: list[str]) -> tuple[str, ...]:
    """Append " (2)", " (3)", … to the second and later occurrences of a name."""
    seen: Counter[str] = Counter()
    unique = []
    for name in names:
        seen[name] += 1
        unique.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return tuple(unique)
