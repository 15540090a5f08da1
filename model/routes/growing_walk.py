# SPDX-License-Identifier: MIT
"""Walk a program that grows, cycle by cycle, and tell the pose at its end."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.gait.program import ProgramLegs
from model.gait.reference import SampledReference
from model.poses import compose, relative
from model.robot import Robot
from model.walk.arrays import State
from model.walk.bend import STRAIGHT, Bend, bent_states
from model.walk.dynamics import DynamicsOptions, integrate, start_state
from model.walk.ground import FLAT, Ground
from model.walk.quaternion import roll_pitch_yaw, unwrapped_yaw
from model.walk.traction import TractionTable


@dataclass(frozen=True)
class Reached:
    """What is kept at a program's end to walk on from there.

    Attributes:
        step: Number of time steps walked.
        state: State of the body.
        pose: x, y and unwrapped yaw of the path, bent if that is asked for, shape (3,)
            [m, m, rad].
    """

    step: int
    state: State
    pose: Array


class GrowingWalk:
    """Walks a growing program with the model "dynamics".

    Args:
        robot: The robot.
        table: The slip law, as fitted walks correct it.
        options: Step length and contacts.
        ground: The ground.
        bend: How the path is stretched and bent.

    Attributes:
        reached: What was walked last; None before the first walk. To take back the last cycles of a
            program, set it to what it was before they were walked.
    """

    def __init__(
        self,
        robot: Robot,
        table: TractionTable,
        options: DynamicsOptions,
        *,
        ground: Ground = FLAT,
        bend: Bend = STRAIGHT,
    ) -> None:
        self._robot, self._table, self._options = robot, table, options
        self._ground, self._bend = ground, bend
        self.reached: Reached | None = None

    def pose(self, legs: ProgramLegs) -> tuple[float, float, float]:
        """Return x, y [m] and unwrapped yaw [rad] at a program's end, to the nearest step.

        What was walked up to then is walked only once. Of a program that ends before what was
        walked last, the pose is that at the end of the latter; see `reached`.

        Raises:
            WalkError: The robot cannot stand at the start, or the walk diverged.
        """
        # A program without cycles has no leg angles: its start is that of a first cycle.
        begun = legs if legs.end > 0 else legs.with_cycle(legs.cycles[0].gait)
        dt = self._options.dt
        last = self._start(begun.reference()) if self.reached is None else self.reached
        end = round(legs.end / dt)
        if end > last.step:
            reference = begun.reference(min(last.step * dt, legs.end))
            last = self._advanced(reference, last, end)
        self.reached = last
        x, y, yaw = last.pose.tolist()
        return x, y, yaw

    def _start(self, reference: SampledReference) -> Reached:
        """Return the robot at rest on its legs at time zero, before the first step."""
        theta = reference.angles(0.0)[0] + self._robot.leg_offset
        state = start_state(self._robot, theta, self._options, ground=self._ground)
        yaw = float(roll_pitch_yaw(state.q[None])[0, 2])
        return Reached(0, state, np.array([state.p[0], state.p[1], yaw]))

    def _advanced(self, reference: SampledReference, last: Reached, end: int) -> Reached:
        """Walk from the last state, which stays as it is, to time step number `end`.

        The motion is bent and stretched, then added to the last pose.
        """
        dt = self._options.dt
        theta = reference.angles(dt * np.arange(last.step, end + 1)) + self._robot.leg_offset
        state = State(*(each.copy() for each in last.state))
        pose, _ = integrate(
            self._robot, self._table, state, theta, self._options, ground=self._ground,
            began=last.step * dt,
        )  # fmt: skip
        states = np.column_stack([pose[:, :2], unwrapped_yaw(pose[:, 3:])])
        distance, curvature = np.array([self._bend.distance]), np.array([self._bend.curvature])
        bent = bent_states(states[None], distance=distance, curvature=curvature)[0]
        move = relative(bent[-1:], bent[0])
        return Reached(end, state, compose(last.pose, move)[0])
