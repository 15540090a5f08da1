# SPDX-License-Identifier: MIT
"""Validation of predicted paths against tracked ones: path errors, coverage and baselines."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from model.arrays import Array
from model.counted import counted
from model.errors import InsufficientData
from model.joint_covariance import JointCovariance
from model.metrics.consistency import FEWEST_DRAWS, Consistency, consistency
from model.metrics.path_errors import PathErrors, path_errors
from model.metrics.scores import EnsembleScores, ensemble_scores
from model.metrics.tilt import TiltErrors, tilt_errors
from model.path_draws import anchored, states_at
from model.poses import Poses, overlap
from model.walk.path import WalkPath

PREDICTION, STAND_STILL = "prediction", "stand still"


@dataclass(frozen=True)
class Prediction:
    """A predicted path, with its draws and baselines.

    Attributes:
        path: The single path, with every unknown at its central value. The mean of an ensemble is
            not used: it is shorter and less curved than any draw.
        draws: Draws of the path; None for a path without draws.
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
        path: The single path; moved to the first tracked pose if paths are anchored.
        errors: Errors of the single path.
        scores: Scores of the prediction's draws with tracker noise; of a baseline, standing still
            or a prediction without draws, those of the single path, whose energy score is its mean
            distance and whose CRPS is its mean absolute error.
        consistency: Consistency of the track with the ensemble; empty for a single path and for
            fewer than `FEWEST_DRAWS` draws.
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
        track: The tracked poses that were scored: those within the predicted path's time, without
            the first of them if paths are anchored at it.
        rows: The prediction first, then the baselines, last a robot that stands still.
        band: The draws that were scored, before tracker noise is added; if paths are anchored,
            each moved to a draw of the first tracked pose. None without draws.
    """

    track: Poses
    rows: tuple[Judged, ...]
    band: Poses | None


@dataclass(frozen=True)
class TiltJudged:
    """Comparison of predicted roll and pitch with those that an IMU measured.

    Attributes:
        errors: Bias and root mean squares of predicted minus measured, and the measured swing.
        t: Times of the IMU within the walk, shape (n,) [s].
        predicted: Predicted roll and pitch, interpolated at `t`, shape (n, 2) [rad].
        measured: Roll and pitch by the IMU, shape (n, 2) [rad].
    """

    errors: TiltErrors
    t: Array
    predicted: Array
    measured: Array


def judge(
    prediction: Prediction, track: Poses, *, anchor: bool, rng: np.random.Generator
) -> Judgement:
    """Compute errors and scores of a prediction, its baselines and standing still against a track.

    Args:
        prediction: The prediction.
        track: The track, by the prediction's clock; without a covariance it is taken as exact.
        anchor: Move every path to the first tracked pose within the predicted path's time, draws
            to draws of it by its covariance; that pose is then not scored. What errors of that pose
            and of later ones have in common is drawn once for both.
        rng: Source of randomness of tracker noise.

    Raises:
        InsufficientData: Fewer than two tracked poses to score lie within the time of the predicted
            path or of a baseline, or `anchor` is set and the first tracked pose has no heading.
        DomainError: `anchor` is set and a baseline or the draws do not cover that pose's time.
    """
    seen = track.part(overlap(track, prediction.path))
    target = seen.part(slice(1, None) if anchor else slice(None))
    if len(target) < 2:
        raise InsufficientData(
            f"{counted(len(target), 'tracked pose')} to score within the path's time (without the "
            "first where paths start from it); expected two or more"
        )
    first, at = seen.states[0], float(seen.t[0])
    if anchor and not np.isfinite(first[2]):
        raise InsufficientData("the track has no headings to start a path; pass anchor=False")

    def placed(path: Poses) -> Poses:
        """Return the draws of a path, anchored at the track's first pose if asked for."""
        return anchored(path.draws(), first, at=at, rng=rng) if anchor else path.draws()

    candidates = {PREDICTION: prediction.path, **prediction.baselines}
    rows = [_judge_path(key, placed(path), target) for key, path in candidates.items()]
    rows.append(_judge_path(STAND_STILL, _standing(seen), target))
    band = prediction.draws
    if band is not None:
        errors = _tracker_errors(seen, len(band.yaw), rng)
        if anchor:
            band = anchored(band, first + errors[:, 0], at=at, rng=rng)
        rows[0] = _judge_band(rows[0], band, target, errors[:, len(seen) - len(target) :])
    return Judgement(target, tuple(rows), band)


def judge_tilt(walk: WalkPath, t: Array, angles: Array) -> TiltJudged:
    """Compute errors of a walk's roll and pitch against an IMU's, at the IMU's times in the walk.

    Args:
        walk: The predicted walk.
        t: Times of the IMU by the walk's clock, shape (n,) [s].
        angles: Roll and pitch by the IMU, shape (n, 2) [rad].

    Raises:
        InsufficientData: Fewer than ten of the IMU's times lie within the walk.
    """
    errors, inside = tilt_errors(walk.t, walk.orientation[:, :2], t, angles)
    t = t[inside]
    predicted = np.column_stack([np.interp(t, walk.t, a) for a in walk.orientation[:, :2].T])
    return TiltJudged(errors, t, predicted, angles[inside])


def _judge_path(name: str, path: Poses, target: Poses) -> Judged:
    """Compute errors and scores of the only draw in `path` at the tracked poses `target`."""
    single = path.draws(0)
    scores = ensemble_scores(states_at(path, target.t), target.states)
    return Judged(name, single, path_errors(single, target), scores)


def _tracker_errors(seen: Poses, count: int, rng: np.random.Generator) -> Array:
    """Draw errors, true minus tracked, of all tracked poses, shape (count, n, 3) [m, m, rad].

    They are 0 if the track has no covariance.
    """
    none = JointCovariance.independent(np.zeros((len(seen), 3, 3)))
    return (seen.joint or none).draw(count, rng=rng)


def _judge_band(single: Judged, band: Poses, target: Poses, errors: Array) -> Judged:
    """Replace the scores of a single path by those of an ensemble with tracker noise.

    Consistency is added if there are `FEWEST_DRAWS` draws or more.

    Args:
        single: Errors and scores of the single path.
        band: Draws of the path.
        target: The tracked poses that are scored, n of them.
        errors: The tracker's errors, true minus tracked, one draw for each path, shape (m, n, 3).
    """
    seen = states_at(band, target.t) - errors
    enough = len(seen) >= FEWEST_DRAWS
    return replace(
        single,
        scores=ensemble_scores(seen, target.states),
        consistency=consistency(seen, target.states) if enough else (),
    )


def _standing(seen: Poses) -> Poses:
    """Return a path, as one draw, that stays at the first of the tracked poses `seen`."""
    n = len(seen)
    position = np.broadcast_to(seen.position[0], (1, n, 2))
    return Poses(seen.t, position, np.full((1, n), seen.yaw[0]))
