# SPDX-License-Identifier: MIT
"""How a gait rocks the body, by geometry alone: the thesis's tetrapod, section 5-5-2."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.contact.events import Contact, next_stance
from model.contact.stance import Stance, resting_stance
from model.gait.reference import LegReference
from model.robot import Robot
from model.slip.law import Array
from model.walk.dynamics import step_times


@dataclass(frozen=True)
class Wobble:
    """The body's orientation over the ground under its legs.

    Attributes:
        t: Times, shape (n,) [s].
        roll: Roll, R = Rz(yaw) Ry(pitch) Rx(roll), shape (n,) [rad].
        pitch: Pitch, shape (n,) [rad].
        height: Height of the body's centre, shape (n,) [m].
        contact: Which legs are on the ground, shape (n, 6).
    """

    t: Array
    roll: Array
    pitch: Array
    height: Array
    contact: NDArray[np.bool_]

    def transitions(self) -> list[tuple[float, frozenset[int]]]:
        """List contact states as leg numbers 1 to 6, with the time each begins [s]."""
        begins = np.flatnonzero(np.any(np.diff(self.contact, axis=0), axis=1)) + 1
        return [
            (float(self.t[k]), frozenset(int(i) + 1 for i in np.flatnonzero(self.contact[k])))
            for k in (0, *begins)
        ]


def wobble(
    robot: Robot,
    reference: LegReference,
    *,
    duration: float,
    dt: float = 0.001,
    contact: Contact | None = None,
    always_balanced: bool = False,
) -> Wobble:
    """Turn the legs and keep the body on them, by the contact detection of section 3-5-2.

    Steps that detect contact late make the angles jump, as in Fig. 5-23; shorter ones less so.

    Args:
        robot: The robot.
        reference: Its leg angles over time.
        duration: Time [s].
        dt: Length of a step [s].
        contact: Indices of the legs on the ground at the start; where the robot rests, by default.
        always_balanced: Topple, too, when the centre of mass leaves the contact polygon between
            touchdowns; see `model.contact.events.next_stance`.

    Raises:
        DomainError: The duration is shorter than a step, or no contact state fits.
    """
    t = step_times(duration, dt)
    theta = reference.angles(t) + robot.leg_offset
    stances = []
    before = contact if contact is not None else _on_ground(resting_stance(robot, theta[0]))
    for angles in theta:
        stance = next_stance(robot, angles, contact=before, always_balanced=always_balanced)
        before = _on_ground(stance)
        stances.append(stance)
    return Wobble(
        t,
        np.array([stance.roll for stance in stances]),
        np.array([stance.pitch for stance in stances]),
        np.array([stance.height for stance in stances]),
        np.array([stance.standing for stance in stances]),
    )


def _on_ground(stance: Stance) -> Contact:
    return tuple(int(leg) for leg in np.flatnonzero(stance.standing))
