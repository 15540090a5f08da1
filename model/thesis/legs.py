# SPDX-License-Identifier: MIT
"""Leg angles step by step, switching speed by angle as the thesis's legs do."""

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.compiled import compiled
from model.errors import DomainError
from model.gait.cyclic import CyclicReference
from model.gait.reference import LegReference
from model.robot import N_LEGS


class ThesisLegMotion(NamedTuple):
    """Leg angles and speeds at every step.

    Attributes:
        theta: Angles at the beginning of each step, shape (n, 6) [rad].
        speed: Speeds during each step, shape (n, 6) [rad/s].
        stance_speed: Speed of each leg when on the ground, shape (n, 6) [rad/s].
    """

    theta: Array
    speed: Array
    stance_speed: Array


@dataclass(frozen=True)
class SwitchedLegs:
    """Legs with one speed between touchdown and lift-off angle, and another speed elsewhere.

    Listing A.33: the speed is chosen anew at every step by the current leg angle, so that a cycle
    takes up to a step longer or shorter than planned.

    Attributes:
        touchdown: Touchdown angles in [0, 2 pi), shape (6,) [rad].
        liftoff: Lift-off angles, beyond touchdown and below 2 pi, shape (6,) [rad].
        ground_speed: Speeds from touchdown to lift-off, shape (6,) [rad/s].
        flight_speed: Speeds from lift-off to the next touchdown, shape (6,) [rad/s].
        start: Angles at the start, shape (6,) [rad].

    Raises:
        DomainError: A field is not six finite numbers, angles are not 0 <= touchdown < lift-off
            < 2 pi, or a speed is not positive.
    """

    touchdown: Array
    liftoff: Array
    ground_speed: Array
    flight_speed: Array
    start: Array

    def __post_init__(self) -> None:
        """Convert all fields to arrays; check shapes, order of the angles and signs of speeds."""
        for item in fields(self):
            values = np.array(getattr(self, item.name), dtype=float)
            if values.shape != (N_LEGS,) or not np.isfinite(values).all():
                raise DomainError(f"{item.name} is {values}; expected six finite numbers")
            object.__setattr__(self, item.name, values)
        for leg in range(N_LEGS):
            down, up = np.degrees(self.touchdown[leg]), np.degrees(self.liftoff[leg])
            if not 0 <= down < up < 360:
                raise DomainError(
                    f"leg {leg + 1} touches down at {down:g} and lifts off at {up:g} degrees; "
                    "expected 0 <= touchdown < lift-off < 360"
                )
            slowest = min(self.ground_speed[leg], self.flight_speed[leg])
            if not slowest > 0:
                raise DomainError(
                    f"leg {leg + 1}: slowest speed is {slowest:g} rad/s; expected more than zero"
                )

    @classmethod
    def of(cls, gait: CyclicReference) -> "SwitchedLegs":
        """Create legs that switch speed by angle from a cyclic gait, and start as it does at zero.

        Args:
            gait: Gait of six legs.

        Raises:
            DomainError: The gait has pauses or offsets, or angles that the class does not accept.
        """
        if np.any(gait.pause) or np.any(gait.offset):
            raise DomainError(
                f"the gait pauses for {gait.pause} s and is off by {gait.offset} rad; legs that "
                "switch speed by angle take neither: pass the gait, followed by the clock"
            )
        return cls(
            gait.touchdown, gait.liftoff, gait.ground_speed, gait.flight_speed,
            np.reshape(gait.angles(0.0), N_LEGS),
        )  # fmt: skip

    def motion(self, dt: float, steps: int) -> ThesisLegMotion:
        """Integrate leg angles step by step, with the speed that the angle before a step selects.

        Args:
            dt: Length of a step [s].
            steps: Number of steps.
        """
        theta, speed = np.empty((steps, N_LEGS)), np.empty((steps, N_LEGS))
        _switch(
            self.start, self.touchdown, self.liftoff, self.ground_speed, self.flight_speed,
            dt, theta, speed,
        )  # fmt: skip
        return ThesisLegMotion(theta, speed, np.tile(self.ground_speed, (steps, 1)))


def leg_motion(reference: LegReference | SwitchedLegs, *, dt: float, steps: int) -> ThesisLegMotion:
    """Compute leg angles and speeds at every step, from time zero on.

    Args:
        reference: Legs that switch speed by angle, or leg angles over time, which are sampled; of
            these the speed is that of stance too.
        dt: Length of a step [s].
        steps: Number of steps.
    """
    if isinstance(reference, SwitchedLegs):
        return reference.motion(dt, steps)
    t = dt * np.arange(steps)
    speed = reference.speeds(t)
    return ThesisLegMotion(reference.angles(t), speed, speed)


@compiled
def _switch(start, touchdown, liftoff, ground_speed, flight_speed, dt, theta, speed):
    """Fill angles and speeds, shape (n, 6), of legs that switch speed by angle."""
    angle = start.copy()
    for step in range(len(theta)):
        for leg in range(6):
            turned = angle[leg] % (2 * np.pi)
            grounded = touchdown[leg] <= turned < liftoff[leg]
            theta[step, leg] = angle[leg]
            speed[step, leg] = ground_speed[leg] if grounded else flight_speed[leg]
            angle[leg] += dt * speed[step, leg]
