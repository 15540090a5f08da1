# SPDX-License-Identifier: MIT
"""Ensembles of walks, each with its own law and robot, for the spread of a path."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from model.errors import DomainError, WalkError
from model.gait.reference import LegReference
from model.poses import Poses
from model.robot import Robot
from model.slip.law import Array
from model.walk.dynamics import (
    DEFAULT_OPTIONS,
    DynamicsOptions,
    integrate,
    start_state,
    step_times,
)
from model.walk.quaternion import roll_pitch_yaw, unwrapped_yaw
from model.walk.stride import walk_by_strides
from model.walk.traction import TractionTable


@dataclass(frozen=True)
class WalkDraw:
    """One draw of all inputs of a path.

    Attributes:
        robot: The robot, with its leg offsets.
        reference: Leg angles over time.
        table: The slip law.
        stiffness: Factor on the contacts' stiffness of the options [-].
        damping: Factor on their damping [-].
    """

    robot: Robot
    reference: LegReference
    table: TractionTable
    stiffness: float = 1.0
    damping: float = 1.0

    def options(self, common: DynamicsOptions) -> DynamicsOptions:
        """Return an ensemble's options with the contacts of this draw."""
        return replace(
            common,
            stiffness=common.stiffness * self.stiffness,
            damping=common.damping * self.damping,
        )


@dataclass(frozen=True)
class PlanarWalk:
    """Planar path of a walk, or of each draw of one.

    Attributes:
        poses: The path, or one path for each draw.
        tilt: Roll and pitch at the times of the poses, shape (n, 2) or (draws, n, 2); None where
            they were not asked for [rad].
    """

    poses: Poses
    tilt: Array | None = None


def walk_ensemble(
    draws: Sequence[WalkDraw],
    t: Array,
    *,
    options: DynamicsOptions = DEFAULT_OPTIONS,
    threads: int = 2,
    tilt: bool = False,
    progress: Callable[[float], None] | None = None,
) -> PlanarWalk:
    """Walk every draw on flat ground; periodic gaits by their stride map.

    Args:
        draws: The draws to walk.
        t: Times of the poses, increasing, none before zero, shape (n,) [s].
        options: How the walks are computed.
        threads: Number of draws walked at once.
        tilt: Return roll and pitch too; not available for periodic gaits.
        progress: Called with the fraction done.

    Returns:
        The paths of all draws, interpolated at `t`.

    Raises:
        DomainError: There is no draw, or the times do not increase from zero.
        WalkError: A walk diverged (the message says which), or `tilt` is asked of a periodic gait.
    """
    _require_draws(draws, t)
    duration = max(float(t[-1]), options.dt)

    def walk(numbered: tuple[int, WalkDraw]) -> Array:
        number, draw = numbered
        try:
            path = planar_walk(draw, duration=duration, options=options, tilt=tilt)
        except WalkError as error:
            raise WalkError(f"draw {number} of {len(draws)}: {error}") from error
        poses = path.poses
        columns = [*poses.states.T, *(_tilt_of(path) if tilt else ())]
        return np.stack([np.interp(t, poses.t, a) for a in columns], axis=-1)

    paths = []
    with ThreadPoolExecutor(threads) as pool:
        for path in pool.map(walk, enumerate(draws, start=1)):
            paths.append(path)
            if progress is not None:
                progress(len(paths) / len(draws))
    states = np.stack(paths)
    return PlanarWalk(Poses.of_states(t, states), states[..., 3:] if tilt else None)


def _tilt_of(path: PlanarWalk) -> Array:
    if path.tilt is None:
        raise WalkError(
            "roll and pitch of a gait walked by strides are not kept; sample its leg angles"
        )
    return path.tilt.T


def _require_draws(draws: Sequence[WalkDraw], t: Array) -> None:
    if not draws:
        raise DomainError("an ensemble of no draws has no paths; expected at least one")
    if t.ndim != 1 or not len(t) or not (t[0] >= 0 and np.all(np.diff(t) > 0)):
        raise DomainError(
            f"times wanted of an ensemble are {np.array2string(t, threshold=6)} s; expected them "
            "to increase, from zero or later"
        )


def planar_walk(
    draw: WalkDraw,
    *,
    duration: float,
    options: DynamicsOptions = DEFAULT_OPTIONS,
    tilt: bool = False,
) -> PlanarWalk:
    """Walk one draw on flat ground and return its planar path.

    Args:
        draw: The draw to walk.
        duration: Time walked [s].
        options: How it is computed.
        tilt: Return roll and pitch too; ignored for periodic gaits, which are walked by strides.

    Raises:
        DomainError: The duration is shorter than a step.
        WalkError: A step diverged.
    """
    options = draw.options(options)
    if draw.reference.period is not None:
        return PlanarWalk(
            walk_by_strides(
                draw.robot, draw.reference, draw.table, duration=duration, options=options
            )
        )
    t = step_times(duration, options.dt)
    theta = draw.reference.angles(t) + draw.robot.leg_offset
    state = start_state(draw.robot, theta[0], options)
    pose, _ = integrate(draw.robot, draw.table, state, theta, options)
    q = pose[:, 3:]
    poses = Poses(t, pose[:, :2], unwrapped_yaw(q))
    return PlanarWalk(poses, roll_pitch_yaw(q)[:, :2] if tilt else None)
