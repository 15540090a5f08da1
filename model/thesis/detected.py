# SPDX-License-Identifier: MIT
"""A walk on rigid legs by contact detection: the thesis's tetrapod, section 5-5, set moving.

The thesis computes contacts, height, roll and pitch of its tetrapod (`model.thesis.detection`) and
leaves the dynamics to future work. The motion over the ground is added here: the body moves such
that the material contact points of the detected contacts stand still, in a turn by least squares,
as in `model.walk.no_slip`, which differs in how it finds the contacts only.
"""

import numpy as np

from model.arrays import Array
from model.compiled import compiled
from model.contact.stance import on_three_legs
from model.errors import WalkError
from model.gait.reference import LegReference
from model.robot import N_LEGS, Robot
from model.thesis.detection import RigidContacts, detect_contacts
from model.walk.dynamics import step_times
from model.walk.no_slip import integrate_twists, leg_velocities, stand_still
from model.walk.path import WalkPath


def walk_detected(
    robot: Robot,
    reference: LegReference,
    *,
    duration: float,
    dt: float = 0.001,
) -> WalkPath:
    """Compute a walk without slip on the contacts that are detected on rigid legs, section 3-5-2.

    Args:
        robot: The robot; its leg offsets are added to the angles.
        reference: Leg angles over time, of any gait in which three legs hold the robot at the
            start.
        duration: Time walked [s].
        dt: Length of a step, at whose ends and middle contacts are looked for [s].

    Returns:
        The path from the origin. `slip_velocity` is the residual of the least squares; forces are
        NaN on the ground and zero in the air, slip ratios NaN.

    Raises:
        DomainError: The duration is not finite or rounds to no step, or no three legs hold the
            robot at the start.
        WalkError: At some instant no contact state fits; the message says when.
    """
    t = step_times(duration, dt)
    # Steps take the velocity at their middle: second order, and never on a kink of the gait.
    halves = np.linspace(t[0], t[-1], 2 * len(t) - 1)
    theta, speed = reference.angles(halves) + robot.leg_offset, reference.speeds(halves)
    found = detect_contacts(robot, theta)
    if found.ended:
        raise WalkError(
            f"at t = {halves[len(found)]:.4g} s contact detection ends: {found.ended}; or use the "
            "dynamics model, which lets the robot fall"
        )
    twist, slip = _motion(robot, theta, speed, found)
    xy, yaw = integrate_twists(twist[1::2], dt)
    contact = found.contact[::2]
    on_ground = np.where(contact, np.nan, 0.0)
    return WalkPath(
        t=t,
        position=np.column_stack([xy, found.height[::2]]),
        orientation=np.column_stack([found.roll[::2], found.pitch[::2], yaw]),
        theta=theta[::2],
        contact=contact,
        slip_velocity=slip[::2],
        slip_ratio=np.full(contact.shape, np.nan),
        normal_force=on_ground,
        traction_force=np.stack([on_ground, on_ground], axis=-1),
    )


def _motion(robot: Robot, theta: Array, speed: Array, found: RigidContacts) -> tuple[Array, Array]:
    """Compute twists, shape (n, 3), and slip, (n, 6, 2), of a body on given contacts: `_carry`."""
    n = len(theta)
    twist, slip = np.zeros((n, 3)), np.zeros((n, N_LEGS, 2))
    _carry(
        robot.hips, robot.leg_radius, robot.toe_beyond, theta, speed, found.legs, found.contact,
        twist, slip,
    )  # fmt: skip
    return twist, slip


@compiled
def _carry(hips, radius, toe_beyond, theta, speed, legs, contact, twist, slip):
    """Compute the body's motion on given contacts without slip.

    Args:
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        theta: Leg angles, shape (n, 6) [rad].
        speed: Leg speeds, shape (n, 6) [rad/s].
        legs: Indices of the three legs that the body stands on, shape (n, 3).
        contact: Whether a leg is on the ground, shape (n, 6).
        twist: Filled: forward and leftward velocity [m/s] and yaw rate [rad/s], shape (n, 3).
        slip: Filled for legs on the ground: velocity over it, forward and left, (n, 6, 2) [m/s].
    """
    points, up, seen = np.empty((6, 3)), np.empty(3), np.empty((6, 2))
    below, own = np.empty(6), np.empty((6, 3))
    for k in range(len(theta)):
        on_three_legs(theta[k], hips, radius, toe_beyond, legs[k], points, up, seen)
        for leg in range(6):
            x, y, z = points[leg]
            below[leg] = -(up[0] * x + up[1] * y + up[2] * z)
        leg_velocities(hips, points, up, speed[k], own)
        stand_still(seen, below, own, up, legs[k], contact[k], twist[k], slip[k])
