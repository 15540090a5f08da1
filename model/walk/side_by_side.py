# SPDX-License-Identifier: MIT
"""Walks of several draws on level ground, computed side by side."""

from collections.abc import Sequence
from dataclasses import dataclass

from model.arrays import Array
from model.errors import WalkError
from model.lanes import LANES
from model.robot import Robot
from model.walk.arrays import Contacts, State
from model.walk.dynamics import (
    SETTLE_STEP,
    STICKY,
    DynamicsOptions,
    cannot_stand,
    require_finished,
    settled,
    standing_angles,
    unsettled_state,
)
from model.walk.flat.batch import FlatWalk, run_side_by_side
from model.walk.traction import TractionTable

MOST = LANES
"""Largest number of walks that are computed side by side."""


class OneOfSeveralError(WalkError):
    """One of several walks failed.

    Attributes:
        walk: Index of the walk.
    """

    def __init__(self, walk: int, message: str) -> None:
        super().__init__(message)
        self.walk = walk

    def __reduce__(self) -> tuple[type["OneOfSeveralError"], tuple[int, str]]:
        """Return class and arguments, so that a worker can send the error."""
        return type(self), (self.walk, str(self))


@dataclass(frozen=True)
class LevelWalk:
    """One of several walks on level ground, from x, y and yaw zero.

    Attributes:
        robot: The robot; its leg offsets are in `theta` already.
        table: The slip law, without bristles.
        options: Step length, the same for all walks, and contacts.
        theta: Leg angles at every step's start and the last one's end, shape (n + 1, 6) [rad].
    """

    robot: Robot
    table: TractionTable
    options: DynamicsOptions
    theta: Array


def walk_side_by_side(walks: Sequence[LevelWalk]) -> Array:
    """Compute up to `MOST` walks with equally many equal steps; each settles on its legs first.

    Args:
        walks: The walks.

    Returns:
        Position [m] and quaternion (w, x, y, z) at the times of `theta`, shape (walks, n + 1, 7).

    Raises:
        OneOfSeveralError: A robot cannot stand, or a walk diverged.
    """
    dt = walks[0].options.dt
    states = [unsettled_state(walk.robot) for walk in walks]
    standing = [
        _flat(walk, state, STICKY, standing_angles(walk.theta[0]))
        for walk, state in zip(walks, states, strict=True)
    ]
    pose, _, done = run_side_by_side(standing, SETTLE_STEP)
    for i, walk in enumerate(walks):
        if done[i] < pose.shape[1] - 1:
            raise OneOfSeveralError(i, str(cannot_stand(walk.theta[0])))
    moving = [
        _flat(walk, settled(state), walk.table, walk.theta)
        for walk, state in zip(walks, states, strict=True)
    ]
    pose, _, done = run_side_by_side(moving, dt)
    for i in range(len(walks)):
        try:
            require_finished(pose[i], done[i], dt)
        except WalkError as error:
            raise OneOfSeveralError(i, str(error)) from error
    return pose


def _flat(walk: LevelWalk, state: State, table: TractionTable, theta: Array) -> FlatWalk:
    """Return the walk, or its settling, from a state as the compiled loop takes it."""
    contacts = Contacts(walk.options.stiffness, walk.options.damping)
    return FlatWalk(walk.robot, table, contacts, state, theta)
