# SPDX-License-Identifier: MIT
"""Validation of predicted paths against tracked ones: path errors, coverage and baselines."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from model.errors import InsufficientData
from model.metrics.consistency import FEWEST_DRAWS, Consistency, consistency
from model.metrics.path_errors import PathErrors, path_errors
from model.metrics.scores import EnsembleScores, ensemble_scores, with_tracker_noise
from model.metrics.tilt import TiltErrors, tilt_errors
from model.path_draws import anchored, states_at
from model.poses import Poses, overlap
from model.slip.law import Array
from model.walk.path import WalkPath

PREDICTION, STAND_STILL = "prediction", "stand still"


@dataclass(frozen=True)
class Prediction:
    """A predicted path.

    Attributes:
        path: The single path, with every unknown at its central value. The mean of an ensemble is
            not used: it is shorter and less curved than any draw.
        draws: Draws of the path; None for a path alone.
        baselines: Paths of the same leg angles by simpler models, by the models' names.
    """

    path: Poses
    draws: Poses | None = None
    baselines: Mapping[str, Poses] = field(default_factory=dict)


@dataclass(frozen=True)
class Judged:
    """Errors and scores of one path, or ensemble, against a track.

    Attributes:
        name: `PREDICTION`, `STAND_STILL` or a baseline's name.
        path: The path, started from the first tracked pose.
        errors: Its errors.
        scores: Its scores; those of a single path are absolute errors.
        consistency: The track against the ensemble's own draws; empty for a single path.
    """

    name: str
    path: Poses
    errors: PathErrors
    scores: EnsembleScores
    consistency: tuple[Consistency, ...] = ()


@dataclass(frozen=True)
class Judgement:
    """Errors and scores of a prediction and its baselines against a track.

    Attributes:
        track: The tracked poses that were scored; the first is left out when paths start from it.
        rows: The prediction first, then the baselines.
        band: The draws that were scored; None for a path alone.
    """

    track: Poses
    rows: tuple[Judged, ...]
    band: Poses | None


@dataclass(frozen=True)
class TiltJudged:
    """Comparison of predicted roll and pitch with an IMU's.

    Attributes:
        errors: Summary of the differences.
        t: Times compared, shape (n,) [s].
        predicted: Roll and pitch of the prediction, shape (n, 2) [rad].
        measured: The IMU's, shape (n, 2) [rad].
    """

    errors: TiltErrors
    t: Array
    predicted: Array
    measured: Array


def judge(
    prediction: Prediction, track: Poses, *, anchor: bool, rng: np.random.Generator
) -> Judgement:
    """Compute errors and scores of a prediction and its baselines against a track.

    Args:
        prediction: The prediction.
        track: The track, by the prediction's clock; without a covariance it is taken as exact.
        anchor: Start every path from the first tracked pose, which is then not scored.
        rng: Source of randomness.

    Raises:
        InsufficientData: Track and prediction share too little time, or the track that paths
            should start from has no headings.
    """
    seen = track.part(overlap(track, prediction.path))
    target = seen.part(slice(1, None) if anchor else slice(None))
    if len(target) < 2:
        raise InsufficientData("leaves fewer than two poses to score")
    first, at = seen.states[0], float(seen.t[0])
    if anchor and not np.isfinite(first[2]):
        raise InsufficientData("the track has no headings, so its first pose cannot start a path")
    covariance = np.zeros((len(seen), 3, 3)) if seen.covariance is None else seen.covariance

    def placed(path: Poses) -> Poses:
        return anchored(path.draws(), first, at=at, rng=rng) if anchor else path.draws()

    candidates = {PREDICTION: prediction.path, **prediction.baselines}
    rows = [_judge_path(key, placed(path), target) for key, path in candidates.items()]
    rows.append(_judge_path(STAND_STILL, _standing(seen), target))
    band = prediction.draws
    if band is not None:
        if anchor:
            band = anchored(band, first, at=at, covariance=covariance[0], rng=rng)
        rows[0] = _judge_band(rows[0], band, target, covariance[len(seen) - len(target) :], rng)
    return Judgement(target, tuple(rows), band)


def judge_tilt(walk: WalkPath, t: Array, angles: Array) -> TiltJudged:
    """Compare roll and pitch of a walk with an IMU's by the same clock.

    Args:
        walk: The walk.
        t: Times of the IMU, shape (n,) [s].
        angles: Its roll and pitch, shape (n, 2) [rad].

    Raises:
        InsufficientData: They share too little time.
    """
    errors, inside = tilt_errors(walk.t, walk.orientation[:, :2], t, angles)
    t = t[inside]
    predicted = np.column_stack([np.interp(t, walk.t, a) for a in walk.orientation[:, :2].T])
    return TiltJudged(errors, t, predicted, angles[inside])


def _judge_path(name: str, path: Poses, target: Poses) -> Judged:
    single = path.draws(0)
    scores = ensemble_scores(states_at(path, target.t), target.states)
    return Judged(name, single, path_errors(single, target), scores)


def _judge_band(
    single: Judged, band: Poses, target: Poses, noise: Array, rng: np.random.Generator
) -> Judged:
    draws = states_at(band, target.t)
    seen = with_tracker_noise(draws, noise, rng=rng)
    enough = len(draws) >= FEWEST_DRAWS
    return replace(
        single,
        scores=ensemble_scores(seen, target.states),
        consistency=consistency(draws, target.states, noise, rng=rng) if enough else (),
    )


def _standing(seen: Poses) -> Poses:
    """Return the path of a robot that stays at its first pose."""
    n = len(seen)
    position = np.broadcast_to(seen.position[0], (1, n, 2))
    return Poses(seen.t, position, np.full((1, n), seen.yaw[0]))
