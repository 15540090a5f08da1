# SPDX-License-Identifier: MIT
"""Ensembles of walks, each with its own law and robot, for the spread of a path."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from model.arrays import Array
from model.errors import DomainError, WalkError
from model.gait.reference import LegReference
from model.poses import Poses
from model.robot import Robot
from model.tasks import compute_tasks
from model.walk.dynamics import (
    DEFAULT_OPTIONS,
    DynamicsOptions,
    integrate,
    start_state,
    step_times,
)
from model.walk.ground import FLAT, Ground, is_level
from model.walk.quaternion import roll_pitch_yaw
from model.walk.stride import repeated_strides, strides_until_alike
from model.walk.traction import TractionTable


@dataclass(frozen=True)
class WalkDraw:
    """One draw of all inputs of a walk.

    Attributes:
        robot: The robot, with the draw's leg offsets and leg arc.
        reference: Leg angles over time.
        table: The slip law.
        stiffness: Factor on the contact stiffness of an ensemble's options [-].
        damping: Factor on the contact damping of an ensemble's options [-].
        ground: The ground.
    """

    robot: Robot
    reference: LegReference
    table: TractionTable
    stiffness: float = 1.0
    damping: float = 1.0
    ground: Ground = FLAT

    def options(self, common: DynamicsOptions) -> DynamicsOptions:
        """Return the common options, contact stiffness and damping times this draw's factors."""
        return replace(
            common,
            stiffness=common.stiffness * self.stiffness,
            damping=common.damping * self.damping,
        )


@dataclass(frozen=True)
class PlanarWalk:
    """Planar path of one walk, or paths of all draws of a walk.

    Attributes:
        poses: The path, or one path for each draw.
        tilt: Roll and pitch at the times of the poses, shape (n, 2) or (draws, n, 2); None where
            they were not kept [rad].
    """

    poses: Poses
    tilt: Array | None = None


@dataclass(frozen=True)
class WalkedTimes:
    """How all draws of an ensemble are walked.

    Attributes:
        t: Times of the poses, increasing, none before zero, shape (n,) [s].
        options: Step length and contacts, before the draws' factors.
        tilt: Whether roll and pitch are wanted too.
    """

    t: Array
    options: DynamicsOptions
    tilt: bool = False

    @property
    def duration(self) -> float:
        """Time that is walked, a step at least [s]."""
        return max(float(self.t[-1]), self.options.dt)


def walk_ensemble(
    draws: Sequence[WalkDraw],
    t: Array,
    *,
    options: DynamicsOptions = DEFAULT_OPTIONS,
    executor: Executor | None = None,
    tilt: bool = False,
    progress: Callable[[float], None] | None = None,
) -> PlanarWalk:
    """Compute the path of every draw.

    Args:
        draws: The draws to walk.
        t: Times of the poses, increasing, none before zero, shape (n,) [s].
        options: Step length and contacts, the same for all draws but for the draws' factors.
        executor: Where draws are walked; a task is one draw; None for here.
        tilt: Return roll and pitch too.
        progress: Called after each draw with the fraction of draws done, from 0 to 1.

    Returns:
        The paths of all draws, from the origin, interpolated linearly at `t`, constant after
        a walk's last step.

    Raises:
        DomainError: There is no draw or no time, or times are negative, not finite or do not
            increase.
        WalkError: A walk failed; the message says of which draw.
    """
    _require_draws(draws, t)
    times = WalkedTimes(t, options, tilt)
    n = len(draws)
    states = np.empty((n, len(t), 5 if tilt else 3))
    results = compute_tasks(executor, partial(walk_draw, times), draws)
    for i in range(n):
        try:
            states[i] = next(results)
        except WalkError as error:
            raise WalkError(f"draw {i + 1} of {n}: {error}") from error
        if progress is not None:
            progress((i + 1) / n)
    return planar(t, states)


def planar(t: Array, states: Array) -> PlanarWalk:
    """Return paths of draws from x, y, yaw, and perhaps roll and pitch, shape (draws, n, 3 or 5).

    Args:
        t: Times, shape (n,) [s].
        states: The states [m, rad].
    """
    return PlanarWalk(
        Poses.of_states(t, states[..., :3]), states[..., 3:] if states.shape[-1] > 3 else None
    )


def walk_draw(times: WalkedTimes, draw: WalkDraw) -> Array:
    """Walk one draw: an independent task.

    Args:
        times: How it is walked.
        draw: The draw.

    Returns:
        x, y, yaw, and roll and pitch if wanted, shape (n, 3 or 5) [m, rad].

    Raises:
        WalkError: The walk failed.
    """
    path = planar_walk(draw, duration=times.duration, options=times.options)
    tilt = path.tilt.T if times.tilt and path.tilt is not None else ()
    columns = [*path.poses.states.T, *tilt]
    return np.stack([np.interp(times.t, path.poses.t, a) for a in columns], axis=-1)


def _require_draws(draws: Sequence[WalkDraw], t: Array) -> None:
    """Raise `DomainError` unless there is a draw, and a time, and times increase from zero on."""
    if not draws:
        raise DomainError("no draws were given; expected at least one")
    if t.ndim != 1 or not len(t) or not (t[0] >= 0 and np.all(np.diff(t) > 0)):
        raise DomainError(
            f"times wanted of an ensemble are {np.array2string(t, threshold=6)} s; expected one "
            "or more that increase, from zero or later"
        )


def planar_walk(
    draw: WalkDraw, *, duration: float, options: DynamicsOptions = DEFAULT_OPTIONS
) -> PlanarWalk:
    """Compute the planar path of one draw from the origin, at every step.

    A constant gait on level ground is walked until its strides are alike, see `model.walk.stride`;
    its steps are shortened to fit the gait's period.

    Args:
        draw: The draw to walk.
        duration: Time walked [s].
        options: Step length and contacts, before the draw's factors.

    Raises:
        DomainError: The duration is not finite or rounds to no step.
        WalkError: The robot cannot stand at the start, or a step diverged.
    """
    options = draw.options(options)
    period = draw.reference.period if is_level(draw.ground) else None
    if period is not None:
        options = replace(options, dt=period / np.ceil(period / options.dt - 1e-9))
    t = step_times(duration, options.dt)
    steps = len(t) - 1
    steps_a_stride = steps if period is None else min(round(period / options.dt), steps)
    theta = draw.reference.angles(t[: steps_a_stride + 1]) + draw.robot.leg_offset
    walked = strides_until_alike(
        _strides(draw, theta, options, count=-(-steps // steps_a_stride)),
        least_length=draw.robot.leg_radius,
    )
    states = repeated_strides(walked, steps)
    yaw = np.unwrap(states[:, 2])
    return PlanarWalk(Poses(t, states[:, :2], yaw), states[:, 3:])


def _strides(
    draw: WalkDraw, theta: Array, options: DynamicsOptions, *, count: int
) -> Iterator[Array]:
    """Walk `count` times through leg angles: x, y, yaw, roll and pitch of each time, (n + 1, 5)."""
    state = start_state(draw.robot, theta[0], options, ground=draw.ground)
    steps = len(theta) - 1
    for stride in range(count):
        pose, _ = integrate(
            draw.robot, draw.table, state, theta, options, ground=draw.ground,
            began=stride * steps * options.dt,
        )  # fmt: skip
        roll, pitch, yaw = roll_pitch_yaw(pose[:, 3:]).T
        yield np.column_stack([pose[:, :2], np.unwrap(yaw), roll, pitch])
