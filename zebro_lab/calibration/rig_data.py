# SPDX-License-Identifier: MIT
"""Read rig data from tables and run folders as samples for a calibration."""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.bayes.averaging.slip_noise import slip_noise_variance
from model.counted import counted
from model.errors import ModelError
from model.slip.definition import SlipDefinition
from model.slip.rig_errors import USUAL, RigErrors
from model.slip.samples import SlipSamples
from zebro_lab.calibration.lateral_force import LateralForce
from zebro_lab.calibration.rig_part import (
    RigPart,
    joined_lateral,
    joined_load_cell,
    joined_priors,
    joined_rig_errors,
    joined_samples,
    joined_source,
    read_part,
)
from zebro_lab.files.errors import DataError, ZebroLabError
from zebro_lab.runs.counted_once import (
    content_hash,
    duplicates_note,
    first_of_each,
    named_like_a_copy,
)
from zebro_lab.runs.data_paths import DataSource, columns_above_roots, find_sources
from zebro_lab.runs.folder import LOG_FILE
from zebro_lab.runs.manifest import RECORDING, RIG_KIND, read_manifest
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.tables.disc_angles import joined_angles
from zebro_lab.tables.rig_columns import RigColumns, parse_definition
from zebro_lab.tables.table_files import table_stem

_LEAST_SAMPLES = 20  # of a recording, to estimate its noise
_LEAST_TRIALS = 8  # averages over trials: more than any law has parameters
_CONSTANT_SLIP = 1e-6  # range of slip ratio below which slip is constant
_NOISE_ALONE = 1.1  # ratio of slip spread to sensor noise below which noise explains the spread


@dataclass(frozen=True)
class RigData:
    """Samples of a rig experiment with their provenance.

    Attributes:
        samples: Samples of the runs, joined in the order of the paths, without excluded runs and
            copies.
        files: Files of these samples, each once: for each table or run folder its files, then its
            column map.
        source: Source as stated, such as "real" or "sim:what"; "unknown" if not stated;
            "mixed:a,b" for several.
        notes: Notes, one line each: how slip was obtained, how runs were separated, rows dropped
            and why, times not used, how files were read, units converted, runs left out, copies.
        load_cell: Standard deviations from `[load_cell]` of `columns.toml` by name, SI; only those
            given.
        rig_errors: Prior standard deviations of the rig's errors; of several tables the largest.
        repeated: The notes on duplicate data, which `notes` has too.
        priors: Priors from `[priors]` of `columns.toml`, as texts such as "friction = 0.4 ± 0.05".
        priors_file: The `columns.toml` that they are in; None without.
        lateral: Mean and scatter of the lateral force; None if no sample has one.
    """

    samples: SlipSamples
    files: tuple[Path, ...]
    source: str
    notes: tuple[str, ...]
    load_cell: Mapping[str, float]
    rig_errors: RigErrors = USUAL
    repeated: tuple[str, ...] = ()
    priors: tuple[str, ...] = ()
    priors_file: Path | None = None
    lateral: LateralForce | None = None


def read_rig_data(
    paths: Sequence[Path], *, columns: Path | None = None, slip_definition: str | None = None
) -> RigData:
    """Read rig data from tables and run folders.

    Left out, with a note, are excluded runs, copies, runs of another kind than the rig's, and runs
    that were cut short before they had samples that can be used.

    Args:
        paths: Files, folders of files, run folders, folders of run folders; several.
        columns: A `columns.toml` for all data, instead of those beside the data.
        slip_definition: Definition to convert all slip ratios to; None keeps that of the data, but
            converts `mean` to `material`.

    Raises:
        ZebroLabError: A path, column map or the data is invalid; slip definitions or load cells
            differ; every run is left out; samples are too few; slip varies no more than its noise.
    """
    named, others = _of_the_rig(find_sources(paths))
    excluded = {source: why for source in named if (why := _exclusion(source)) is not None}
    included = [source for source in named if source not in excluded]
    sources, repeated = _distinct(included)
    wanted = slip_definition
    if wanted is not None:
        wanted = parse_definition(wanted, file=None, key="slip definition")
    labels = dict(zip(named, _labels(named), strict=True))
    maps = _column_maps(named, columns)
    parts, died = _read_parts(sources, maps, labels, wanted)
    if parts:  # the same forces under two definitions contradict each other
        _require_one_definition(parts)
    known = _known(excluded, maps, labels) if parts else {}
    parts, repeated_runs = _without_duplicates(parts, known)
    files = [(labels[one], labels[other]) for one, other in repeated]
    duplicates = duplicates_note("runs and tables", [*files, *repeated_runs])
    out = {**excluded, **died}
    skipped = [f"{labels[source]}: left out, {why}" for source, why in out.items()]
    if not parts:
        raise DataError(f"every run is left out: {'; '.join((*skipped, *duplicates))}")
    samples = joined_samples(parts)
    _require_informative(samples, parts)
    priors, priors_file = joined_priors(parts)
    lateral = joined_lateral(parts)
    return RigData(
        samples=samples,
        files=tuple(dict.fromkeys(file for part in parts for file in part.files)),
        source=joined_source(parts),
        notes=(
            *_notes(parts),
            *(() if lateral is None else (lateral.text,)),
            *joined_angles([part.angles for part in parts])[1],
            *others,
            *skipped,
            *duplicates,
            *columns_above_roots(sources, columns),
        ),
        load_cell=joined_load_cell(parts),
        rig_errors=joined_rig_errors(parts),
        repeated=duplicates,
        priors=priors,
        priors_file=priors_file,
        lateral=lateral,
    )


def _distinct(
    sources: list[DataSource],
) -> tuple[list[DataSource], list[tuple[DataSource, DataSource]]]:
    """Return the sources without copies, whose content is equal, and pairs (copy, original)."""
    if len(sources) < 2:  # nothing to compare, so that nothing is hashed
        return sources, []
    return first_of_each(
        sources, key=_bytes_of, is_copy=lambda source: named_like_a_copy(source.path)
    )


def _of_the_rig(sources: Sequence[DataSource]) -> tuple[list[DataSource], tuple[str, ...]]:
    """Return tables and runs of the slip rig, and a note on runs of another kind, if any.

    Raises:
        DataError: A manifest is invalid, or every path is a run of another kind.
    """
    kinds = {s: read_manifest(s.path).kind for s in sources if s.is_run_folder}
    others = [s for s in sources if kinds.get(s, RIG_KIND) != RIG_KIND]
    if not others:
        return list(sources), ()
    names = ", ".join(f"{s.path.name} ({kinds[s]})" for s in others)
    found = f"runs of another kind than {RIG_KIND}: {names}"
    if len(others) == len(sources):
        raise DataError(
            f"no rig data, only {found}; name tables or runs of the rig (tracked walks are "
            "for calibrate-slip DATA --walks RUN)"
        )
    return [s for s in sources if s not in others], (f"left out, {found}",)


def _read_parts(
    sources: Sequence[DataSource],
    maps: Mapping[DataSource, RigColumns],
    labels: Mapping[DataSource, str],
    wanted: SlipDefinition | None,
) -> tuple[list[RigPart], dict[DataSource, str]]:
    """Read tables and runs; return also why runs are left out that were cut short too early.

    Raises:
        ZebroLabError: As in `read_part`, except a `DataError` of a run that was cut short.
    """
    parts, died = [], {}
    for source in sources:
        try:
            parts.append(read_part(source, maps[source], labels[source], wanted))
        except DataError as error:
            if not (source.is_run_folder and _is_cut_short(source.path)):
                raise
            died[source] = f"its recording was cut short, and cannot be used: {error}"
    return parts, died


def _is_cut_short(run: Path) -> bool:
    """Return whether the recorder of a run never ended it."""
    return read_manifest(run).exit_status == RECORDING


def _column_maps(
    sources: Sequence[DataSource], override: Path | None
) -> dict[DataSource, RigColumns]:
    """Return the column map of each source, which is that of the file `override` if it is given."""
    if override is not None:
        return dict.fromkeys(sources, read_columns(override))
    return {source: source.columns() for source in sources}


def _labels(sources: Sequence[DataSource]) -> list[str]:
    """Return a label for each source: file stems if distinct, else with their folder, else paths.

    The folder is relative to the one named on the command line; all labels are of one form.
    """
    folders = [source.path.relative_to(source.root).parent for source in sources]
    stems = [table_stem(source.path) for source in sources]
    schemes = (
        stems,
        [str(folder / stem) for folder, stem in zip(folders, stems, strict=True)],
        [str(source.path) for source in sources],
    )
    return next((names for names in schemes if len(set(names)) == len(names)), schemes[-1])


def _exclusion(source: DataSource) -> str | None:
    """Return why a run folder is excluded, by its manifest; None for a table or another run."""
    if not source.is_run_folder:
        return None
    excluded = read_manifest(source.path).excluded
    return None if excluded is None else excluded.get("why", "excluded")


def _bytes_of(source: DataSource) -> str:
    """Return the hash of a table's or a run's log's content; the path if that file is missing."""
    file = source.path / LOG_FILE if source.is_run_folder else source.path
    return content_hash(file) if file.is_file() else str(source.path)


def _known(
    excluded: Collection[DataSource],
    maps: Mapping[DataSource, RigColumns],
    labels: Mapping[DataSource, str],
) -> dict[str, str]:
    """Return "LABEL, which is left out" for each excluded run, by its key, which a copy shares.

    The key is a hash of the forces. Excluded runs that cannot be read are omitted.
    """
    known: dict[str, str] = {}
    for source in excluded:
        try:
            part = read_part(source, maps[source], labels[source], None)
        except (ZebroLabError, ModelError):  # it may be excluded because it is damaged
            continue
        known |= dict.fromkeys(part.keys, f"{labels[source]}, which is left out")
    return known


def _without_duplicates(
    parts: Sequence[RigPart], known: Mapping[str, str]
) -> tuple[list[RigPart], list[tuple[str, str]]]:
    """Drop runs whose key is that of a run in an earlier part or of a `known` one.

    Returns the parts that have runs left, and pairs: name of a copy, name of its original. Runs
    with equal keys within one part are kept.
    """
    seen, repeated, kept = dict(known), [], []
    for part in parts:
        keys = part.keys
        fresh = np.array([key not in seen for key in keys], dtype=bool)
        named = dict(zip(keys, part.runs.names, strict=True))
        repeated += [(name, seen[key]) for key, name in named.items() if key in seen]
        seen = {**named, **seen}
        if fresh.any():
            kept.append(part if fresh.all() else part.with_runs(fresh))
    return kept, repeated


def _require_one_definition(parts: Sequence[RigPart]) -> None:
    """Raise `DataError` if parts have slip ratios of different definitions."""
    first = parts[0]
    for part in parts:
        if part.slip.definition is not first.slip.definition:
            raise DataError(
                f"slip is '{part.slip.definition}' here and '{first.slip.definition}' in "
                f"{first.path}; calibrate them apart or choose one with --slip-definition",
                file=part.path,
            )


def _require_informative(samples: SlipSamples, parts: Sequence[RigPart]) -> None:
    """Raise `DataError` if samples are too few, or slip is constant or varies by noise alone."""
    where = parts[0].path if len(parts) == 1 else None
    trials = all(part.columns.runs.each_row for part in parts)
    least = _LEAST_TRIALS if trials else _LEAST_SAMPLES
    if len(samples) < least:
        raise DataError(
            f"{counted(len(samples), 'sample')} in all, expected at least {least}; record more"
            + ("" if trials else ", or set runs.each_row in columns.toml if rows are trials"),
            file=where,
        )
    if np.ptp(samples.slip) <= _CONSTANT_SLIP:
        raise DataError(
            f"slip ratio is {samples.slip[0]:g} in all {len(samples)} rows; "
            f"a curve needs several set-points, check the column or add other runs",
            file=where,
        )
    noise = float(np.sqrt(np.mean(slip_noise_variance(samples))))
    if np.std(samples.slip) <= _NOISE_ALONE * noise:
        raise DataError(
            f"slip ratio stays at {samples.slip.mean():.4g} within its sensors' noise of "
            f"{noise:.2g}; a curve needs several set-points, add other runs"
            + ("" if trials else ", or set runs.each_row in columns.toml if rows are trials"),
            file=where,
        )


def _notes(parts: Sequence[RigPart]) -> list[str]:
    """Return notes on slip, runs, rows left out and times, each once, then those of the parts."""
    origins = dict.fromkeys(f"slip {part.slip.origin}" for part in parts)
    rules: Counter[str] = Counter()
    for part in parts:
        rules[part.runs.rule] += len(part.runs.names)
    runs = [f"{counted(count, 'run')}, {rule}" for rule, count in rules.items()]
    others = dict.fromkeys(note for part in parts for note in part.notes)
    partial = (*_partial(parts, "time", "time"), *_partial(parts, "force_sd", "traction_force_sd"))
    return [*origins, *runs, *_rows_left_out(parts), *partial, *others]


def _rows_left_out(parts: Sequence[RigPart]) -> list[str]:
    """Return a note on the rows that `[rows] keep` left out, for each set of conditions."""
    read: Counter[str] = Counter()
    kept: Counter[str] = Counter()
    for part in parts:
        if part.columns.keep:
            conditions = " and ".join(map(str, part.columns.keep))
            read[conditions] += part.rows_read
            kept[conditions] += len(part.normal_force)
    return [f"{read[c] - kept[c]} of {read[c]} rows left out; kept where {c}" for c in read]


def _partial(parts: Sequence[RigPart], attribute: str, what: str) -> list[str]:
    """Return a note if some parts have an attribute and others None: then it is not used."""
    have = sum(getattr(part, attribute) is not None for part in parts)
    if have in (0, len(parts)):
        return []
    return [f"{len(parts) - have} of {len(parts)} files have no {what}, so none is used"]
