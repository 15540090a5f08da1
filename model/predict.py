# SPDX-License-Identifier: MIT
"""Predict paths with uncertainty from a robot, its leg log and its slip law.

Four uncertainties spread a path: the slip law's posterior; the legs' angles (each leg's constant
offset, and the angle between two counts of a coarse encoder); the pose it starts from; and the
error of the walking model, stated here as an error of distance and one of curvature.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from model.errors import DomainError
from model.gait.quantised import QuantisedLog
from model.gait.reference import LegReference
from model.leg_state import LegState, law_in, robot_in
from model.path_draws import bent
from model.poses import Poses
from model.robot import Robot
from model.slip.law import Array
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import WalkDraw, walk_ensemble
from model.walk.traction import TractionTable

STEPS = (0.005, 0.0025, 0.00125)  # s; an ensemble uses the largest that has converged
SAME_PATH = 0.005  # of the path's length: mean distance of ends at one step and at half of it
COMPARED, COMPARED_TIMES = 8, 101  # draws, and their poses, that are compared to choose the step
FINE = DynamicsOptions(dt=0.001)  # of the single path; with a wrong leg its turn is within 1 %
MOST_MOTIONS = 300  # a motion costs as much as its walk, and contributes least to the spread


@dataclass(frozen=True)
class ModelSpread:
    """Error of the walking model, constant along a walk.

    Stiffness and damping of the contacts matter for gaits that stand on more legs than statics can
    load, or whose legs take over at unequal heights, and hardly for others. They are therefore
    drawn. `distance` and `curvature`, the same for every gait, are root mean squares of the
    differences from an independent engine's walks.

    Attributes:
        distance: Relative error of distance, standard deviation [-].
        curvature: Error of curvature, standard deviation [rad/m].
        contacts: Standard deviation of the logarithms of the contacts' stiffness and damping [-].
    """

    distance: float = 0.003
    curvature: float = 0.004
    contacts: float = float(np.log(2.0))

    def __post_init__(self) -> None:
        """Check that the standard deviations are finite and not negative."""
        for name in ("distance", "curvature", "contacts"):
            if not (getattr(self, name) >= 0 and np.isfinite(getattr(self, name))):
                raise DomainError(f"{name} of the model's error is {getattr(self, name):g}")


def walk_draws(
    robot: Robot,
    legs: LegReference | QuantisedLog,
    tables: Sequence[TractionTable],
    state: LegState,
    *,
    rng: np.random.Generator,
) -> list[WalkDraw]:
    """Combine draws of the law, of the legs' state and of their motion, one path each.

    Args:
        robot: The robot as described.
        legs: Its leg angles from time zero on; a quantised log is reconstructed anew for each of
            the first `MOST_MOTIONS` draws, and they are taken in turn.
        tables: Draws of the slip law, taken in turn.
        state: Draws of the legs' state; their number is the ensemble's.
        rng: Source of randomness.
    """
    drawn = motions(legs, min(len(state), MOST_MOTIONS), rng)
    return [
        WalkDraw(
            robot_in(robot, state, i),
            drawn[i % len(drawn)],
            law_in(tables[i % len(tables)], state, i),
        )
        for i in range(len(state))
    ]


def motions(
    legs: LegReference | QuantisedLog, n: int, rng: np.random.Generator
) -> Sequence[LegReference]:
    """Draw n motions that counted leg angles allow; angles that are not counted are one motion.

    Args:
        legs: Leg angles.
        n: Number of motions.
        rng: Source of randomness.
    """
    return [legs.smooth(rng) for _ in range(n)] if isinstance(legs, QuantisedLog) else [legs]


def ensemble_step(
    draws: Sequence[WalkDraw], *, duration: float, threads: int = 2
) -> DynamicsOptions:
    """Choose the largest time step at which the mean of the walks' ends has converged.

    The error of a step differs from path to path, 0.3 % of its length at 5 ms, which is small
    against the spread of the draws. An error that all paths share is not, so the means of some ends
    are compared with those at half the step. At 5 ms a tripod's is within 0.2 % of the path. Where
    four legs are on the ground and loads oscillate between them, 5 ms shifts it by 7 %.

    Args:
        draws: The ensemble, of which the first `COMPARED` are walked.
        duration: Time walked [s].
        threads: Number of draws walked at once.

    Raises:
        WalkError: A walk diverged.
    """
    t = np.linspace(0.0, max(duration, STEPS[0]), COMPARED_TIMES)
    means: dict[float, Array] = {}
    for dt in STEPS:
        options = DynamicsOptions(dt=dt)
        paths = walk_ensemble(draws[:COMPARED], t, options=options, threads=threads).poses
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
    threads: int = 2,
    options: DynamicsOptions | None = None,
    progress: Callable[[float], None] | None = None,
) -> Poses:
    """Walk every draw and add its steering, its stride and a draw of the model's error.

    Args:
        draws: The draws to walk.
        t: Times of the poses, increasing from zero, shape (n,) [s].
        state: The legs' state of each draw.
        error: Error of the walking model.
        rng: Source of randomness.
        threads: Number of draws walked at once.
        options: How walks are computed; when None the step is chosen by `ensemble_step`.
        progress: Called with the fraction done.

    Raises:
        WalkError: A walk diverged.
    """
    draws = with_contacts(draws, error, rng=rng)
    if options is None:
        options = ensemble_step(draws, duration=float(t[-1]), threads=threads)
    walked = walk_ensemble(draws, t, options=options, threads=threads, progress=progress).poses
    n = len(draws)
    return bent(
        walked,
        distance=state.stride + error.distance * rng.standard_normal(n),
        curvature=state.steering + error.curvature * rng.standard_normal(n),
    )


def with_contacts(
    draws: Sequence[WalkDraw], error: ModelSpread, *, rng: np.random.Generator
) -> list[WalkDraw]:
    """Draw the stiffness and damping of the contacts of each draw, log-normal.

    Args:
        draws: The draws.
        error: Error of the walking model; without spread of contacts the draws are returned as
            they are.
        rng: Source of randomness.
    """
    if error.contacts == 0:
        return list(draws)
    factors = np.exp(error.contacts * rng.standard_normal((len(draws), 2)))
    return [
        replace(draw, stiffness=float(stiffness), damping=float(damping))
        for draw, (stiffness, damping) in zip(draws, factors, strict=True)
    ]
