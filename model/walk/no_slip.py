# SPDX-License-Identifier: MIT
r"""Kinematic walking models without slip, from leg angles and the legs' geometry.

`walk_no_slip` takes the legs as they are. The robot rests on the legs that hold it
(`model.contact.stance`), and its body moves such that their material contact points stand still,

.. math::
    v + \omega \times q_i + \dot\theta_i\, e_y \times (p_i - h_i) = 0 .

with the body's velocity v and angular velocity omega, contact q_i from the body's centre, contact
p_i and hip h_i in the body frame, leg speed theta_dot_i and the body's y axis e_y. Vertically three
legs determine height, roll and pitch rate exactly. Horizontally two equations a leg for three
unknowns cannot all hold when a robot turns. Least squares of the forward equations give forward
velocity and yaw rate; those of the leftward equations, with that yaw rate, leftward velocity.

`walk_wheels` is the predecessor's model, section 2-4: six wheels of radius 2r that do not steer.
The text says 4r, but its hip speed is 2 r theta_dot, and with that its results follow.
"""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.compiled import compiled
from model.contact.stance import ON_GROUND, holds, on_three_legs, rest
from model.errors import WalkError
from model.gait.reference import LegReference
from model.leg import wrap_angle
from model.robot import N_LEGS, Robot
from model.walk.dynamics import step_times
from model.walk.path import WalkPath


class Skeleton(NamedTuple):
    """The robot's geometry, for the compiled loop.

    Attributes:
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
    """

    hips: Array
    radius: float
    toe_beyond: float


class Motion(NamedTuple):
    """Motion of the body at n instants, in the heading frame (forward, left, up).

    Attributes:
        twist: Forward and leftward velocity of the body's centre [m/s] and yaw rate [rad/s],
            shape (n, 3).
        pose: Height of the body's centre [m], roll and pitch [rad], shape (n, 3).
        contact: Whether a leg is on the ground, 1 or 0, shape (n, 6).
        slip: Forward and leftward velocity of each contact over the ground that least squares
            leaves, zero in the air, shape (n, 6, 2) [m/s].
    """

    twist: Array
    pose: Array
    contact: Array
    slip: Array


def walk_no_slip(
    robot: Robot, reference: LegReference, *, duration: float, dt: float = 0.001
) -> WalkPath:
    """Compute a walk by leg kinematics without slip, contacts standing still by least squares.

    Args:
        robot: The robot; its leg offsets are added to the angles.
        reference: Leg angles over time; of any gait in which three legs hold the robot.
        duration: Time walked [s].
        dt: Length of a step [s].

    Returns:
        The path from the origin. `slip_velocity` is the residual of the least squares; forces are
        NaN on the ground and zero in the air, slip ratios NaN.

    Raises:
        DomainError: The duration is not finite or rounds to no step.
        WalkError: At some instant no three legs hold the robot; the message says when.
    """
    return _walk(robot, reference, duration, dt, wheels=False)


def walk_wheels(
    robot: Robot, reference: LegReference, *, duration: float, dt: float = 0.001
) -> WalkPath:
    r"""Compute a walk on wheels of radius 2r: a leg on the ground moves its hip at 2 r theta_dot.

    Args:
        robot: The robot; its leg offsets are added to the angles.
        reference: Leg angles over time; of any gait in which three legs hold the robot.
        duration: Time walked [s].
        dt: Length of a step [s].

    Returns:
        The path from the origin, the body level at height 2r. `slip_velocity` is the sideways
        velocity of the hips, which the wheels ignore, and the residual of least squares along the
        heading; forces are NaN on the ground and zero in the air, slip ratios NaN.

    Raises:
        DomainError: The duration is not finite or rounds to no step.
        WalkError: At some instant no three legs hold the robot; the message says when.
    """
    return _walk(robot, reference, duration, dt, wheels=True)


def _walk(
    robot: Robot, reference: LegReference, duration: float, dt: float, *, wheels: bool
) -> WalkPath:
    """Compute the path of `walk_no_slip`, or with `wheels` of `walk_wheels`, from the origin."""
    t = step_times(duration, dt)
    seen = _motion(robot, reference, t, wheels=wheels)
    # Steps take the velocity at their middle: second order, and never on a kink of the gait.
    between = _motion(robot, reference, t[:-1] + dt / 2, wheels=wheels)
    xy, yaw = integrate_twists(between.twist, dt)
    on_ground = np.where(seen.contact > 0, np.nan, 0.0)
    return WalkPath(
        t=t,
        position=np.column_stack([xy, seen.pose[:, 0]]),
        orientation=np.column_stack([seen.pose[:, 1:], yaw]),
        theta=reference.angles(t) + robot.leg_offset,
        contact=seen.contact > 0,
        slip_velocity=seen.slip,
        slip_ratio=np.full(seen.contact.shape, np.nan),
        normal_force=on_ground,
        traction_force=np.stack([on_ground, on_ground], axis=-1),
    )


def _motion(robot: Robot, reference: LegReference, t: Array, *, wheels: bool) -> Motion:
    """Compute the body's motion at times t; raise `WalkError` if no three legs hold the robot."""
    n = len(t)
    motion = Motion(
        np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, N_LEGS)), np.zeros((n, N_LEGS, 2))
    )
    skeleton = Skeleton(robot.hips, robot.leg_radius, robot.toe_beyond)
    theta = reference.angles(t) + robot.leg_offset
    done = move(skeleton, theta, reference.speeds(t), wheels, motion)
    if done < n:
        degrees = ", ".join(f"{a:.4g}" for a in np.degrees(wrap_angle(theta[done])))
        raise WalkError(
            f"at t = {t[done]:.4g} s, leg angles {degrees} degrees, no three legs hold the robot; "
            "use the dynamics model, which lets it fall"
        )
    return motion


def integrate_twists(twist: Array, dt: float) -> tuple[Array, Array]:
    """Integrate rows of `Motion.twist` over steps dt to positions (n + 1, 2) [m] and yaw [rad].

    Both start at zero; each step is a chord along the mean of its two headings.
    """
    yaw = np.concatenate([[0.0], np.cumsum(twist[:, 2]) * dt])
    middle = 0.5 * (yaw[1:] + yaw[:-1])
    forward, left = twist[:, 0] * dt, twist[:, 1] * dt
    dx = forward * np.cos(middle) - left * np.sin(middle)
    dy = forward * np.sin(middle) + left * np.cos(middle)
    xy = np.column_stack([np.cumsum(dx), np.cumsum(dy)])
    return np.vstack([np.zeros(2), xy]), yaw


@compiled
def move(skeleton, theta, speed, wheels, motion):
    """Compute the motion of the body at every instant from leg angles and speeds.

    The robot stays on the three legs of the instant before while they hold it, else rests anew.

    Args:
        skeleton: The robot's geometry.
        theta: Leg angles, shape (n, 6) [rad].
        speed: Leg speeds, shape (n, 6) [rad/s].
        wheels: Whether to treat the legs as wheels, as `walk_wheels` does.
        motion: Filled: the motion.

    Returns:
        Number of instants computed: n, or fewer where no three legs hold the robot.
    """
    hips, r, beyond = skeleton
    points, up, seen = np.empty((6, 3)), np.empty(3), np.empty((6, 2))
    legs = np.full(3, -1, np.intp)
    level, own = np.empty(6), np.empty((6, 3))
    for k in range(len(theta)):
        # Keep the legs of the instant before while stable: among four legs in one plane any
        # three would do, and they should not alternate.
        kept = (
            legs[0] >= 0 and holds(theta[k], hips, r, beyond, legs, points, up, seen) >= -ON_GROUND
        )
        if not kept:
            rest(theta[k], hips, r, beyond, legs)
            if legs[0] < 0:
                return k
        on_three_legs(theta[k], hips, r, beyond, legs, points, up, seen)
        for leg in range(6):
            x, y, z = points[leg]
            level[leg] = up[0] * x + up[1] * y + up[2] * z
        ground = level[legs[0]]
        for leg in range(6):
            motion.contact[k, leg] = level[leg] <= ground + ON_GROUND
        if wheels:
            motion.pose[k, 0] = 2 * r
            roll_wheels(hips, r, speed[k], motion.contact[k], motion.twist[k], motion.slip[k])
        else:
            motion.pose[k, 0] = -ground
            motion.pose[k, 1], motion.pose[k, 2] = np.arctan2(up[1], up[2]), -np.arcsin(up[0])
            leg_velocities(hips, points, up, speed[k], own)
            stand_still(
                seen, -level, own, up, legs, motion.contact[k], motion.twist[k], motion.slip[k]
            )
    return len(theta)


@compiled
def leg_velocities(hips, points, up, speed, own):
    """Compute the legs' material velocities at their lowest points, relative to the body.

    Args:
        hips: Hip positions in the body frame, shape (6, 3) [m].
        points: Lowest points in the body frame, shape (6, 3) [m].
        up: Vertical direction in the body frame, shape (3,) [-].
        speed: Leg speeds, shape (6,) [rad/s].
        own: Filled: velocities forward, left and up in the heading frame, shape (6, 3) [m/s].
    """
    size = np.sqrt(1 - up[0] ** 2)
    for leg in range(6):
        # theta_dot about the body's y axis: e_y x (x, y, z) = (z, 0, -x)
        x = speed[leg] * (points[leg, 2] - hips[leg, 2])
        z = -speed[leg] * (points[leg, 0] - hips[leg, 0])
        own[leg, 0] = size * x - up[0] * up[2] / size * z
        own[leg, 1] = -up[1] / size * z
        own[leg, 2] = up[0] * x + up[2] * z


@compiled
def stand_still(seen, below, own, up, legs, contact, twist, slip):
    """Compute the body's twist that keeps contacts in place, by least squares, and their slip.

    Forward velocity and yaw rate are fitted to the contacts' forward velocities alone, then
    leftward velocity, with the yaw rate from before, to their leftward ones.

    Args:
        seen: Contact points from the body's centre, forward and left, shape (6, 2) [m].
        below: Distance of each contact point below the centre, shape (6,) [m].
        own: Velocities of the legs' points relative to the body, `leg_velocities`, (6, 3) [m/s].
        up: Vertical direction in the body frame, shape (3,) [-].
        legs: Indices of the three legs that determine height, roll and pitch, shape (3,).
        contact: Whether a leg is on the ground, 1 or 0, shape (6,).
        twist: Filled: forward and leftward velocity [m/s] and yaw rate [rad/s], shape (3,).
        slip: Filled for legs on the ground: velocity over it, forward and left, (6, 2) [m/s].
    """
    roll, pitch = vertical_rates(seen, own, legs)
    count, mean = 0.0, np.zeros(4)
    for leg in range(6):
        if contact[leg] > 0:
            # Horizontal velocity that the body needs at this contact.
            slip[leg, 0] = -own[leg, 0] + pitch * below[leg]
            slip[leg, 1] = -own[leg, 1] - roll * below[leg]
            count += 1.0
            for a in range(2):
                mean[a] += seen[leg, a]
                mean[2 + a] += slip[leg, a]
    mean /= count
    turning, spread = 0.0, 0.0
    for leg in range(6):
        if contact[leg] > 0:
            y = seen[leg, 1] - mean[1]
            turning -= y * (slip[leg, 0] - mean[2])
            spread += y * y
    spin = turning / spread
    twist[0], twist[1] = mean[2] + spin * mean[1], mean[3] - spin * mean[0]
    # The yaw angle's rate is not quite the vertical angular velocity where the body rolls nose up.
    twist[2] = spin - roll * up[0] / np.sqrt(1 - up[0] ** 2)
    for leg in range(6):
        if contact[leg] > 0:
            slip[leg, 0] = twist[0] - spin * seen[leg, 1] - slip[leg, 0]
            slip[leg, 1] = twist[1] + spin * seen[leg, 0] - slip[leg, 1]


@compiled
def vertical_rates(seen, own, legs):
    """Compute the angular velocity about forward and left that keeps three legs on the ground.

    Args:
        seen: Lowest points seen from above, shape (6, 2) [m].
        own: Velocities of the legs relative to the body: forward, left, up, shape (6, 3) [m/s].
        legs: Indices of the three legs, shape (3,).

    Returns:
        Angular velocity about forward and about left [rad/s], by which the three points rise
        equally fast; height takes up the rest.
    """
    a, b, c = legs
    # v_z + w_x y - w_y x + own_z = 0 for each; differences leave w_x and w_y.
    x1, y1, d1 = seen[b, 0] - seen[a, 0], seen[b, 1] - seen[a, 1], own[a, 2] - own[b, 2]
    x2, y2, d2 = seen[c, 0] - seen[a, 0], seen[c, 1] - seen[a, 1], own[a, 2] - own[c, 2]
    determinant = x1 * y2 - x2 * y1
    return (x1 * d2 - x2 * d1) / determinant, (y1 * d2 - y2 * d1) / determinant


@compiled
def roll_wheels(hips, r, speed, contact, twist, slip):
    """Compute the body's twist on wheels of radius 2r that do not steer, by least squares.

    Args:
        hips: Hip positions in the body frame, shape (6, 3) [m].
        r: Radius of the legs' arcs [m].
        speed: Leg speeds, shape (6,) [rad/s].
        contact: Whether a leg is on the ground, 1 or 0, shape (6,).
        twist: Filled: forward velocity, leftward velocity (zero) [m/s], yaw rate [rad/s], (3,).
        slip: Filled for legs on the ground: velocity over it, forward and left, (6, 2) [m/s].
    """
    count, mean_y, mean_v = 0.0, 0.0, 0.0
    for leg in range(6):
        if contact[leg] > 0:
            count += 1.0
            mean_y += hips[leg, 1]
            mean_v += 2 * r * speed[leg]
    mean_y /= count
    mean_v /= count
    turning, spread = 0.0, 0.0
    for leg in range(6):
        if contact[leg] > 0:
            y = hips[leg, 1] - mean_y
            turning -= y * (2 * r * speed[leg] - mean_v)
            spread += y * y
    twist[2] = turning / spread
    twist[0], twist[1] = mean_v + twist[2] * mean_y, 0.0
    for leg in range(6):
        if contact[leg] > 0:
            slip[leg, 0] = twist[0] - twist[2] * hips[leg, 1] - 2 * r * speed[leg]
            slip[leg, 1] = twist[2] * hips[leg, 0]
