# SPDX-License-Identifier: MIT
"""Import the table of a slip rig: one run folder for each run in it."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.counted import counted
from rig.slip_rig.profile import FURTHER
from zebro_lab.calibration.plausible import require_plausible
from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import DataError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.settings_table import fill_in
from zebro_lab.files.source_names import stated_source
from zebro_lab.runs.manifest import IMPORTED, RunManifest
from zebro_lab.runs.slip_rig_table import SlipRigTable
from zebro_lab.runs.table_run import write_slip_rig_run
from zebro_lab.tables.columns import COLUMNS_FILE
from zebro_lab.tables.columns_file import prior_entry, rig_columns
from zebro_lab.tables.disc_angles import disc_angles
from zebro_lab.tables.rig_columns import RigColumns, RigErrorsStated
from zebro_lab.tables.rig_table import RigTable, normal_force
from zebro_lab.tables.row_conditions import kept_rows
from zebro_lab.tables.run_separation import run_times, separate_runs
from zebro_lab.tables.slip_source import slip
from zebro_lab.tables.table_files import read_table_file, table_stem

_NEEDED = ("t", "omega_leg", "omega_ground", "normal_force", "traction_force")
_MOSTLY = 0.9  # share of rows
_ELSE = "give this table to calibrate-slip directly, without import"


@dataclass(frozen=True)
class RigRun:
    """One run of an imported rig table.

    Attributes:
        manifest: Name, source and radii of the run; its start is set by `begun`.
        table: Samples of the run; their time is the file's, after `begun` the run's.
        files: Every file read: the table and its `columns.toml`.
        stated: What is stated of load cell and rig, and priors, in SI, by section and key of
            `columns.toml`.
    """

    manifest: RunManifest
    table: SlipRigTable
    files: tuple[Path, ...]
    stated: Mapping[str, Mapping[str, object]] = field(default_factory=dict)

    def begun(self, start: datetime, zero: float) -> "RigRun":
        """Return the run with its start date and times from 0 at its first sample.

        Args:
            start: Date at which the file's time was `zero`.
            zero: Time of the file at `start` [s].
        """
        first = float(self.table.t[0])
        began = start + timedelta(seconds=first - zero)
        return replace(
            self,
            manifest=replace(self.manifest, start=began.isoformat()),
            table=replace(self.table, t=self.table.t - first),
        )


def rig_runs(path: Path, request: ImportRequest) -> tuple[list[RigRun], tuple[str, ...]]:
    """Read a table of a slip rig and separate it into runs.

    Args:
        path: The table file.
        request: Column map, label, material and operator.

    Returns:
        The runs, not begun yet, and notes, one line each.

    Raises:
        NotFound: The file does not exist.
        DataError: The table cannot be read or keeps no row, a column or a radius is missing, a cell
            is no finite number, a radius changes, rows are averages of trials, time decreases or
            repeats within a run, or no rig can have measured the numbers.
    """
    columns, label = rig_columns(path, request.columns), request.label or table_stem(path)
    raw = read_table_file(path, sheet=columns.sheet)
    table = RigTable(raw, columns, kept_rows(raw, columns.keep))
    if columns.runs.each_row:
        raise DataError(f"each row is the mean of a trial, not a sample, as {COLUMNS_FILE} states "
                        f"in [runs] each_row; {_ELSE}", file=path)  # fmt: skip
    missing = [name for name in _NEEDED if table.source_of(name) is None]
    if missing and table.source_of("slip_ratio") is not None:
        raise DataError(f"has a slip ratio but no {missing[0]}; {_ELSE}", file=path)
    for name in missing:
        table.required(name)
    doubts = _require_plausible(table)
    runs = separate_runs(table, label)
    run_times(table, runs)
    given = [name for name in FURTHER if table.source_of(name) is not None]
    disc_angles(table, runs, table.si("t"))  # refuses angles in another unit than they are said in
    samples = {name: table.si(name) for name in (*_NEEDED, *given)}
    common = RunManifest(
        kind="slip-rig",
        label=label,
        material=request.material,
        operator=request.operator,
        source=stated_source(columns.source or raw.source, path),
        exit_status=IMPORTED,
        constants={name: _radius(table, name) for name in ("radius_leg", "radius_ground")},
    )
    made = [
        RigRun(
            replace(common, label=name),
            SlipRigTable(**{key: part[runs.index == i] for key, part in samples.items()}),
            files=(path, *([columns.file] if columns.file else [])),
            stated=_stated(columns),
        )
        for i, name in enumerate(runs.names)
    ]
    notes = [*raw.notes, *table.conversions(), *doubts]
    if columns.keep:
        left_out, conditions = len(raw) - len(table.rows), " and ".join(map(str, columns.keep))
        notes.append(f"{left_out} of {len(raw)} rows do not meet {conditions}: skipped")
    return made, (*notes, f"{counted(len(made), 'run')}, {runs.rule}")


def write_rig_run(data_dir: Path, run: RigRun) -> Path:
    """Write the run folder of an imported rig run.

    What is stated of load cell and rig, and priors, go into the folder's `columns.toml`.

    Args:
        data_dir: Folder of run folders; created when missing.
        run: The run, with its start set by `begun`.

    Returns:
        The run folder.

    Raises:
        AlreadyExists: A run of this kind, start (to the second) and label exists.
        DataError: The run has no samples.
        OSError: The folder cannot be written.
    """
    return write_slip_rig_run(
        data_dir,
        run.table,
        replace(run.manifest, inputs=file_hashes(run.files)),
        extra=lambda draft: _write_stated(draft, run.stated),
    )


def _require_plausible(table: RigTable) -> tuple[str, ...]:
    """Check the rows under load as calibrate-slip does, to which a run folder is in SI.

    Raises:
        DataError: No rig can have measured the numbers, or the normal force is mostly negative.
    """
    force, turning = table.si("normal_force"), table.si("omega_leg") != 0
    if np.mean(force < 0) > _MOSTLY:
        normal_force(table)
    rows = table.rows[(force > 0) & turning]
    if not len(rows):
        return ()
    own = {name: c for name, c in table.columns.columns.items() if name != "slip_ratio"}
    loaded = replace(table, rows=rows, columns=replace(table.columns, columns=own))
    return require_plausible(
        loaded, slip(loaded), loaded.si("normal_force"), loaded.si("traction_force")
    )


def _radius(table: RigTable, name: str) -> float:
    radius = table.constant_or_column(name)
    values: Array = np.atleast_1d(radius)
    if np.ptp(values) > 0:
        raise DataError(
            f"{name} varies from {values.min():g} to {values.max():g} m, and a run folder holds "
            f"one radius; {_ELSE}",
            file=table.raw.path, column=name,
        )  # fmt: skip
    return float(values[0])


def _stated(columns: RigColumns) -> dict[str, Mapping[str, object]]:
    usual, given = asdict(RigErrorsStated()), asdict(columns.rig_errors)
    sections: dict[str, Mapping[str, object]] = {
        "load_cell": columns.load_cell,
        "rig_errors": {name: value for name, value in given.items() if value != usual[name]},
        "priors": dict(prior_entry(text) for text in columns.priors),
    }
    return {name: entries for name, entries in sections.items() if entries}


def _write_stated(draft: Path, stated: Mapping[str, Mapping[str, object]]) -> None:
    if stated:
        template = "".join(f"[{name}]  # SI\n" for name in stated)
        atomic_write_text(draft / COLUMNS_FILE, fill_in(template, stated))
