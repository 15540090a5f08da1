# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab validate`: compare predictions with tracks, write the validation folder."""

from dataclasses import dataclass, replace

import numpy as np

from model.errors import InsufficientData
from model.judgement import judge_tilt
from model.tasks import Watcher
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.validation.folder import VALIDATION, Summary, summarise_runs, write_validation
from zebro_lab.validation.judged_run import JudgedRun, judge_run
from zebro_lab.validation.predicted_walks import (
    PredictedWalk,
    ShownRun,
    pairs_of_runs,
    read_predicted_walks,
)
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.shared_clock import estimated_clock, shifted


@dataclass(frozen=True)
class Validated:
    """A finished validation.

    Attributes:
        runs: Errors of each walk.
        summary: Means of metrics over walks; empty for a single walk.
        source: Sources of predictions and tracks, joined by commas.
    """

    runs: tuple[JudgedRun, ...]
    summary: tuple[Summary, ...]
    source: str


def validate(request: ValidateRequest, watcher: Watcher) -> Validated:
    """Compute the errors of predicted paths against tracks and write the validation folder.

    Args:
        request: Pairs of prediction and track, settings, and the folder to write.
        watcher: Receives progress.

    Returns:
        Errors of each run, means over runs, and the source of the data.

    Raises:
        ZebroLabError: Nothing is named, a file is missing or damaged, the folder cannot be
            replaced, the clock's offset is not determined, or a pair does not overlap in time.
        ModelError: The errors of a path cannot be computed.
        ValueError: There are not as many tracks as predictions.
    """
    given = zip(request.predicted, request.track, strict=True)
    chosen, left_out = pairs_of_runs(request.runs)
    asked = (*chosen, *given)
    if not asked:
        raise SettingsError("missing: give run folders or both", key="--predicted, --track")
    inputs = [path for pair in asked for path in pair]
    require_replaceable(request.folder, VALIDATION, inputs=inputs)
    watcher.step("reading", None)
    walks = read_predicted_walks(asked, notes=left_out)
    rng = np.random.default_rng(request.seed)
    shown = []
    for i, walk in enumerate(walks):
        watcher.step("judging", i / len(walks))
        shown.append(_judge(walk, request, rng))
    runs = tuple(each.run for each in shown)
    summary = tuple(summarise_runs(runs, rng=rng)) if len(runs) > 1 else ()
    files = [file for walk, run in zip(walks, runs, strict=True) for file in walk.files_of(run)]
    source = ", ".join(sorted({each for walk in walks for each in walk.sources}))
    settings = {
        "anchor": request.anchor,
        "time_offset": {each.run.name: each.time_offset for each in shown},
        "time_offset_estimated": request.estimate_offset,
        "seed": request.seed,
    }
    write_validation(
        request.folder, shown, summary=summary, settings=settings,
        inputs=file_hashes(dict.fromkeys(files)), source=source, form=request.form,
    )  # fmt: skip
    return Validated(runs, summary, source)


def _judge(walk: PredictedWalk, request: ValidateRequest, rng: np.random.Generator) -> ShownRun:
    """Shift a track's clock; compute errors of path, and of roll and pitch if there is an IMU."""
    offset, tilt, prediction = request.time_offset, None, walk.prediction
    if request.estimate_offset:
        track, offset = estimated_clock(walk.track, prediction.prediction.path)
    else:
        track = shifted(walk.track, offset)
    judged = judge_run(walk.name, prediction, track, anchor=request.anchor, rng=rng)
    notes = [*walk.duplicates, *judged.notes]
    if walk.tilt is not None and prediction.walk is not None:
        try:
            tilt = judge_tilt(prediction.walk.path, walk.tilt.t, walk.tilt.angles)
            notes.extend(walk.tilt.notes)
        except InsufficientData as error:
            notes.append(f"roll and pitch are not compared: {error}")
    judged = replace(judged, tilt=tilt, notes=(*notes, *walk.not_shown))
    return ShownRun(judged, prediction, walk.photos, offset)
