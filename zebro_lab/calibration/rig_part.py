# SPDX-License-Identifier: MIT
"""Read one table or run folder of a rig experiment as samples in SI."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from model.slip.definition import SlipDefinition
from model.slip.rig_errors import RigErrors
from model.slip.samples import DiscAngles, SlipSamples
from rig.slip_rig.sweeps import STANDING, sweeps
from zebro_lab.calibration.lateral_force import LateralForce, lateral_force, lateral_sums, no_sums
from zebro_lab.calibration.plausible import require_plausible
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.runs.counted_once import run_keys
from zebro_lab.runs.data_paths import DataSource
from zebro_lab.runs.folder import LOG_FILE, SlipRigRun, read_slip_rig_run
from zebro_lab.runs.manifest import RIG, TABLE
from zebro_lab.tables.disc_angles import disc_angles, joined_angles
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_columns import RigColumns, RunRule
from zebro_lab.tables.rig_table import RigTable, normal_force, traction
from zebro_lab.tables.row_conditions import kept_rows
from zebro_lab.tables.run_separation import Runs, run_times, separate_runs, without_left_out
from zebro_lab.tables.slip_source import SlipColumn, converted, slip
from zebro_lab.tables.table_files import read_table_file

SWEEP = "sweep"
"""Name of the column with the sweep number."""

FOLLOWS = 0.97  # rank correlation of two columns, from which one is made of the other


def recorded_sweeps(run: SlipRigRun) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    """Number the sweeps of a recorded run: the leg disc turns, and slip does not jump within one.

    Returns:
        Sweep number of each sample, from 1; 0 outside sweeps, shape (n,). Then a note with the
        share of samples outside sweeps, if there are any.

    Raises:
        DataError: No sample is in a sweep: the leg disc never turned, or slip jumped throughout.
    """
    table, constants = run.table, run.manifest.constants
    speed_leg = table.omega_leg * constants["radius_leg"]
    number = 1 + sweeps(table.t, speed_leg, table.omega_ground * constants["radius_ground"])
    left_out = float(np.mean(number == 0))
    if left_out == 1:
        raise DataError(_why_none(speed_leg), file=run.folder / LOG_FILE)
    if not left_out:
        return number, ()
    note = (
        f"{run.folder.name}: {left_out:.1%} of the samples are ignored, because slip jumped "
        "between two sweeps or the leg disc stood still"
    )
    return number, (note,)


def _why_none(speed_leg: Array) -> str:
    """Return why a recording has no sweep, by the rim speed of the leg disc, shape (n,) [m/s]."""
    if np.abs(speed_leg).max() <= STANDING:
        return "the leg disc never turned, so that slip is undefined; record while the rig runs"
    return "slip jumped all the time, so that there is no sweep; change the slip ratio more slowly"


@dataclass(frozen=True)
class RigPart:
    """Samples of one table or run folder, not yet joined with others.

    Attributes:
        path: The table or run folder.
        columns: Column map that was applied to it.
        sources: Sources that the column map and the table or run state; empty if neither does.
        rows_read: Number of rows before `[rows] keep` is applied; rows outside the sweeps of a
            recording, and of runs dropped by `with_runs`, do not count.
        slip: Slip ratios, shape (n,) [-], with their definition.
        normal_force: Normal force, shape (n,) [N].
        traction_force: Traction force, shape (n,) [N].
        rig_errors: Prior standard deviations of errors of its rig.
        runs: Run of each sample, and the names of the runs.
        time: Time, shape (n,) [s]; None if the table has none or every row is a trial.
        notes: Notes on reading and unit conversion, one line each.
        files: Every file read, the column map last, if there is one.
        lateral: Sums of the lateral force of each run, see `lateral_sums`; None without one.
        angles: Angles of the discs; None where none are recorded, or they cannot be used.
        force_sd: Standard deviation of each row's traction, shape (n,) [N]; None where not stated.
        others: Columns that the map does not use, by header, shape (n,) each.
    """

    path: Path
    columns: RigColumns
    sources: tuple[str, ...]
    rows_read: int
    slip: SlipColumn
    normal_force: Array
    traction_force: Array
    rig_errors: RigErrors
    runs: Runs
    time: Array | None
    notes: tuple[str, ...]
    files: tuple[Path, ...]
    lateral: Array | None = None
    angles: DiscAngles | None = None
    force_sd: Array | None = None
    others: Mapping[str, Array] = field(default_factory=dict)

    @property
    def keys(self) -> tuple[str, ...]:
        """Key of each run, equal for copies: a hash of its forces, see `run_keys`."""
        forces = (self.normal_force, self.traction_force)
        return run_keys(forces, self.runs.index, len(self.runs.names))

    def with_runs(self, chosen: NDArray[np.bool_]) -> "RigPart":
        """Return a copy with the samples of the chosen runs only; runs are numbered anew.

        Args:
            chosen: Whether to keep each run, shape (n_runs,).
        """
        rows = chosen[self.runs.index]
        index = (np.cumsum(chosen) - 1)[self.runs.index[rows]]
        names = tuple(name for name, keep in zip(self.runs.names, chosen, strict=True) if keep)
        return replace(
            self,
            rows_read=self.rows_read - int((~rows).sum()),
            slip=replace(self.slip, ratio=self.slip.ratio[rows]),
            normal_force=self.normal_force[rows],
            traction_force=self.traction_force[rows],
            runs=replace(self.runs, index=index, names=names),
            time=None if self.time is None else self.time[rows],
            lateral=None if self.lateral is None else self.lateral[chosen],
            angles=None if self.angles is None else self.angles.of_rows(rows),
            force_sd=None if self.force_sd is None else self.force_sd[rows],
            others={name: values[rows] for name, values in self.others.items()},
        )


def read_part(
    source: DataSource, columns: RigColumns, label: str, wanted: SlipDefinition | None
) -> RigPart:
    """Read one table or run folder as samples in SI, separated into runs.

    Args:
        source: The table or run folder.
        columns: Column map; for a run folder only its row conditions, load cell, priors and errors
            of the rig apply.
        label: Prefix of the names of the runs.
        wanted: Definition to convert slip ratios to; None keeps that of the data, but converts
            `mean` to `material`.

    Raises:
        ZebroLabError: The file, its column map or its data are invalid.
    """
    if source.is_run_folder:
        raw, columns, files = _run_folder_table(source.path, columns)
    else:
        raw, files = read_table_file(source.path, sheet=columns.sheet), (source.path,)
    table, left_out = without_left_out(RigTable(raw, columns, kept_rows(raw, columns.keep)))
    slip_column, pressed = slip(table), normal_force(table)
    force, force_sd = traction(table, pressed)
    doubts = require_plausible(table, slip_column, pressed, force)
    if wanted is None and slip_column.definition is SlipDefinition.MEAN:
        wanted = SlipDefinition.MATERIAL  # advice on a fit knows what a rig can hold in the others
    if wanted is not None:
        slip_column = converted(table, slip_column, wanted)
    runs = separate_runs(table, label)
    time, untimed = run_times(table, runs)
    angles, unused = disc_angles(table, runs, time)
    return RigPart(
        path=source.path,
        columns=columns,
        sources=tuple(s for s in (columns.source, raw.source) if s),
        rows_read=len(raw),
        slip=slip_column,
        normal_force=pressed,
        traction_force=force,
        rig_errors=columns.rig_errors.resolved(table.radii()),
        runs=runs,
        time=time,
        notes=(*raw.notes, *table.conversions(), *left_out, *doubts, *untimed, *unused),
        files=files if columns.file is None else (*files, columns.file),
        lateral=lateral_sums(table, pressed, force, runs.index, len(runs.names)),
        angles=angles,
        force_sd=force_sd,
        others={} if source.is_run_folder else table.unused(),
    )


def _run_folder_table(
    folder: Path, columns: RigColumns
) -> tuple[RawTable, RigColumns, tuple[Path, ...]]:
    """Read a run folder as a table; return it with its column map and the files read.

    The table has canonical columns in SI. It is one run, or one run per sweep if raw samples of
    several sweeps were recorded; raw samples outside sweeps are dropped. Of a `columns.toml` only
    row conditions, load cell, priors and errors of the rig apply.
    """
    run, notes, rule = read_slip_rig_run(folder), (), RunRule()
    columns_read = {name: each for name, each in vars(run.table).items() if each is not None}
    if run.manifest.profiles.get(RIG, TABLE) != TABLE:  # raw device samples: not segmented yet
        number, notes = recorded_sweeps(run)
        rule = RunRule(by=(SWEEP,)) if number.max() > 1 else rule
        columns_read = {
            name: values[number > 0] for name, values in {**columns_read, SWEEP: number}.items()
        }
    series = {name: pd.Series(values) for name, values in columns_read.items()}
    raw = RawTable(folder, series, source=run.manifest.source, notes=(*run.notes, *notes))
    own = replace(columns, source=None, columns={}, constants=run.manifest.constants, runs=rule)
    return raw, own, run.files


def joined_samples(parts: Sequence[RigPart]) -> SlipSamples:
    """Join the samples of all parts, runs numbered throughout.

    Times are kept only if all parts have them, angles of a disc and standard deviations likewise;
    and unused columns, if their means differ between runs more than they vary within them.
    """
    first_run = np.cumsum([0, *(len(part.runs.names) for part in parts)])
    timed = [part.time for part in parts if part.time is not None]
    stated = [part.force_sd for part in parts if part.force_sd is not None]
    return SlipSamples(
        slip=np.concatenate([part.slip.ratio for part in parts]),
        normal_force=np.concatenate([part.normal_force for part in parts]),
        traction_force=np.concatenate([part.traction_force for part in parts]),
        run=np.concatenate(
            [part.runs.index + first for part, first in zip(parts, first_run, strict=False)]
        ),
        run_names=tuple(name for part in parts for name in part.runs.names),
        definition=parts[0].slip.definition,
        time=np.concatenate(timed) if len(timed) == len(parts) else None,
        angles=joined_angles([part.angles for part in parts])[0],
        force_sd=np.concatenate(stated) if len(stated) == len(parts) else None,
        others=_differing(parts),
    )


def _differing(parts: Sequence[RigPart]) -> dict[str, Array]:
    """Join the unused columns that all parts have, and that differ between runs.

    Left out are those that follow a column that is used: a coefficient, a force in another unit.
    """
    shared = set.intersection(*(set(part.others) for part in parts))
    used = [
        np.concatenate([_run_means(part, values(part)) for part in parts])
        for values in (
            lambda part: part.slip.ratio,
            lambda part: part.normal_force,
            lambda part: part.traction_force,
            lambda part: part.traction_force / np.maximum(part.normal_force, 1e-9),
        )
    ]
    found = {}
    for name in sorted(shared):
        means = [_run_means(part, part.others[name]) for part in parts]
        within = np.concatenate([
            (part.others[name] - mean[part.runs.index]) ** 2
            for part, mean in zip(parts, means, strict=True)
        ])  # fmt: skip
        of_runs = np.concatenate(means)
        if np.var(of_runs) <= np.mean(within):
            continue
        if not any(np.ptp(each) and abs(_correlation(of_runs, each)) > FOLLOWS for each in used):
            found[name] = np.concatenate([part.others[name] for part in parts])
    return found


def _run_means(part: RigPart, values: Array) -> Array:
    """Average values (n,) over each run of a part, shape (n_runs,)."""
    return np.bincount(part.runs.index, values) / np.bincount(part.runs.index)


def _correlation(first: Array, second: Array) -> float:
    """Return the rank correlation of two arrays, which a curve between them does not lower [-]."""
    ranks = np.array([np.argsort(np.argsort(each)) for each in (first, second)], dtype=float)
    return float(np.corrcoef(ranks)[0, 1])


def joined_source(parts: Sequence[RigPart]) -> str:
    """Return the source that all parts state, or all of them as "mixed:a,b"."""
    stated = dict.fromkeys(s for part in parts for s in part.sources or ("unknown",))
    return next(iter(stated)) if len(stated) == 1 else f"mixed:{','.join(stated)}"


def joined_load_cell(parts: Sequence[RigPart]) -> dict[str, float]:
    """Return what the parts state of the load cell, by name; empty if none states anything.

    Raises `SettingsError` where two parts state different values of one name.
    """
    joined: dict[str, float] = {}
    origin: dict[str, Path | None] = {}
    for part in parts:
        for name, value in part.columns.load_cell.items():
            if joined.setdefault(name, value) != value:
                raise SettingsError(
                    f"is {value:g} here and {joined[name]:g} in {origin[name]}; "
                    f"calibrate data of two load cells apart",
                    file=part.columns.file, key=f"load_cell.{name}",
                )  # fmt: skip
            origin.setdefault(name, part.columns.file)
    return joined


def joined_priors(parts: Sequence[RigPart]) -> tuple[tuple[str, ...], Path | None]:
    """Return the priors of the parts' column maps and their file; empty and None without priors.

    Raises `SettingsError` where two maps with priors differ, apart from their order.
    """
    stated = {part.columns.file: part.columns.priors for part in parts if part.columns.priors}
    maps = list(stated.items())
    for file, priors in maps[1:]:
        if set(priors) != set(maps[0][1]):
            raise SettingsError(
                f"differs from that of {maps[0][0]}; state priors in one of them, or with --prior",
                file=file, key="priors",
            )  # fmt: skip
    return (maps[0][1], maps[0][0]) if maps else ((), None)


def joined_lateral(parts: Sequence[RigPart]) -> LateralForce | None:
    """Return mean and scatter of the lateral force over all parts; None if none has one."""
    return lateral_force(
        [
            no_sums(_samples_of_runs(part)) if part.lateral is None else part.lateral
            for part in parts
        ]
    )


def _samples_of_runs(part: RigPart) -> NDArray[np.intp]:
    """Return the number of samples of each run of a part, shape (n_runs,)."""
    return np.bincount(part.runs.index, minlength=len(part.runs.names))


def joined_rig_errors(parts: Sequence[RigPart]) -> RigErrors:
    """Return the largest of all parts' standard deviations, for each error of the rig."""
    each = [part.rig_errors for part in parts]
    return RigErrors(
        max(errors.radius_ratio for errors in each),
        max(errors.rolling_resistance for errors in each),
        max(errors.slip_scatter for errors in each),
        max(errors.run_out for errors in each),
    )
