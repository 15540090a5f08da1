# SPDX-License-Identifier: MIT
"""Predictions and tracks in, validation folder out."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from zebro_lab.errors import NotFound, SettingsError
from zebro_lab.provenance import file_hashes
from zebro_lab.track_file import read_track
from zebro_lab.track_folder import TRACK_CSV
from zebro_lab.validation import PREDICTION, RunJudged, judge_run, read_prediction
from zebro_lab.validation_folder import Summary, summarise_runs, write_validation
from zebro_lab.walk_folder import PATH_CSV
from zebro_lab.walking import Watcher

TRACK = "track"


@dataclass(frozen=True)
class ValidateRequest:
    """What is asked of a validation.

    Attributes:
        pairs: Prediction and track of each walk.
        out: Folder to write.
        anchor: Start each path from the first tracked pose, which is then not scored.
        time_offset: Added to the tracks' times [s].
        seed: Seed of everything random.
    """

    pairs: tuple[tuple[Path, Path], ...]
    out: Path
    anchor: bool = True
    time_offset: float = 0.0
    seed: int = 1


@dataclass(frozen=True)
class Validated:
    """A finished validation.

    Attributes:
        runs: Every walk, judged.
        summary: Means over walks; empty for one.
        source: Where predictions and tracks come from.
    """

    runs: tuple[RunJudged, ...]
    summary: tuple[Summary, ...]
    source: str


def pairs_of_run(run: Path) -> tuple[Path, Path]:
    """Return the prediction and the track of a run folder.

    Raises:
        NotFound: One of them is missing.
    """
    prediction, track = run / PREDICTION, run / TRACK
    if not (prediction / PATH_CSV).is_file():
        raise NotFound(f"{prediction}: no prediction; predict {run} --out {prediction} makes it")
    if not (track / TRACK_CSV).is_file():
        raise NotFound(f"{track}: no {TRACK_CSV}; track the run's photographs into it first")
    return prediction, track


def validate(request: ValidateRequest, watcher: Watcher) -> Validated:
    """Judge predictions against tracks and write the folder.

    Raises:
        ZebroLabError: A file is missing, or prediction and track share no time.
        ModelError: A path cannot be judged.
    """
    if not request.pairs:
        raise SettingsError("missing: nothing to validate", key="--predicted, --track")
    rng = np.random.default_rng(request.seed)
    runs, files, sources = [], [], []
    names = _names([predicted for predicted, _ in request.pairs])
    for i, (name, (predicted, tracked)) in enumerate(zip(names, request.pairs, strict=True)):
        watcher.step("judging", i / len(names))
        prediction, track = read_prediction(predicted), read_track(tracked)
        judged = judge_run(
            name, prediction, track,
            anchor=request.anchor, time_offset=request.time_offset, rng=rng,
        )  # fmt: skip
        runs.append(judged)
        files += [*prediction.files, track.file]
        sources += [prediction.source, track.source]
    summary = tuple(summarise_runs(runs, rng=rng)) if len(runs) > 1 else ()
    source = ", ".join(sorted(set(sources)))
    write_validation(
        request.out,
        runs,
        summary=summary,
        settings={
            "anchor": request.anchor, "time_offset": request.time_offset, "seed": request.seed,
        },
        inputs=file_hashes(dict.fromkeys(files)),
        source=source,
    )  # fmt: skip
    return Validated(tuple(runs), summary, source)


def _names(paths: Sequence[Path]) -> list[str]:
    """Name walks by their folders, with a number where two share a name."""
    names = []
    for path in paths:
        place = path if path.is_dir() else path.with_suffix("")
        absolute = place.absolute()
        names.append(absolute.parent.name if absolute.name == PREDICTION else absolute.name)
    return [
        name if names.count(name) == 1 else f"{name}-{names[: i + 1].count(name)}"
        for i, name in enumerate(names)
    ]
