# SPDX-License-Identifier: MIT
"""The stride map: once a constant gait repeats itself, every further stride is one planar step.

On flat ground the motion does not depend on position or heading. A settled stride therefore
moves the body by the same element of SE(2) each time, and the path is its repeated composition.
"""

from dataclasses import replace

import numpy as np

from model.arrays import Array
from model.errors import WalkError
from model.gait.reference import LegReference
from model.poses import Poses, compose, relative
from model.robot import Robot
from model.walk.dynamics import (
    DEFAULT_OPTIONS,
    DynamicsOptions,
    integrate,
    start_state,
    step_times,
)
from model.walk.quaternion import unwrapped_yaw
from model.walk.traction import TractionTable

SETTLED = 1e-4  # of a stride's length: change from one stride to the next
SETTLED_TURN = 1e-5  # change of its turn [rad]; n strides on, n/2 of it in the path's direction
MAX_STRIDES = 12  # after which the last is taken as settled; a tetrapod rocks for a few strides


def walk_by_strides(
    robot: Robot,
    reference: LegReference,
    table: TractionTable,
    *,
    duration: float,
    options: DynamicsOptions = DEFAULT_OPTIONS,
) -> Poses:
    """Compute the path of a periodic gait: step by step until settled, then stride by stride.

    After `MAX_STRIDES` strides the last is repeated, settled or not.

    Args:
        robot: The robot; its leg offsets are added to the angles.
        reference: A gait with a period.
        table: The slip law.
        duration: Time walked [s].
        options: Step length, shortened to fit the period, and contacts.

    Returns:
        The path on flat ground from x, y and yaw zero, sampled at every step.

    Raises:
        DomainError: The duration is not finite or rounds to no step.
        WalkError: The gait has no period, the robot cannot stand, or a step diverged.
    """
    period = reference.period
    if period is None:
        raise WalkError("these leg angles do not repeat, so there is no stride; use planar_walk")
    n = int(np.ceil(period / options.dt - 1e-9))
    t = step_times(duration, period / n)
    strides = int(np.ceil((len(t) - 1) / n))
    walked = _settled_strides(robot, reference, table, replace(options, dt=period / n), n, strides)
    path = np.concatenate([np.zeros((1, 3)), *(stride[1:] for stride in walked)])
    return Poses.of_states(t, _repeat(path, n, times=strides - len(walked))[: len(t)])


def _settled_strides(
    robot: Robot,
    reference: LegReference,
    table: TractionTable,
    options: DynamicsOptions,
    n: int,
    most: int,
) -> list[Array]:
    """Integrate strides of n steps until one moves the body as the stride before, or `most` are.

    Settled: forward and left, its move differs from the one before by less than `SETTLED` of its
    length (at least the leg's radius), and its turn by less than `SETTLED_TURN`.

    Returns:
        x, y and yaw of each stride's n + 1 instants, shape (n + 1, 3) each [m, m, rad]; a stride's
        first pose is the last pose of the stride before. At most `MAX_STRIDES` strides.
    """
    theta = reference.angles(options.dt * np.arange(n + 1)) + robot.leg_offset
    state = start_state(robot, theta[0], options)
    walked: list[Array] = []
    last = np.full(3, np.inf)
    while len(walked) < min(most, MAX_STRIDES):
        began = len(walked) * n * options.dt
        pose, _ = integrate(robot, table, state, theta, options, began=began)
        yaw = unwrapped_yaw(pose[:, 3:])
        if walked:
            yaw += walked[-1][-1, 2] - yaw[0]
        walked.append(np.column_stack([pose[:, :2], yaw]))
        step = relative(walked[-1][-1], walked[-1][0])
        changed = np.abs(step - last)
        length = max(np.hypot(*step[:2]), robot.leg_radius)
        if changed[:2].max() < SETTLED * length and changed[2] < SETTLED_TURN:
            break
        last = step
    return walked


def _repeat(path: Array, n: int, *, times: int) -> Array:
    """Append the move of the last n steps to a path of rows x, y, yaw, `times` times in turn."""
    stride = relative(path[-n:], path[-n - 1])
    parts = [path]
    for _ in range(times):
        parts.append(compose(parts[-1][-1], stride))
    return np.concatenate(parts)
