# SPDX-License-Identifier: MIT
"""Attitude of the body that simulated legs carry, by leg kinematics without slip.

Not modelled: slip, compliance of the contacts, falling. A body that no three legs hold keeps the
attitude that it had.
"""

from typing import Final

import numpy as np

from model.arrays import Array
from model.robot import N_LEGS, Robot
from model.walk.no_slip import Motion, Skeleton, move
from rig.zebro.simulated_legs import SimulatedLegs

STEP: Final = 0.002
"""Longest step of the integration of yaw: that of the walking model without slip [s]."""


class SimulatedBody:
    """Roll, pitch and yaw of a robot that stands and walks on simulated legs; call it with a time.

    Height, roll and pitch are those on the three legs that hold the robot, and yaw is the integral
    of the rate that keeps the contacts in place, as in `model.walk.no_slip.walk_no_slip`. Yaw is 0
    at the first call. Creating it compiles the loops that it needs, before any clock runs.

    Args:
        legs: The legs, whose true angles are used.
        robot: Geometry of the robot.
    """

    def __init__(self, legs: SimulatedLegs, *, robot: Robot | None = None) -> None:
        robot = Robot() if robot is None else robot
        self._legs = legs
        self._skeleton = Skeleton(robot.hips, robot.leg_radius, robot.toe_beyond)
        self._at: float | None = None
        self._theta = legs.angles(0.0)
        self._roll = self._pitch = self._yaw = 0.0
        self._moved(self._theta[None], np.zeros((1, N_LEGS)))

    def __call__(self, now: float) -> tuple[float, float, float]:
        """Compute roll, pitch and yaw [rad] at a time by the legs' clock, never decreasing [s].

        Roll and pitch stay as they were where at any instant since the last call no three legs hold
        the robot; yaw stays from that instant on.
        """
        began = now if self._at is None else self._at
        steps = max(int(np.ceil((now - began) / STEP - 1e-9)), 1)  # less rounding errors
        dt = (now - began) / steps  # 0 in the first call
        later = [self._legs.angles_at(began + (k + 1) * dt) for k in range(steps)]
        theta = np.array([self._theta, *later])
        speed = np.diff(theta, axis=0) / dt if dt > 0 else np.zeros((steps, N_LEGS))
        # Velocity at the middle of each step, then the pose at the end, where nothing is integrated
        middle = np.vstack([0.5 * (theta[1:] + theta[:-1]), theta[-1:]])
        motion, held = self._moved(middle, np.vstack([speed, np.zeros(N_LEGS)]))
        self._yaw += float(motion.twist[:, 2].sum()) * dt
        if held:
            self._roll, self._pitch = map(float, motion.pose[-1, 1:])
        self._at, self._theta = now, theta[-1]
        return self._roll, self._pitch, self._yaw

    def _moved(self, theta: Array, speed: Array) -> tuple[Motion, bool]:
        """Compute the motion of the body at leg angles [rad] and speeds [rad/s], shapes (n, 6).

        Returns:
            The motion, which is zero from the first instant on at which no three legs hold the
            robot, and whether three legs hold it at every instant.
        """
        n = len(theta)
        shapes = (n, 3), (n, 3), (n, N_LEGS), (n, N_LEGS, 2)
        motion = Motion(*(np.zeros(shape) for shape in shapes))
        return motion, move(self._skeleton, theta, speed, False, motion) == n
