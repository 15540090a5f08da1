# SPDX-License-Identifier: MIT
"""A run's prediction judged against its track, with what a person is told of it."""

from dataclasses import dataclass

import numpy as np

from model.judgement import Judgement, TiltJudged, judge
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.track.file import TrackFile
from zebro_lab.validation.shared_clock import shared_time
from zebro_lab.walk.prediction_file import PredictionFile


@dataclass(frozen=True)
class JudgedRun(Judgement):
    """The judgement of a named walk.

    Attributes:
        name: Name of the walk.
        notes: For a person, one line each.
        tilt: Roll and pitch against the IMU's; None where the run has none.
    """

    name: str
    notes: tuple[str, ...]
    tilt: TiltJudged | None = None


def judge_run(
    name: str,
    predicted: PredictionFile,
    track: TrackFile,
    *,
    anchor: bool,
    rng: np.random.Generator,
) -> JudgedRun:
    """Judge a prediction and the baselines against a track.

    Args:
        name: Name of the walk.
        predicted: What was predicted.
        track: What was tracked, by the prediction's clock.
        anchor: Start every path from the first tracked pose, which is then not scored.
        rng: Source of randomness.

    Raises:
        DataError: Track and prediction share too little time.
        SettingsError: Paths should start from a track without headings.
    """
    inside = shared_time(track.poses, predicted.prediction.path, file=track.file)
    if inside.sum() - anchor < 2:
        raise DataError("leaves fewer than two poses to score", file=track.file)
    if anchor and not np.isfinite(track.poses.yaw[inside][0]):
        raise SettingsError(
            "the track has no headings, so its first pose cannot start a prediction; use "
            "--no-anchor and look at the aligned errors",
            key="--anchor",
        )
    judgement = judge(predicted.prediction, track.poses, anchor=anchor, rng=rng)
    left_out = len(track.poses) - int(inside.sum())
    notes = (*track.notes, *predicted.notes)
    if left_out:
        notes += (f"{left_out} tracked poses lie outside the predicted time and are not scored",)
    return JudgedRun(judgement.track, judgement.rows, judgement.band, name, notes)
