# SPDX-License-Identifier: MIT
"""Assign the rows of a table to runs, and check their times."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.tables.header_rows import unique_names
from zebro_lab.tables.rig_table import RigTable

ONE_RUN = "each file is one run"


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
    """Assign every kept row to a run.

    By `[runs]` in the column map either every row is a run (`each_row`), or a run starts after each
    pause (`gap`), or wherever a value in one of the columns `by` changes; values that come back
    later start another run. Without a rule, a run starts at each change in the `run` column, and
    without that column all rows are one run. Starts are found on all rows before [rows] keep is
    applied, so that leaving out rows splits no run in two.

    Args:
        table: The table, with the rule in its column map.
        label: Name of the table; prefix of every run's name.

    Raises:
        DataError: A column to separate by, or the time for `gap`, is missing or cannot be read.
    """
    if table.columns.runs.each_row:
        names = tuple(f"{label} row {row + 1}" for row in table.rows)
        return Runs(np.arange(len(names)), names, "each row is one run")
    starts, by, rule = run_starts(table)
    number = np.cumsum(starts)[table.rows]
    kept, index = np.unique(number, return_inverse=True)
    first = table.rows[np.searchsorted(number, kept)]
    return Runs(index, run_names([run_title(table, row, by) for row in first], label, rule), rule)


def run_starts(table: RigTable) -> tuple[NDArray[np.bool_], tuple[str, ...], str]:
    """Mark the rows at which a run begins, among all rows; the first row is not marked.

    Args:
        table: The table, whose column map has another rule than `each_row`.

    Returns:
        Whether a run begins at each row, shape (n,); headers of the columns whose changes begin
        runs; and the rule in words.

    Raises:
        DataError: As `separate_runs`.
    """
    rule, mapped_run = table.columns.runs, table.source_of("run")
    if rule.gap is not None:
        return _after_pauses(table, rule.gap), (), f"separated by pauses of over {rule.gap:g} s"
    by = rule.by or ((mapped_run.name,) if mapped_run else ())
    if by:
        changes = f"separated by changes of {', '.join(map(repr, by))}"
        return _at_changes(table, by), by, changes
    return np.zeros(len(table.raw), dtype=bool), (), ONE_RUN


def run_title(table: RigTable, row: int, by: Sequence[str]) -> str:
    """Return what columns say of a run, such as "run=3", by one of its rows."""
    cells = ((name, table.raw.column(name).iloc[row]) for name in by)
    return " ".join(f"{name}={_shown(cell)}" for name, cell in cells)


def run_names(titles: Sequence[str], label: str, rule: str) -> tuple[str, ...]:
    """Return the name of each run of a table: its title, or its number if no run has a title.

    By the rule `ONE_RUN` the name is the label alone. Titles that repeat are numbered.

    Args:
        titles: Title of each run by `run_title`.
        label: Name of the table; prefix of every name.
        rule: The rule in words.
    """
    if rule == ONE_RUN:
        return (label,) * len(titles)
    if not any(titles):
        return tuple(f"{label} run {k}" for k in range(1, len(titles) + 1))
    return tuple(unique_names([f"{label} {title}" for title in titles]))


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
        table.columns.require_usual_steps(table.raw, "t", step[inside])
    return time


def _after_pauses(table: RigTable, gap: float) -> NDArray[np.bool_]:
    """Mark each row whose time is more than `gap` [s] after the last known time before it.

    Raises `DataError` if there is no column of times.
    """
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
    """Mark each row at which a value in one of the columns differs from the row before it.

    Empty cells are equal to each other.
    """
    starts = np.zeros(len(table.raw), dtype=bool)
    for name in names:
        codes, _ = pd.factorize(table.raw.column(name))
        starts[1:] |= codes[1:] != codes[:-1]
    return starts


def _shown(cell: object) -> str:
    """Return a cell as text, numbers with six digits."""
    return f"{cell:g}" if isinstance(cell, (int, float, np.number)) else str(cell)
