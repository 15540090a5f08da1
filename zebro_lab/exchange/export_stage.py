# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab export`: write a run as CSV or Parquet tables."""

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, Literal

import pandas as pd

from rig.sample_columns import SampleColumns
from zebro_lab.files.atomic import atomic_folder, atomic_write_text
from zebro_lab.files.errors import AlreadyExists, DataError, SettingsError, shown
from zebro_lab.files.settings_table import fill_in
from zebro_lab.mcap.raw_log import raw_topic, read_raw_log
from zebro_lab.runs.folder import LOG_FILE, read_slip_rig_run, run_state
from zebro_lab.runs.manifest import RECORDING, RunManifest, read_manifest
from zebro_lab.runs.profile_streams import LEGS
from zebro_lab.runs.recorded_walk import read_recorded_legs
from zebro_lab.tables.columns import COLUMNS_FILE

Format = Literal["csv", "parquet"]
FORMATS: Final[tuple[Format, ...]] = ("csv", "parquet")
Columns = Mapping[str, Any]


def export_run(folder: Path, *, to: Format, out: Path) -> tuple[tuple[Path, ...], tuple[str, ...]]:
    """Write a run as tables: raw samples of each stream, and decoded values in SI.

    `legs` has the columns `t` and `theta1` to `theta6`, `slip_rig` those of a calibration, forces
    without the zero offset, `NAME_raw` the raw samples of a device. A Parquet table has the source
    in its metadata; beside CSV tables it stands in a `columns.toml`, which every command that reads
    such a table takes into account. A damaged log is exported without the damage.

    Args:
        folder: The run folder.
        to: Format of the tables, "csv" or "parquet".
        out: Folder to create, whole or not at all.

    Returns:
        The files written, the tables first; and a warning of a run that has not ended.

    Raises:
        NotFound: The folder is not a run folder, or its log or profile is missing.
        DataError: The run cannot be read, or has no samples.
        AlreadyExists: `out` exists.
        SettingsError: `to` is "parquet", and pyarrow is not installed.
        OSError: The tables cannot be written.
    """
    if out.exists():
        raise AlreadyExists(f"{out} exists already; choose another folder with --out")
    if to == "parquet" and find_spec("pyarrow") is None:
        raise SettingsError(
            "'parquet' needs pyarrow: pip install 'zebro-lab[parquet]', or --to csv", key="--to"
        )
    manifest = read_manifest(folder)
    log = read_raw_log(folder / LOG_FILE)
    streams = log.streams
    tables: dict[str, Columns] = {
        topic.strip("/").replace("/", "_"): _raw_columns(stream)
        for topic, stream in streams.items()
    }
    if raw_topic(LEGS) in streams:
        legs, _ = read_recorded_legs(folder)
        tables[LEGS] = {name: column.to_numpy() for name, column in legs.columns.items()}
    if manifest.kind == "slip-rig":
        tables["slip_rig"] = vars(read_slip_rig_run(folder).table) | {
            name: radius for name, radius in manifest.constants.items()
            if name.startswith("radius_")
        }  # fmt: skip
    if not tables:
        raise DataError("the run holds no samples to export", file=folder)
    names = [f"{name}.{to}" for name in tables]
    with atomic_folder(out) as draft:
        for file, columns in zip(names, tables.values(), strict=True):
            _write(draft / file, columns, to=to, source=manifest.source)
        if to == "csv":
            _write_source(draft / COLUMNS_FILE, folder, manifest.source)
            names.append(COLUMNS_FILE)
    return tuple(out / name for name in names), _unended(folder, manifest, log.end)


def _unended(folder: Path, manifest: RunManifest, end: float | None) -> tuple[str, ...]:
    """Return a warning if a run has not ended, with its state as in `runs` and its last sample.

    Empty if the run's manifest has an exit status other than `RECORDING`.
    """
    if manifest.exit_status != RECORDING:
        return ()
    until = "" if end is None else f"; samples go up to {end:.3f} s"
    state = run_state(folder, manifest)
    return (f"WARNING: the run has not ended, state '{state}'{until}",)


def _raw_columns(stream: SampleColumns) -> Columns:
    """Return the columns of a stream, its counts of shape (n, k) as `count1` to `countk`."""
    counts = {f"count{i + 1}": column for i, column in enumerate(stream.counts.T)}
    return {name: column for name, column in vars(stream).items() if name != "counts"} | counts


def _write(file: Path, columns: Columns, *, to: Format, source: str) -> None:
    """Write one table; the source goes into the metadata of Parquet, as CSV has no place for it."""
    table = pd.DataFrame(dict(columns))
    if to == "csv":
        table.to_csv(file, index=False, lineterminator="\n")
        return
    import pyarrow as pa
    import pyarrow.parquet as pq

    arrow = pa.Table.from_pandas(table, preserve_index=False)
    pq.write_table(arrow.replace_schema_metadata({"source": source}), file)


def _write_source(file: Path, run: Path, source: str) -> None:
    """Write the `columns.toml` of exported CSV tables: their source, and the run in a comment.

    The tables have canonical columns in SI, so that it maps none.
    """
    head = f"# Tables of the run {shown(run.absolute().name)}, written by zebro-lab export.\n"
    atomic_write_text(file, fill_in(head + 'source = "unknown"\n', {"source": source}))
