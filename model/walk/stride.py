# SPDX-License-Identifier: MIT
"""The stride map: once a constant gait repeats itself, every further stride is one planar step.

On flat ground the motion does not depend on position or heading. A settled stride therefore
moves the body by the same element of SE(2) each time, and the path is its repeated composition.
"""

from typing import NamedTuple

import numpy as np

from model.errors import WalkError
from model.gait.reference import LegReference
from model.poses import Poses
from model.robot import N_LEGS, Robot
from model.slip.law import Array
from model.walk.arrays import Body, Contacts, State, body_arrays
from model.walk.dynamics import (
    DEFAULT_OPTIONS,
    ORIGIN,
    DynamicsOptions,
    Start,
    diverged,
    roll_pitch_yaw,
    start_state,
    step_times,
)
from model.walk.ground import FLAT
from model.walk.step import run_steps
from model.walk.traction import TractionTable

SETTLED = 1e-4  # of a stride's length: change from one stride to the next
SETTLED_TURN = 1e-5  # change of its turn [rad]; n strides on, n/2 of it in the path's direction
MAX_STRIDES = 12  # after which the last is taken as settled; a tetrapod rocks for a few strides


class Planar(NamedTuple):
    """A planar pose or displacement.

    Attributes:
        x: Forward [m].
        y: To the left [m].
        yaw: Turn [rad].
    """

    x: float
    y: float
    yaw: float

    def then(self, x: Array, y: Array, yaw: Array) -> tuple[Array, Array, Array]:
        """Compose this pose with poses that are given in its frame (SE(2) composition).

        Args:
            x: Forward displacements in this pose's frame, shape (n,) [m].
            y: Displacements to the left, shape (n,) [m].
            yaw: Turns, shape (n,) [rad].

        Returns:
            x [m], y [m] and yaw [rad] in the frame that this pose is given in.
        """
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        return self.x + c * x - s * y, self.y + s * x + c * y, self.yaw + yaw


def walk_by_strides(
    robot: Robot,
    reference: LegReference,
    table: TractionTable,
    *,
    duration: float,
    start: Start = ORIGIN,
    options: DynamicsOptions = DEFAULT_OPTIONS,
) -> Poses:
    """Walk a gait that repeats itself: step by step until settled, then stride by stride.

    A gait that is not settled after `MAX_STRIDES` continues with the last of them.

    Args:
        robot: The robot.
        reference: A gait with a period.
        table: The slip law.
        duration: Time walked [s].
        start: Where it starts, on flat ground.
        options: How it is computed; steps are shortened to fit the period.

    Returns:
        The path, sampled at every step.

    Raises:
        DomainError: The duration is shorter than a step.
        WalkError: The gait has no period, or a step diverged.
    """
    period = reference.period
    if period is None:
        raise WalkError("these leg angles do not repeat, so there is no stride; walk them whole")
    n = int(np.ceil(period / options.dt - 1e-9))
    t = step_times(duration, period / n)
    strides = int(np.ceil((len(t) - 1) / n))
    walked = _settled_strides(
        robot, reference, table, start, options, n=n, most=strides, dt=period / n
    )
    first = [(np.array([start.x]), np.array([start.y]), np.array([start.yaw]))]
    parts = first + [(x[1:], y[1:], yaw[1:]) for x, y, yaw in walked]
    x, y, yaw = (np.concatenate(column) for column in zip(*parts, strict=True))
    x, y, yaw = _repeat(x, y, yaw, n=n, times=strides - len(walked))
    keep = len(t)
    return Poses(t, np.column_stack([x, y])[:keep], yaw[:keep])


def _settled_strides(
    robot: Robot,
    reference: LegReference,
    table: TractionTable,
    start: Start,
    options: DynamicsOptions,
    *,
    n: int,
    most: int,
    dt: float,
) -> list[tuple[Array, Array, Array]]:
    """Walk strides of n steps until one moves the body as the last did; x, y and yaw of each."""
    t = dt * np.arange(n + 1)
    theta = reference.angles(t) + robot.leg_offset
    contacts = Contacts(options.stiffness, options.damping)
    body = body_arrays(robot)
    state = start_state(robot, theta[0], FLAT, start, options)
    walked: list[tuple[Array, Array, Array]] = []
    last = np.full(3, np.inf)
    while len(walked) < min(most, MAX_STRIDES):
        first = np.concatenate([state.p, state.q])
        pose = _walk_stride(body, table, contacts, state, theta, dt, len(walked) * n * dt)
        yaw = roll_pitch_yaw(np.vstack([first[3:], pose[:, 3:]]))[:, 2]
        if walked:
            yaw += walked[-1][2][-1] - yaw[0]
        walked.append((np.append(first[0], pose[:, 0]), np.append(first[1], pose[:, 1]), yaw))
        step = _displacement(*walked[-1])
        changed = np.abs(step - last)
        length = max(np.hypot(*step[:2]), robot.leg_radius)
        if changed[:2].max() < SETTLED * length and changed[2] < SETTLED_TURN:
            break
        last = step
    return walked


def _walk_stride(
    body: Body,
    table: TractionTable,
    contacts: Contacts,
    state: State,
    theta: Array,
    dt: float,
    began: float,
) -> Array:
    pose = np.empty((len(theta) - 1, 7))
    done = run_steps(body, table, FLAT, contacts, state, theta, dt, pose, np.empty((0, N_LEGS, 6)))
    if done < len(pose):
        raise diverged(began + done * dt, pose[max(done - 1, 0)])
    return pose


def _displacement(x: Array, y: Array, yaw: Array) -> Array:
    """Compute the move from the first pose to the last in the frame of the first, shape (3,)."""
    c, s = np.cos(yaw[0]), np.sin(yaw[0])
    dx, dy = x[-1] - x[0], y[-1] - y[0]
    return np.array([c * dx + s * dy, c * dy - s * dx, yaw[-1] - yaw[0]])


def _repeat(x: Array, y: Array, yaw: Array, *, n: int, times: int) -> tuple[Array, Array, Array]:
    """Append the stride of the last n steps repeatedly."""
    if times < 1:
        return x, y, yaw
    begin = Planar(float(x[-n - 1]), float(y[-n - 1]), float(yaw[-n - 1]))
    c, s = np.cos(begin.yaw), np.sin(begin.yaw)
    dx, dy = x[-n:] - begin.x, y[-n:] - begin.y
    inside = c * dx + s * dy, c * dy - s * dx, yaw[-n:] - begin.yaw
    step = _displacement(x[-n - 1 :], y[-n - 1 :], yaw[-n - 1 :])
    parts = [(x, y, yaw)]
    at = Planar(float(x[-1]), float(y[-1]), float(yaw[-1]))
    for _ in range(times):
        parts.append(at.then(*inside))
        at = Planar(*(float(a) for a in at.then(*step)))
    x, y, yaw = (np.concatenate(column) for column in zip(*parts, strict=True))
    return x, y, yaw
