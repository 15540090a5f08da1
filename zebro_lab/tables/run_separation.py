# SPDX-License-Identifier: MIT
"""Assign the rows of a table to runs, and check their times."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.files.errors import DataError
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
    titles = [run_title(table, row, by) for row in first]
    return Runs(index, run_names(titles, label, rule, (1 + kept).tolist()), rule)


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


def run_names(titles: list[str], label: str, rule: str, numbers: list[int]) -> tuple[str, ...]:
    """Return the name of each run of a table: its title, or its number if no run has a title.

    By the rule `ONE_RUN` the name is the label alone. Titles that repeat are numbered.

    Args:
        titles: Title of each run by `run_title`.
        label: Name of the table; prefix of every name.
        rule: The rule in words.
        numbers: Number of each run in its table, counted from 1.
    """
    if rule == ONE_RUN:
        return (label,) * len(titles)
    if not any(titles):
        return tuple(f"{label} run {k}" for k in numbers)
    return tuple(unique_names([f"{label} {title}" for title in titles]))


def without_left_out(table: RigTable) -> tuple[RigTable, tuple[str, ...]]:
    """Return a table without the runs that `[runs] leave_out` names, and a note on them.

    Raises:
        DataError: The table has no run of that number, or no other one; or as `separate_runs`.
    """
    rule = table.columns.runs
    if not rule.leave_out:
        return table, ()
    number = 1 + (np.arange(len(table.raw)) if rule.each_row else np.cumsum(run_starts(table)[0]))
    rows = table.rows[~np.isin(number[table.rows], rule.leave_out)]
    named = ", ".join(map(str, rule.leave_out))
    what = "rows" if rule.each_row else "runs"
    if max(rule.leave_out) > number[-1] or not len(rows):
        problem = f"[runs] leave_out in {table.columns.stated_in} names {what} {named}"
        raise DataError(f"{problem}; expected some of 1 to {number[-1]}", file=table.raw.path)
    return replace(table, rows=rows), (f"{table.raw.path.name}: {what} {named} are left out",)


def run_times(table: RigTable, runs: Runs) -> tuple[Array | None, tuple[str, ...]]:
    """Return the time of every kept row, and check that it does not decrease within a run.

    Times that repeat because they are rounded are replaced by the even spacing that this hides.

    Args:
        table: Rig table.
        runs: Run of each kept row.

    Returns:
        Times, shape (n,) [s]; None if the table has no time column, every row is a trial, or times
        repeat and are not those of even spacing. Then a note where times repeat.

    Raises:
        DataError: Time decreases within a run, is not a finite number, or is mapped to a header
            that the table lacks; or it is in no unit that is stated, and does not fit seconds.
    """
    if table.columns.runs.each_row or table.source_of("t") is None:
        return None, ()
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
    notes: tuple[str, ...] = ()
    again = np.count_nonzero(inside & (step == 0))
    if again:
        time = _even_times(time, runs.index)
        used = "they are not used" if time is None else "the even spacing that this hides is taken"
        notes = (f"{table.raw.path.name}: {again} times repeat, as if rounded; {used}",)
    if time is None:
        return None, notes
    step = np.diff(time, prepend=-np.inf)
    source = table.required("t")
    if not (table.raw.path.is_dir() or source.unit_stated or table.raw.unit_of(source.name, "s")):
        table.columns.require_usual_steps(table.raw, "t", step[inside])
    return time, notes


def _even_times(time: Array, run: NDArray[np.intp]) -> Array | None:
    """Return evenly spaced times, one interval in all runs, that rounding hides, shape (n,) [s].

    None where the recorded ones are off by more than their resolution, the smallest step.

    Args:
        time: Times, not decreasing within a run, shape (n,) [s].
        run: Run of each, non-decreasing, shape (n,).
    """
    step, inside = np.diff(time), np.diff(run) == 0
    if not np.any(step[inside] > 0):
        return None
    even = np.cumsum(np.append(0.0, np.where(inside, step[inside].mean(), 0.0)))
    even += (np.bincount(run, time - even) / np.bincount(run))[run]
    resolution = step[inside & (step > 0)].min()
    return even if np.abs(time - even).max() <= 1.1 * resolution else None


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
