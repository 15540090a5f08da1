# SPDX-License-Identifier: MIT
"""Fit tracked walks, and predict each from a fit of the others (leave-one-out)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from model.bayes.walks.fit import WalkFit, fit_walks
from model.bayes.walks.misfit import middle
from model.bayes.walks.posterior import WalkPosterior
from model.bayes.walks.prior import WalkPrior
from model.errors import InsufficientData
from model.gait.reference import SampledReference
from model.judgement import Prediction
from model.leg_state import LegState
from model.poses import Poses
from model.predict import FINE, ModelSpread, predict_paths, walk_draws
from model.robot import GRAVITY
from model.slip.law import Array
from model.walk_models import baseline_paths
from zebro_lab.calibration.slip_argument import NamedSlip
from zebro_lab.calibration.slip_draws import slip_tables
from zebro_lab.validation.judged_run import JudgedRun, judge_run
from zebro_lab.walk.prediction_file import PredictionFile
from zebro_lab.walk_fit.tracked_walks import WalkOnFile

SAMPLING = 0.1  # s between poses of a predicted path
DRAWS = 300  # of a left-out walk's band
EXACT = ModelSpread(0.0, 0.0, 0.0)

Progress = Callable[[float], None]


@dataclass(frozen=True)
class WalksFitted:
    """Posterior after walks, and leave-one-out predictions.

    Attributes:
        walks: The walks.
        posterior: The posterior of legs and floor.
        left_out: Each walk predicted from a fit of the others, with its errors; empty for a single
            walk.
    """

    walks: tuple[WalkOnFile, ...]
    posterior: WalkPosterior
    left_out: tuple[JudgedRun, ...]


def fit_walks_on_file(
    walks: Sequence[WalkOnFile],
    slip: NamedSlip,
    *,
    prior: WalkPrior,
    rng: np.random.Generator,
    threads: int = 2,
    progress: Progress | None = None,
) -> WalkFit:
    """Fit legs and floor to walks of one robot, with the slip law at its posterior mean.

    Args:
        walks: The walks.
        slip: The rig's calibration.
        prior: Prior of legs and floor.
        rng: Random number generator.
        threads: Number of walks computed in parallel.
        progress: Called with the fraction done, 0 to 1 [-].

    Raises:
        ModelError: There is no walk, or one diverged.
    """
    if not walks:
        raise InsufficientData("no walk to fit; name one or more with a track")
    robot = walks[0].robot.robot
    return fit_walks(
        robot,
        slip.traction_table(weight=robot.mass * GRAVITY),
        [walk.tracked for walk in walks],
        prior=prior,
        rng=rng,
        threads=threads,
        progress=progress,
    )


def fit_and_leave_out(
    walks: Sequence[WalkOnFile],
    slip: NamedSlip,
    *,
    prior: WalkPrior,
    rng: np.random.Generator,
    threads: int = 2,
    progress: Progress | None = None,
) -> WalksFitted:
    """Fit all walks, then predict each from a fit of the others.

    Args:
        walks: The walks.
        slip: The rig's calibration.
        prior: Prior of legs and floor.
        rng: Random number generator.
        threads: Number of walks computed in parallel.
        progress: Called with the fraction done, 0 to 1 [-].

    Raises:
        ModelError: There is no walk, or one diverged.
    """
    tell = progress or (lambda _: None)
    fit = fit_walks_on_file(
        walks, slip, prior=prior, rng=rng, threads=threads, progress=lambda done: tell(0.7 * done)
    )
    judged = []
    for i, walk in enumerate(walks if len(walks) > 1 else ()):
        tell(0.7 + 0.3 * i / len(walks))
        judged.append(judge_from(fit.without(i), walk, slip, rng=rng, threads=threads))
    return WalksFitted(tuple(walks), fit.posterior, tuple(judged))


def judge_from(
    posterior: WalkPosterior,
    walk: WalkOnFile,
    slip: NamedSlip,
    *,
    rng: np.random.Generator,
    draws: int = DRAWS,
    index: int | None = None,
    threads: int = 2,
) -> JudgedRun:
    """Predict a walk from a posterior, and compute errors against its track, also of baselines.

    Args:
        posterior: Posterior after other walks.
        walk: The walk.
        slip: The rig's calibration.
        rng: Random number generator.
        draws: Number of paths in the band.
        index: The walk's index in the posterior if it was fitted, else None.
        threads: Number of walks computed in parallel.
    """
    prediction = predict_from(
        posterior, walk, slip, rng=rng, draws=draws, index=index, threads=threads
    )
    return judge_run(walk.name, prediction, walk.track, anchor=True, rng=rng)


def predict_from(
    posterior: WalkPosterior,
    walk: WalkOnFile,
    slip: NamedSlip,
    *,
    rng: np.random.Generator,
    draws: int = DRAWS,
    index: int | None = None,
    threads: int = 2,
) -> PredictionFile:
    """Predict a walk from a posterior, and by the baselines, without using its track.

    Args:
        posterior: Posterior after other walks.
        walk: The walk.
        slip: The rig's calibration.
        rng: Random number generator.
        draws: Number of paths in the band.
        index: The walk's index in the posterior if it was fitted, else None.
        threads: Number of walks computed in parallel.
    """
    t = np.linspace(0.0, walk.duration, max(round(walk.duration / SAMPLING), 2) + 1)
    state = posterior.draw(draws, rng=rng, walk=index)
    band = _walked(walk, slip, state, t, posterior.prior.spread, rng, threads)
    single = _middle_path(walk, slip, posterior.most_likely(walk=index), t, rng)
    robot = walk.robot.robot
    angles = middle(walk.legs)
    told = SampledReference(t, angles.angles(t) + robot.leg_offset)
    turned = single.yaw[-1] - single.yaw[0]
    baselines, notes = baseline_paths(robot, told, direction="left" if turned >= 0 else "right")
    return PredictionFile(Prediction(single, band, baselines), walk.source, walk.files, notes)


def _walked(
    walk: WalkOnFile,
    slip: NamedSlip,
    state: LegState,
    t: Array,
    error: ModelSpread,
    rng: np.random.Generator,
    threads: int,
) -> Poses:
    robot = walk.robot.robot
    tables = slip_tables(slip, len(state), weight=robot.mass * GRAVITY, rng=rng)
    drawn = walk_draws(robot, walk.legs, tables, state, rng=rng)
    return predict_paths(drawn, t, state=state, error=error, rng=rng, threads=threads)


def _middle_path(
    walk: WalkOnFile, slip: NamedSlip, state: LegState, t: Array, rng: np.random.Generator
) -> Poses:
    """Compute the path with all unknown parameters at their central values."""
    plain = replace(walk, legs=middle(walk.legs))
    robot = walk.robot.robot
    table = slip.traction_table(weight=robot.mass * GRAVITY)
    drawn = walk_draws(robot, plain.legs, [table], state, rng=rng)
    paths = predict_paths(drawn, t, state=state, error=EXACT, rng=rng, threads=1, options=FINE)
    return paths.draws(0)
