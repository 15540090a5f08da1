# SPDX-License-Identifier: MIT
"""Predict paths with uncertainty from a robot, its leg log and its slip law.

Four uncertainties spread a path: the slip law's posterior; how much traction across the legs'
rolling direction differs from that along it; the legs' angles (each leg's constant offset, and the
angle between two counts of a coarse encoder); and the error of the walking model, here an error of
distance and one of curvature.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference
from model.leg_state import LegState, law_in, robot_in
from model.path_draws import bent
from model.poses import Poses
from model.robot import Robot
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import WalkDraw, walk_ensemble
from model.walk.ground import FLAT, Ground
from model.walk.traction import TractionTable

STEPS = (0.005, 0.0025, 0.00125)  # s; an ensemble uses the largest one that has converged
SAME_PATH = 0.005  # share of the mean length by which halving the step may move the mean end
COMPARED, COMPARED_TIMES = 8, 101  # draws, and poses of each, that are walked to choose the step
# Of the single path; with a wrongly mounted leg the error of its turn is within 1 %.
FINE = DynamicsOptions(dt=0.001)
MOST_MOTIONS = 300  # a motion costs as much as its walk, and contributes least to the spread


@dataclass(frozen=True)
class ModelSpread:
    """Error of the walking model, constant along a walk.

    Stiffness and damping of the contacts matter for gaits that stand on more legs than statics can
    load, or whose legs take over at unequal heights, and hardly for other gaits. Both are therefore
    drawn. The defaults of `distance` and `curvature`, the same for every gait, are root mean
    squares of the differences from an independent engine's walks.

    Attributes:
        distance: Standard deviation of the relative error of distance [-].
        curvature: Standard deviation of the error of curvature [rad/m].
        contacts: Standard deviation of the logarithms of the contacts' stiffness and damping [-].

    Raises:
        DomainError: A standard deviation is negative or not finite.
    """

    distance: float = 0.003
    curvature: float = 0.004
    contacts: float = float(np.log(2.0))

    def __post_init__(self) -> None:
        """Check that the standard deviations are finite and not negative."""
        for name in ("distance", "curvature", "contacts"):
            if not (getattr(self, name) >= 0 and np.isfinite(getattr(self, name))):
                raise DomainError(
                    f"the standard deviation '{name}' of the model's error is "
                    f"{getattr(self, name):g}; expected a finite number of zero or more"
                )


def walk_draws(
    robot: Robot,
    legs: LegReference | InexactLog,
    tables: Sequence[TractionTable],
    state: LegState,
    *,
    rng: np.random.Generator,
    ground: Ground = FLAT,
) -> list[WalkDraw]:
    """Combine each draw of the legs' state with a slip law and a leg motion to one walk's inputs.

    Args:
        robot: The robot as described.
        legs: Leg angles from time zero on; of an inexact log `MOST_MOTIONS` motions at most are
            drawn, and repeated in turn beyond.
        tables: Draws of the slip law, repeated in turn when fewer than those of the state.
        state: Draws of the legs' state. Offsets and arc change the robot; grip, slip stiffness and
            post-peak drop scale the law, lateral grip and stiffness its traction across the legs'
            rolling direction; steering and stride are for `predict_paths`.
        rng: Source of randomness of the motions.
        ground: The ground.
    """
    drawn = motions(legs, min(len(state), MOST_MOTIONS), rng)
    return [
        WalkDraw(
            robot_in(robot, state, i),
            drawn[i % len(drawn)],
            law_in(tables[i % len(tables)], state, i),
            ground=ground,
        )
        for i in range(len(state))
    ]


def motions(
    legs: LegReference | InexactLog, n: int, rng: np.random.Generator
) -> Sequence[LegReference]:
    """Draw n leg motions that agree with an inexact log; other leg angles are one motion.

    Args:
        legs: Leg angles; without quantisation the result has `legs` as its only element.
        n: Number of motions of an inexact log.
        rng: Source of randomness.
    """
    return [legs.smooth(rng) for _ in range(n)] if isinstance(legs, InexactLog) else [legs]


def ensemble_step(
    draws: Sequence[WalkDraw], *, duration: float, executor: Executor | None = None
) -> DynamicsOptions:
    """Choose the largest step of `STEPS` at which the ensemble's mean end point has converged.

    Converged: halving the step moves it by at most `SAME_PATH` of the mean path length. If no step
    has, the smallest is returned. A single path errs by 0.3 % of its length at 5 ms, which is small
    against the spread of the draws; an error that all paths share is not. 5 ms shifts the end of a
    tripod by 0.2 % of the path, of a slow tetrapod, whose loads oscillate between four legs, by
    0.4 %, and of one that hops, in cycles of 0.6 s, by 22 %.

    Args:
        draws: The ensemble; only its first `COMPARED` draws are walked.
        duration: Time walked; 5 ms if shorter [s].
        executor: Where draws are walked; None for here.

    Raises:
        DomainError: There is no draw, or the duration is not finite.
        WalkError: A walk diverged, or a robot cannot stand at its start.
    """
    t = np.linspace(0.0, max(duration, STEPS[0]), COMPARED_TIMES)
    means: dict[float, Array] = {}
    for dt in STEPS:
        options = DynamicsOptions(dt=dt)
        paths = walk_ensemble(draws[:COMPARED], t, options=options, executor=executor).poses
        means[dt] = paths.position[:, -1].mean(axis=0)
        length = np.linalg.norm(np.diff(paths.position, axis=1), axis=2).sum(axis=1).mean()
        larger = 2 * dt
        if larger in means and np.linalg.norm(means[dt] - means[larger]) <= SAME_PATH * length:
            return DynamicsOptions(dt=larger)
    return DynamicsOptions(dt=STEPS[-1])


def predict_paths(
    draws: Sequence[WalkDraw],
    t: Array,
    *,
    state: LegState,
    error: ModelSpread,
    rng: np.random.Generator,
    executor: Executor | None = None,
    options: DynamicsOptions | None = None,
    progress: Callable[[float], None] | None = None,
) -> Poses:
    """Compute the path of every draw, bent by its steering, its stride and a drawn model error.

    Args:
        draws: Inputs of m walks; `with_contacts` draws stiffness and damping of the contacts.
        t: Times of the poses, increasing, none before zero, shape (n,) [s].
        state: The legs' state of each draw, of which steering and stride are used here.
        error: Standard deviations of the walking model's error.
        rng: Source of randomness.
        executor: Where draws are walked; None for here.
        options: How walks are computed; when None the step is chosen by `ensemble_step`.
        progress: Called with the fraction done, 0 to 1.

    Raises:
        DomainError: There is no draw, or times are negative or do not increase.
        WalkError: A walk diverged, or a robot cannot stand at its start.
    """
    draws = with_contacts(draws, error, rng=rng)
    if options is None:
        options = ensemble_step(draws, duration=float(t[-1]), executor=executor)
    n = len(draws)
    distance = state.stride + error.distance * rng.standard_normal(n)
    curvature = state.steering + error.curvature * rng.standard_normal(n)
    walked = walk_ensemble(draws, t, options=options, executor=executor, progress=progress)
    return bent(walked.poses, distance=distance, curvature=curvature)


def with_contacts(
    draws: Sequence[WalkDraw], error: ModelSpread, *, rng: np.random.Generator
) -> list[WalkDraw]:
    """Replace each draw's factors on contact stiffness and damping by log-normal ones, median 1.

    Args:
        draws: Inputs of the walks.
        error: Error of the walking model; if `error.contacts` is zero the draws are not changed.
        rng: Source of randomness.
    """
    if error.contacts == 0:
        return list(draws)
    factors = np.exp(error.contacts * rng.standard_normal((len(draws), 2)))
    return [
        replace(draw, stiffness=float(stiffness), damping=float(damping))
        for draw, (stiffness, damping) in zip(draws, factors, strict=True)
    ]
