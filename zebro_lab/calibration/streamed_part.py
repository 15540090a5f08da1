# SPDX-License-Identifier: MIT
"""Read a Parquet table that is too large for memory as means of a few samples each."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.fine_means import Reduced, fine_moments, reduce_samples
from model.bayes.samples import SlipSamples
from model.slip.definition import SlipDefinition
from zebro_lab.calibration.lateral_force import lateral_sums
from zebro_lab.calibration.plausible import require_plausible
from zebro_lab.calibration.rig_part import ANGLES_PASSED, RigPart
from zebro_lab.files.errors import DataError
from zebro_lab.runs.data_paths import DataSource
from zebro_lab.tables.columns import CANONICAL, Columns
from zebro_lab.tables.disc_angles import ANGLES
from zebro_lab.tables.parquet_files import parquet_parts, parquet_rows
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_table import RigTable, normal_force
from zebro_lab.tables.row_conditions import kept_rows, meets
from zebro_lab.tables.run_separation import Runs, run_names, run_starts, run_times, run_title
from zebro_lab.tables.run_values import require_steady, run_values
from zebro_lab.tables.slip_source import SlipColumn, converted, slip

PART = 400_000  # rows that are read at a time
LOOKED_AT = 400_000  # rows, evenly spread, on which the whole table is judged


@dataclass
class _Reading:
    """What has been read of a table so far.

    Attributes:
        titles: Title of each run.
        every: Its samples, averaged, by part.
        covariate: Value of the covariate in each run, by part, with its number of samples.
        thin: Evenly spread rows.
        lateral: Sums of the lateral force of each run; of runs without a lateral force none.
        last: Run of the last row, counted from 0; -1 before the first.
    """

    titles: dict[int, str] = field(default_factory=dict)
    every: list[Reduced] = field(default_factory=list)
    covariate: dict[int, list[tuple[float, int]]] = field(default_factory=dict)
    thin: list[RawTable] = field(default_factory=list)
    lateral: dict[int, Array] = field(default_factory=dict)
    last: int = -1


def read_streamed_part(
    source: DataSource,
    columns: Columns,
    label: str,
    wanted: SlipDefinition | None,
    *,
    mean_of: int,
) -> RigPart:
    """Read a Parquet table in one pass as means of samples, separated into runs.

    Every row is checked as `read_part` does, but for what is judged of the table as a whole (units
    and signs that no rig can have), for which some hundred thousand rows are looked at.

    Args:
        source: The table, a Parquet file.
        columns: Column map, in which not every row is a trial.
        label: Prefix of the names of the runs.
        wanted: Definition to convert slip ratios to; None keeps that of the data.
        mean_of: Samples in a mean.

    Raises:
        ZebroLabError: The file, its column map or its data are invalid.
    """
    n_rows = parquet_rows(source.path)[0]
    step = max(1, n_rows // LOOKED_AT)
    reading, first, rule = _Reading(), None, ""
    for raw in parquet_parts(source.path, rows=PART, wanted=_headers(columns)):
        first = raw if first is None else first
        reading.thin.append(_every(raw, step))
        rule = _read_rows(raw, columns, wanted, mean_of, reading)
    if first is None or not reading.every:
        raise DataError(
            "has no row that [rows] keep leaves" if columns.keep else "has a header but no rows",
            file=source.path,
        )
    table = _looked_at(first, reading, columns)
    column = slip(table)
    doubts = require_plausible(table, column, normal_force(table), table.si("traction_force"))
    column = column if wanted is None else converted(table, column, wanted)
    return _part(source, columns, label, reading, table, column, doubts, rule, n_rows)


def _headers(columns: Columns) -> set[str]:
    """Return the headers that a column map can take: mapped ones, and canonical names."""
    mapped = {column.name for column in columns.columns.values()}
    stamps = {column.nanoseconds for column in columns.columns.values() if column.nanoseconds}
    rules = {*columns.runs.by, *(condition.column for condition in columns.keep)}
    covariate = columns.covariate
    named = {covariate.header} if covariate is not None and covariate.header else set()
    return {*CANONICAL, *mapped, *stamps, *rules, *named}


def _every(raw: RawTable, step: int) -> RawTable:
    """Return the rows of a part of a table whose numbers in the file are multiples of `step`."""
    rows = np.flatnonzero(np.asarray(raw.kept) % step == 0)
    return raw.part(rows)


def _looked_at(first: RawTable, reading: _Reading, columns: Columns) -> RigTable:
    """Return the rows that the table as a whole is judged by."""
    names = first.columns
    cells = {name: pd.concat([part.columns[name] for part in reading.thin], ignore_index=True)
             for name in names}  # fmt: skip
    kept = np.concatenate([np.asarray(part.kept) for part in reading.thin])
    once = np.unique(kept, return_index=True)[1]
    raw = replace(first, columns=cells, kept=kept).part(once)
    return RigTable(raw, columns, kept_rows(raw, columns.keep))


def _read_rows(
    raw: RawTable,
    columns: Columns,
    wanted: SlipDefinition | None,
    mean_of: int,
    reading: _Reading,
) -> str:
    """Check and average the rows of a part of the table; return the rule that separates runs.

    The part begins with the last row of the part before it, unless it is the first.
    """
    everything = RigTable(raw, columns, np.arange(len(raw)))
    starts, by, rule = run_starts(everything)
    overlap = int(reading.last >= 0)
    number = max(reading.last, 0) + np.cumsum(starts)
    reading.last = int(number[-1])
    rows = np.flatnonzero(meets(raw, columns.keep))
    if not np.any(rows >= overlap):
        return rule
    table = RigTable(raw, columns, rows)
    column, pressed, traction = slip(table), normal_force(table), table.si("traction_force")
    if wanted is not None:
        column = converted(table, column, wanted)
    ids, index = np.unique(number[rows], return_inverse=True)
    runs = Runs(index, ("",) * len(ids), rule)
    time = run_times(table, runs)
    new = rows >= overlap
    own, of_own = np.unique(index[new], return_inverse=True)
    samples = SlipSamples(
        column.ratio[new], pressed[new], traction[new], of_own, ("",) * len(own),
        column.definition, None if time is None else time[new],
    )  # fmt: skip
    reduced = reduce_samples(samples, mean_of)
    numbers = ids[own]
    _add_lateral(reading, RigTable(raw, columns, rows[new]), samples, numbers)
    pieces = tuple((int(numbers[run]), piece) for run, piece in reduced.pieces)
    reading.every.append(replace(reduced, run=numbers[reduced.run], pieces=pieces))
    for each in own:
        row = int(rows[np.argmax(index == each)])
        reading.titles.setdefault(int(ids[each]), run_title(table, row, by))
    if columns.covariate is not None:
        found, sizes = run_values(table, runs, columns.covariate), np.bincount(index)
        for each in own:
            reading.covariate.setdefault(int(ids[each]), []).append(
                (float(found[each]), int(sizes[each]))
            )
    return rule


def _add_lateral(
    reading: _Reading, table: RigTable, samples: SlipSamples, numbers: NDArray[np.signedinteger]
) -> None:
    """Add the lateral force of samples to the sums of their runs, if the table has one."""
    sums = lateral_sums(
        table, samples.normal_force, samples.traction_force, samples.run, len(numbers)
    )
    if sums is not None:
        for number, each in zip(numbers.tolist(), sums, strict=True):
            reading.lateral[number] = reading.lateral.get(number, 0.0) + each


def _part(
    source: DataSource,
    columns: Columns,
    label: str,
    reading: _Reading,
    table: RigTable,
    column: SlipColumn,
    doubts: tuple[str, ...],
    rule: str,
    n_rows: int,
) -> RigPart:
    """Join what was read."""
    numbers = np.array(sorted(reading.titles))
    every = list(_numbered(reading.every, numbers))
    values = np.concatenate([part.means for part in every], axis=1)
    names = run_names([reading.titles[number] for number in numbers], label, rule)
    files = (source.path,)
    time = values[3]
    return RigPart(
        path=source.path,
        columns=columns,
        sources=tuple(s for s in (columns.source, table.raw.source) if s),
        rows_read=n_rows,
        slip=replace(column, ratio=values[0]),
        normal_force=values[1],
        traction_force=values[2],
        rig_errors=columns.rig_errors.resolved(table.radii()),
        runs=Runs(np.concatenate([part.run for part in every]), names, rule),
        time=None if np.isnan(time).any() else time,
        notes=(*table.raw.notes, *table.conversions(), *doubts, *_passed(table)),
        files=files if columns.file is None else (*files, columns.file),
        covariate=_covariate(table, reading, numbers, names),
        fine=fine_moments(every, len(numbers)),
        lateral=np.array([reading.lateral[n] for n in numbers.tolist()])
        if reading.lateral
        else None,
    )


def _passed(table: RigTable) -> tuple[str, ...]:
    """Return a note where angles of the discs are recorded: means have no angle."""
    return (ANGLES_PASSED,) * any(table.source_of(name) for name in ANGLES)


def _numbered(every: list[Reduced], numbers: Array) -> Iterator[Reduced]:
    """Number runs from 0, without those that have no rows left."""
    for part in every:
        pieces = tuple((int(np.searchsorted(numbers, run)), piece) for run, piece in part.pieces)
        yield replace(part, run=np.searchsorted(numbers, part.run), pieces=pieces)


def _covariate(
    table: RigTable, reading: _Reading, numbers: Array, names: tuple[str, ...]
) -> Array | None:
    """Return the mean over parts of the covariate of each run; None without a covariate."""
    stated = table.columns.covariate
    if stated is None:
        return None
    found = []
    for number, name in zip(numbers, names, strict=True):
        medians, sizes = np.array(reading.covariate[int(number)]).T
        if stated.header is not None:
            require_steady(table, stated, name, medians)
        found.append(float(np.average(medians, weights=sizes)))
    return np.array(found)
