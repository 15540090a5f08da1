# SPDX-License-Identifier: MIT
"""Walk a path that is stretched and bent, so that the robot steps on the ground under that path.

On level ground of one law a walk depends on no place, and its path can be bent once it is walked
(`model.path_draws.bent`). On other ground the robot would then have walked on ground beside the
bent path. Here it is moved onto the bent path every `EVERY` seconds while it walks: by some tenths
of a millimetre, over which the ground hardly changes.
"""

import numpy as np

from model.arrays import Array
from model.gait.reference import LegReference
from model.robot import Robot
from model.walk.arrays import State
from model.walk.bend import Bend, bent_poses, move_state, turned_vectors
from model.walk.dynamics import DynamicsOptions, integrate, path_of, start_state, step_times
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from model.walk.traction import TractionTable

EVERY = 0.5  # s; after each such time, contacts are followed in finer steps for 5 ms


def walk_bent(
    robot: Robot,
    reference: LegReference,
    table: TractionTable,
    *,
    bend: Bend,
    duration: float,
    options: DynamicsOptions,
    ground: Ground = FLAT,
) -> WalkPath:
    """Compute a walk from the origin as `model.walk.dynamics.walk` does, on a bent path.

    Args:
        robot: The robot; its leg offsets are added to the angles.
        reference: Leg angles over time.
        table: The slip law.
        bend: How the path is stretched and bent.
        duration: Time walked, from the reference's time zero on [s].
        options: Step length and contacts.
        ground: The ground.

    Raises:
        DomainError: The duration is not finite or rounds to no step.
        WalkError: The robot cannot stand at the start, or a step diverged; the message says where.
    """
    t = step_times(duration, options.dt)
    theta = reference.angles(t) + robot.leg_offset
    state = start_state(robot, theta[0], options, ground=ground)
    pose, legs = integrate_bent(
        robot, table, state, theta, options, bend=bend, ground=ground, keep_legs=True
    )
    return path_of(t, pose, theta, legs)


def integrate_bent(
    robot: Robot,
    table: TractionTable,
    state: State,
    theta: Array,
    options: DynamicsOptions,
    *,
    bend: Bend,
    ground: Ground = FLAT,
    keep_legs: bool = False,
    began: float = 0.0,
) -> tuple[Array, Array]:
    """Integrate the body's motion as `model.walk.dynamics.integrate` does, on a bent path.

    Args:
        robot: The robot.
        table: The slip law.
        state: Initial state, overwritten with the final one.
        theta: Leg angles at every step's start and the last one's end, shape (n + 1, 6) [rad].
        options: Step length and contacts.
        bend: How the path is stretched and bent.
        ground: The ground.
        keep_legs: Whether to return slip and forces of the legs and the body.
        began: Time of the first step, for the message of an error [s].

    Returns:
        Poses and rows of legs and body, as of `integrate`.

    Raises:
        WalkError: A step diverged; the message says when and where.
    """
    n, count = len(theta) - 1, max(round(EVERY / options.dt), 1)
    poses, rows = [np.concatenate([state.p, state.q])[None]], []
    for first in range(0, n, count):
        part = theta[first : first + count + 1]
        walked, legs = integrate(
            robot, table, state, part, options, ground=ground, keep_legs=keep_legs,
            began=began + first * options.dt,
        )  # fmt: skip
        moved, yaw = bent_poses(walked, bend, ground)
        move_state(state, moved[-1], float(yaw[-1]))
        poses.append(moved[1:])
        for vectors in (legs[..., 1:3], legs[..., 3:5]):
            vectors[:] = turned_vectors(vectors, yaw[1 : len(legs) + 1, None])
        rows.append(legs)
    return np.concatenate(poses), np.concatenate(rows)
