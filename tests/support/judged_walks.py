# SPDX-License-Identifier: MIT
"""A judged walk along a line, with a band, as if it was predicted from others."""

from pathlib import Path

import numpy as np

from model.judgement import Prediction
from model.poses import Poses
from zebro_lab.track.file import TrackFile
from zebro_lab.validation.judged_run import JudgedRun, judge_run
from zebro_lab.walk.prediction_file import PredictionFile

T = np.linspace(0.0, 4.0, 9)


def judged_walk(name: str, *, off: float) -> JudgedRun:
    """Judge a path along x against a track that lies to its left.

    Args:
        name: Name of the walk.
        off: Distance of the track from the path [m].
    """
    path = Poses(T, np.column_stack([0.1 * T, 0 * T]), 0 * T)
    shifts = np.linspace(-0.1, 0.1, 41)[:, None] + 0 * T
    band = Poses(T, np.stack([path.position[:, 0] + 0 * shifts, shifts], axis=-1), 0.1 * shifts)
    track = TrackFile(Poses(T, path.position + np.array([0.0, off]), path.yaw), "real", Path("x"))
    prediction = PredictionFile(Prediction(path, band), ("sim:dynamics",), ())
    return judge_run(name, prediction, track, anchor=False, rng=np.random.default_rng(1))
