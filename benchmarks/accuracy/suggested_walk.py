# SPDX-License-Identifier: MIT
"""The walk of `suggested_plans`: a tripod of 10 s that turns left, walked with draws of the law."""

from functools import cache
from typing import Final

import numpy as np

from model.arrays import Array
from model.bayes.posterior import SlipPosterior
from model.design.targets import Target
from model.gait import tripod_angles, tripod_reference
from model.leg_state import LegState
from model.predict import ModelSpread, predict_paths, walk_draws
from model.robot import GRAVITY, Robot
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from model.walk.traction import law_table
from zebro_lab.suggest.end_pose import LoggedWalk, end_pose_target

END_POSE: Final = "end pose"
PARTS: Final = ("end x", "end y", "end heading")
DURATION: Final = 10.0  # s
WALKED: Final = 60  # draws of each fit


@cache
def walk() -> LoggedWalk:
    """Return the walk: the thesis's robot, steering factor 1.3, cycles of 2 s."""
    reference = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0)
    return LoggedWalk(Robot(), reference, DURATION, ())


def end_target(posterior: SlipPosterior, z: Array, n_draws: int) -> Target:
    """Return the end pose as target."""
    return end_pose_target(END_POSE, walk(), posterior, z, n_draws=n_draws)


def poses_of(values: Array) -> dict[str, Array]:
    """Return x [m], y [m] and heading [rad] at the end of the walk by drawn laws (w, k).

    Of few draws quantiles are rough: 2,001 normal scores with the draws' mean and standard
    deviation stand for them.
    """
    ends = _ends(values[:WALKED])
    scores = np.random.default_rng(0).standard_normal(2001)
    scores = (scores - scores.mean()) / scores.std()
    mean, sd = ends.mean(axis=0), ends.std(axis=0, ddof=1)
    return {name: mean[i] + sd[i] * scores for i, name in enumerate(PARTS)}


def true_pose() -> dict[str, float]:
    """Return the end of the walk by the true law."""
    return dict(zip(PARTS, map(float, _ends(np.array(THESIS_VALUES)[None])[0]), strict=True))


def _ends(values: Array) -> Array:
    robot = walk().robot
    weight = robot.mass * GRAVITY
    tables = [law_table(THESIS_LAW, each, weight=weight) for each in values]
    rng = np.random.default_rng(0)
    state = LegState.of_prior(len(tables), offset_sd=0.0, rng=rng)
    draws = walk_draws(robot, walk().legs, tables, state, rng=rng)
    t = np.linspace(0.0, DURATION, 101)
    exact = ModelSpread(0.0, 0.0, 0.0)
    return predict_paths(draws, t, state=state, error=exact, rng=rng).states[:, -1]
