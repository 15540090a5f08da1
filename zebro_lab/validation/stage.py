# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab validate`: compare predictions with tracks, write the validation folder."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from model.errors import InsufficientData
from model.judgement import judge_tilt
from model.progress import Watcher
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.files.names import PATH_CSV
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.replacement import settle
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.runs.counted_once import content_hash, duplicates_note, first_of_each
from zebro_lab.runs.recorded_legs import is_recorded
from zebro_lab.runs.recorded_tilt import read_recorded_tilt
from zebro_lab.track.file import read_track
from zebro_lab.track.folder import TRACK_CSV
from zebro_lab.track.photographs import photos_of_track
from zebro_lab.validation.folder import VALIDATION, Summary, summarise_runs, write_validation
from zebro_lab.validation.judged_run import JudgedRun, judge_run
from zebro_lab.validation.pictures import ShownRun
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.shared_clock import estimated_clock, given_clock
from zebro_lab.walk.folder import PREDICTION
from zebro_lab.walk.prediction_file import PredictionFile, read_prediction

TRACK = "track"


@dataclass(frozen=True)
class Validated:
    """A finished validation.

    Attributes:
        runs: Errors of each walk.
        summary: Means over walks; empty for one.
        source: Where predictions and tracks come from.
    """

    runs: tuple[JudgedRun, ...]
    summary: tuple[Summary, ...]
    source: str


def pairs_of_run(run: Path) -> tuple[Path, Path]:
    """Return the prediction and the track of a run folder.

    Raises:
        NotFound: One of them is missing.
    """
    prediction, track = settle(run / PREDICTION), settle(run / TRACK)
    if not (prediction / PATH_CSV).is_file():
        raise NotFound(f"{prediction}: no prediction; predict {run} --out {prediction} makes it")
    if not (track / TRACK_CSV).is_file():
        raise NotFound(f"{track}: no {TRACK_CSV}; track the run's photographs into it first")
    return prediction, track


def validate(request: ValidateRequest, watcher: Watcher) -> Validated:
    """Compute the errors of predicted paths against tracks and write the validation folder.

    Args:
        request: Pairs of prediction and track, settings, and the folder to write.
        watcher: Receives progress.

    Returns:
        Results of each run, means over runs, and the source of the data.

    Raises:
        ZebroLabError: A file is missing, or prediction and track do not overlap in time.
        ModelError: The errors of a path cannot be computed.
    """
    given = zip(request.predicted, request.track, strict=True)
    asked = (*map(pairs_of_run, request.runs), *given)
    if not asked:
        raise SettingsError("missing: nothing to validate", key="--predicted, --track")
    inputs = [path for pair in asked for path in pair]
    require_replaceable(request.folder, VALIDATION, inputs=inputs)
    pairs, repeated = first_of_each(asked, key=_content)
    told = duplicates_note("walks", [(one[0], other[0]) for one, other in repeated])
    rng = np.random.default_rng(request.seed)
    shown, files, sources = [], [], []
    names = _names([predicted for predicted, _ in pairs])
    for i, (name, (predicted, tracked)) in enumerate(zip(names, pairs, strict=True)):
        watcher.step("judging", i / len(names))
        prediction, track = read_prediction(predicted), read_track(tracked)
        clock = (
            estimated_clock(track, prediction.prediction.path)
            if request.estimate_offset
            else given_clock(track, request.time_offset)
        )
        judged = judge_run(name, prediction, clock.track, anchor=request.anchor, rng=rng)
        one, read = _with_surroundings(judged, prediction, tracked, clock.offset)
        shown.append(one if i else _noted(one, told))
        files += [*prediction.files, track.file, *read]
        sources += [prediction.source, track.source]
    runs = [each.run for each in shown]
    summary = tuple(summarise_runs(runs, rng=rng)) if len(runs) > 1 else ()
    source = ", ".join(sorted(set(sources)))
    write_validation(
        request.folder,
        shown,
        summary=summary,
        settings={
            "anchor": request.anchor,
            "time_offset": {each.run.name: each.time_offset for each in shown},
            "time_offset_estimated": request.estimate_offset,
            "seed": request.seed,
        },
        inputs=file_hashes(dict.fromkeys(files)),
        source=source,
    )  # fmt: skip
    return Validated(tuple(runs), summary, source)


def _content(pair: tuple[Path, Path]) -> tuple[str, ...]:
    """Return hashes of a walk's predicted and tracked path, by which copies are recognised."""
    return tuple(
        content_hash(file) if file.is_file() else str(file)
        for path, name in zip(pair, (PATH_CSV, TRACK_CSV), strict=True)
        for file in [settle(path) / name if path.is_dir() else path]
    )


def _noted(shown: ShownRun, told: Sequence[str]) -> ShownRun:
    run = shown.run
    return replace(shown, run=replace(run, notes=(*told, *run.notes)))


def _with_surroundings(
    judged: JudgedRun, prediction: PredictionFile, tracked: Path, offset: float
) -> tuple[ShownRun, tuple[Path, ...]]:
    """Add errors against the run's IMU, and photographs of its track; also return files read."""
    notes, files, photos = list(judged.notes), (), None
    run = tracked.parent if tracked.name == TRACK else None
    measured = read_recorded_tilt(run) if run is not None and is_recorded(run) else None
    if measured is not None and prediction.walk is not None:
        try:
            judged = replace(
                judged, tilt=judge_tilt(prediction.walk.path, measured.t, measured.angles)
            )
            files = measured.files
        except InsufficientData as error:
            notes.append(f"roll and pitch are not compared: {error}")
    try:
        photos = photos_of_track(tracked)
    except (NotFound, DataError) as error:
        notes.append(f"photographs are not shown: {error}")
    judged = replace(judged, notes=tuple(notes))
    return ShownRun(judged, prediction, photos, offset), files


def _names(paths: Sequence[Path]) -> list[str]:
    """Name walks by their folders, numbered if several have the same name."""
    names = []
    for path in paths:
        place = path if path.is_dir() else path.with_suffix("")
        absolute = place.absolute()
        names.append(absolute.parent.name if absolute.name == PREDICTION else absolute.name)
    return [
        name if names.count(name) == 1 else f"{name}-{names[: i + 1].count(name)}"
        for i, name in enumerate(names)
    ]
