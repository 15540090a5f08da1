# SPDX-License-Identifier: MIT
"""Fit tracked walks, and predict each from a fit of the others (leave-one-out)."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor

import numpy as np

from model.errors import InsufficientData
from model.gait.reference import SampledReference
from model.judgement import Prediction
from model.path_draws import bent, middle_bend
from model.predict import FINE, ModelSpread, predict_paths, walk_draws
from model.robot import GRAVITY
from model.walk_fit.fit import WalkFit, fit_walks
from model.walk_fit.posterior import WalkPosterior
from model.walk_fit.prior import WalkPrior
from model.walk_fit.tracked_walk import middle
from model.walk_models import baseline_paths
from zebro_lab.calibration.posterior_file import slip_tables
from zebro_lab.calibration.slip_argument import NamedSlip
from zebro_lab.validation.judged_run import JudgedRun, judge_run
from zebro_lab.walk.prediction_file import PredictionFile
from zebro_lab.walk_fit.tracked_walks import WalkOnFile

SAMPLING = 0.1  # s between poses of a predicted path
DRAWS = 300  # of a left-out walk's band
EXACT = ModelSpread(0.0, 0.0, 0.0)

Progress = Callable[[float], None]


def fit_walks_on_file(
    walks: Sequence[WalkOnFile],
    slip: NamedSlip,
    *,
    prior: WalkPrior,
    rng: np.random.Generator,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> WalkFit:
    """Fit legs and floor to walks of one robot, with the slip law at its posterior mean.

    Args:
        walks: Tracked walks; the robot is that of the first.
        slip: Slip law named by `--slip`.
        prior: Prior of legs and floor.
        rng: Random number generator.
        executor: Where draws are walked; None for here.
        progress: Called with the fraction done, 0 to 1 [-].

    Raises:
        ModelError: `walks` is empty, a walk diverged, or the slip law is invalid at the robot's
            loads.
    """
    if not walks:
        raise InsufficientData("no walk was given; expected one or more with a track")
    robot = walks[0].robot.robot
    return fit_walks(
        robot,
        slip.traction_table(weight=robot.mass * GRAVITY),
        [walk.tracked for walk in walks],
        prior=prior,
        rng=rng,
        executor=executor,
        progress=progress,
    )


def judge_left_out(
    fit: WalkFit,
    walks: Sequence[WalkOnFile],
    slip: NamedSlip,
    *,
    rng: np.random.Generator,
    executor: Executor | None = None,
    progress: Progress = lambda _: None,
) -> tuple[JudgedRun, ...]:
    """Predict each walk from a fit of the others, and compute errors of prediction and baselines.

    Args:
        fit: Fit of all walks.
        walks: The fitted walks, in the order of the fit; a single one is not predicted.
        slip: Slip law of the fit.
        rng: Random number generator.
        executor: Where draws are walked; None for here.
        progress: Called with the fraction done, 0 to 1 [-].

    Returns:
        Errors of each walk, anchored at the first tracked pose; empty for a single walk.

    Raises:
        ZebroLabError: Draws of the slip law cannot be read, or a track cannot be scored.
        ModelError: A walk diverged.
    """
    judged = []
    for i, walk in enumerate(walks if len(walks) > 1 else ()):
        progress(i / len(walks))
        prediction = predict_from(fit.without(i), walk, slip, rng=rng, executor=executor)
        judged.append(judge_run(walk.name, prediction, walk.track, anchor=True, rng=rng))
    return tuple(judged)


def predict_from(
    posterior: WalkPosterior,
    walk: WalkOnFile,
    slip: NamedSlip,
    *,
    rng: np.random.Generator,
    index: int | None = None,
    executor: Executor | None = None,
) -> PredictionFile:
    """Predict path, band and baselines of a walk from its leg angles, without using its track.

    Args:
        posterior: Posterior of legs and floor.
        walk: The walk to predict.
        slip: Slip law.
        rng: Random number generator.
        index: Index of the walk in the posterior if it was fitted, else None.
        executor: Where draws are walked; None for here.

    Returns:
        The prediction, from time zero on; its band has 300 draws.
    """
    t = np.linspace(0.0, walk.duration, max(round(walk.duration / SAMPLING), 2) + 1)
    robot, angles = walk.robot.robot, middle(walk.legs)
    weight, spread = robot.mass * GRAVITY, posterior.prior.spread
    state = posterior.draw(DRAWS, rng=rng, walk=index)
    tables = slip_tables(slip, DRAWS, weight=weight, rng=rng)
    drawn = walk_draws(robot, walk.legs, tables, state, rng=rng)
    band = predict_paths(drawn, t, state=state, error=spread, rng=rng, executor=executor)
    likely = posterior.most_likely(walk=index)
    drawn = walk_draws(robot, angles, [slip.traction_table(weight=weight)], likely, rng=rng)
    likeliest = predict_paths(drawn, t, state=likely, error=EXACT, rng=rng, options=FINE)
    bend = middle_bend(likeliest, band)
    single = bent(
        likeliest, distance=np.array([bend.distance]), curvature=np.array([bend.curvature])
    ).draws(0)
    reference = SampledReference(t, angles.angles(t))
    direction = "left" if single.yaw[-1] >= single.yaw[0] else "right"
    baselines, notes = baseline_paths(robot, reference, direction=direction)
    return PredictionFile(Prediction(single, band, baselines), (walk.source,), walk.files, notes)
