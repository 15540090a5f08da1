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
from model.frames import attitude
from model.gait.reference import LegReference
from model.leg import (
    contact_angle,
    contact_in_body,
    hip_height,
    thesis_lowest_angle,
    thesis_lowest_angle_rate,
    thesis_tilt,
    thesis_tilt_rate,
    wrap_angle,
)
from model.robot import N_LEGS, Robot
from model.thesis.detection import RigidContacts, detect_contacts
from model.thesis.path import ThesisPath
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
    """Compute the body's twist (n, 3) and the contacts' slip (n, 6, 2); see `_carry`."""
    n = len(theta)
    twist, slip = np.zeros((n, 3)), np.zeros((n, N_LEGS, 2))
    _carry(
        robot.hips, robot.leg_radius, robot.toe_beyond, theta, speed, found.legs, found.contact,
        twist, slip,
    )  # fmt: skip
    return twist, slip


@compiled
def _carry(hips, radius, toe_beyond, theta, speed, legs, contact, twist, slip):
    """Compute the twist of a body on given contacts, which stand still by least squares.

    See `model.walk.no_slip.stand_still`.

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


def kinematic_path(robot: Robot, path: WalkPath) -> ThesisPath:
    """Compute the kinematic quantities of the thesis's model of a walk.

    Rates are differences between the samples before and after, so that they are large where roll
    and pitch jump with a change of contacts. Accelerations and static loads, which need forces,
    are NaN; static loads are zero without contact.

    Args:
        robot: The robot that walked.
        path: The walk, of three samples or more.
    """
    t, nothing = path.t, np.where(path.contact, np.nan, 0.0)
    angles = thesis_angles(path.orientation)
    rates = np.gradient(np.column_stack([path.position, angles]), t, axis=0)
    tilt = np.asarray(thesis_tilt(*angles.T))[:, None]
    tilt_rate = np.asarray(thesis_tilt_rate(*angles.T, *rates[:, 3:].T))[:, None]
    phi = np.asarray(thesis_lowest_angle(path.theta, tilt))
    turning = np.gradient(path.theta, t, axis=0)
    phi_rate = np.asarray(thesis_lowest_angle_rate(turning, tilt, tilt_rate))
    height = np.asarray(hip_height(phi, robot.leg_radius, robot.toe_beyond))
    x, z = contact_in_body(path.theta, contact_angle(phi, robot.toe_beyond), robot.leg_radius)
    contact = robot.hips + np.stack([x, np.zeros_like(phi), z], axis=-1)
    hip = np.broadcast_to(robot.hips, contact.shape)
    speeds = (-phi_rate * height, *(_forward(path, angles[:, 2], each) for each in (contact, hip)))
    leg_speed, contact_speed, hip_speed = (np.where(path.contact, v, np.nan) for v in speeds)
    return ThesisPath(
        **vars(path),
        angles=angles,
        rates=rates,
        acceleration=np.full(rates.shape, np.nan),
        phi=phi,
        phi_rate=phi_rate,
        hip_height=height,
        static_load=nothing,
        leg_speed=leg_speed,
        contact_speed=contact_speed,
        hip_speed=hip_speed,
    )


def thesis_angles(orientation: Array) -> Array:
    """Convert roll, pitch and yaw of `attitude` to those of Eq. (3-7), R = Rx Ry Rz.

    Args:
        orientation: Roll, pitch and unwrapped yaw, shape (n, 3) [rad].

    Returns:
        The thesis's angles, yaw unwrapped, shape (n, 3) [rad].
    """
    R, yaw = attitude(*orientation.T), orientation[:, 2]
    own = np.arctan2(-R[:, 0, 1], R[:, 0, 0])
    return np.column_stack([
        np.arctan2(-R[:, 1, 2], R[:, 2, 2]), np.arcsin(R[:, 0, 2]), yaw + wrap_angle(own - yaw)
    ])  # fmt: skip


def _forward(path: WalkPath, yaw: Array, point: Array) -> Array:
    """Compute the speed along the heading of points fixed to the body, shape (n, 6) [m/s].

    Args:
        path: The walk.
        yaw: Heading, shape (n,) [rad].
        point: Points in the body frame, shape (n, 6, 3) [m].
    """
    turning = np.gradient(attitude(*path.orientation.T), path.t, axis=0)
    v = np.gradient(path.position, path.t, axis=0)[:, None]
    v = v + np.squeeze(turning[:, None] @ point[..., None], -1)
    return np.cos(yaw)[:, None] * v[..., 0] + np.sin(yaw)[:, None] * v[..., 1]
