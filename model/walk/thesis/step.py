# SPDX-License-Identifier: MIT
"""The thesis's main loop, Listing A.4, compiled.

State: q = (x, y, z, roll, pitch, yaw) and its rates v, with the angles of Eq. (3-7). The thesis
takes the rates of these angles for the components of the angular velocity, and does not turn the
inertia with the body; both are kept.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.compiled import compiled
from model.contact.tripod import switch_by_listing, switch_by_table
from model.leg import (
    TOE,
    contact_angle,
    contact_in_body,
    hip_height,
    hip_height_acceleration,
    hip_height_rate,
    leg_state,
    thesis_lowest_angle,
    thesis_lowest_angle_rate,
    thesis_tilt,
    thesis_tilt_rate,
)
from model.robot import GRAVITY
from model.slip.law import Array
from model.walk.thesis.loads import Balance, leg_force, normal_forces, static_loads
from model.walk.thesis.traction import traction_force

LARGEST_SLIP = 100.0  # where Listing A.19 cuts the slip ratio off [-]
RUNAWAY = 50.0  # faster than any walking robot [m/s, rad/s]


class Machine(NamedTuple):
    """The robot as arrays for the compiled loop: `model.robot.Robot`."""

    hips: Array
    radius: float
    toe_beyond: float
    mass: float
    inertia: Array
    track: float


class Manner(NamedTuple):
    """Settings of the steps; see `ThesisOptions`."""

    dt: float
    inner: int
    by_table: bool
    reset_height: bool
    roll_sign: float
    mend_slip: bool
    every: int


class Legs(NamedTuple):
    """Kinematics of the six legs at one instant, overwritten at every step."""

    phi: Array
    phi_rate: Array
    height: Array
    height_rate: Array
    height_acceleration: Array
    point: Array
    hip: Array


class Record(NamedTuple):
    """Arrays of the samples that are kept: the state before a step, and the step's contacts."""

    state: Array
    contact: NDArray[np.bool_]
    kappa: Array
    normal: Array
    forward: Array
    left: Array


@compiled
def turn(q, vector, out):
    """Rotate a body vector to the inertial frame by Rx(roll) Ry(pitch) Rz(yaw), Eq. (3-7).

    Args:
        q: Coordinates x, y, z [m], roll, pitch and yaw [rad], shape (6,).
        vector: Vector in the body frame, shape (3,).
        out: Filled: the vector in the inertial frame, shape (3,).
    """
    cr, sr, cp, sp = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    cy, sy = np.cos(q[5]), np.sin(q[5])
    x, y = cy * vector[0] - sy * vector[1], sy * vector[0] + cy * vector[1]
    x, z = cp * x + sp * vector[2], -sp * x + cp * vector[2]
    out[0], out[1], out[2] = x, cr * y - sr * z, sr * y + cr * z


@compiled
def place_legs(machine, q, v, theta, speed, stance_speed, centre_before, legs):
    """Compute the kinematics of the legs at one instant.

    Hips are placed from the body's position one step ago, as in the listing, where that variable
    is set after its use.

    Args:
        machine: The robot.
        q: Coordinates x, y, z [m], roll, pitch and yaw [rad], shape (6,).
        v: Their rates, shape (6,) [m/s, rad/s].
        theta: Leg angles, shape (6,) [rad].
        speed: Leg speeds, shape (6,) [rad/s].
        stance_speed: Speeds that legs have, or would have, on the ground, shape (6,) [rad/s].
        centre_before: Position of the body one step ago, shape (3,) [m].
        legs: Filled: kinematics of the legs.

    Returns:
        Tilt X of Eq. (3-21) [-].
    """
    r, beyond = machine.radius, machine.toe_beyond
    tilt = thesis_tilt(q[3], q[4], q[5])
    tilt_rate = thesis_tilt_rate(q[3], q[4], q[5], v[3], v[4], v[5])
    vector = np.empty(3)
    for i in range(6):
        phi = thesis_lowest_angle(theta[i], tilt)
        phi_rate = thesis_lowest_angle_rate(speed[i], tilt, tilt_rate)
        legs.phi[i], legs.phi_rate[i] = phi, phi_rate
        legs.height[i] = hip_height(phi, r, beyond)
        legs.height_rate[i] = hip_height_rate(phi, -stance_speed[i], r, beyond)
        legs.height_acceleration[i] = hip_height_acceleration(phi, phi_rate, r, beyond)
        x, z = contact_in_body(theta[i], contact_angle(phi, beyond), r)
        vector[0], vector[1] = machine.hips[i, 0] + x, machine.hips[i, 1]
        vector[2] = machine.hips[i, 2] + z
        turn(q, vector, legs.point[i])
        turn(q, machine.hips[i], legs.hip[i])
        for a in range(3):
            legs.point[i, a] += q[a]
            legs.hip[i, a] += centre_before[a]
    return tilt


@compiled
def side_mean(values, contact, side):
    """Average over the legs on the ground of one side.

    Args:
        values: One value a leg, shape (6,).
        contact: Whether a leg is on the ground, shape (6,).
        side: 0 for left, 1 for right.

    Returns:
        The mean; NaN with no leg of the side on the ground.
    """
    total, count = 0.0, 0
    for i in range(side, 6, 2):
        if contact[i]:
            total += values[i]
            count += 1
    return total / count


@compiled
def roll_rate(machine, manner, legs, sides, roll):
    """Compute the kinematic roll rate from the rates of the hip heights, Eq. (3-41).

    Args:
        machine: The robot.
        manner: Settings of the steps.
        legs: Kinematics of the legs.
        sides: Whether a leg is on the ground, shape (6,).
        roll: Roll [rad].

    Returns:
        Roll rate [rad/s].
    """
    inner = side_mean(legs.height_rate, sides, manner.inner)
    outer = side_mean(legs.height_rate, sides, 1 - manner.inner)
    return manner.roll_sign * (inner - outer) / (np.cos(roll) * machine.track)


@compiled
def reset(machine, manner, legs, sides, q, v):
    """Set the state that kinematics determines, at a change of contacts: Eq. (3-40), (3-41).

    Args:
        machine: The robot.
        manner: Settings of the steps.
        legs: Kinematics of the legs.
        sides: Whether a leg is on the ground, shape (6,).
        q: Coordinates; roll, pitch and, where asked for, height are overwritten, shape (6,)
            [m, rad].
        v: Their rates; those of height and roll are overwritten, shape (6,) [m/s, rad/s].
    """
    inner = side_mean(legs.height, sides, manner.inner) * np.cos(q[3])
    outer = side_mean(legs.height, sides, 1 - manner.inner) * np.cos(q[3])
    v[3] = roll_rate(machine, manner, legs, sides, q[3])
    v[2] = 0.5 * (side_mean(legs.height_rate, sides, 0) + side_mean(legs.height_rate, sides, 1))
    q[3] = manner.roll_sign * np.arcsin((inner - outer) / machine.track)
    q[4] = 0.0
    if manner.reset_height:
        q[2] = 0.5 * (inner + outer)


@compiled
def three_legs(sides, legs, q, three):
    """Choose the three legs that carry load, from the sides' contact states.

    With two legs down the listing keeps the three of the step before. Of four it keeps, by an
    oversight in its sorting, the three furthest from the body's centre.

    Args:
        sides: Whether a leg is on the ground, shape (6,).
        legs: Kinematics of the legs.
        q: Coordinates, the first two the body's x and y [m], shape (6,).
        three: Overwritten with the indices of the legs, shape (3,).
    """
    down = 0
    for i in range(6):
        down += sides[i]
    if down < 3:
        return
    dropped, nearest = -1, np.inf
    for i in range(6):
        distance = (legs.point[i, 0] - q[0]) ** 2 + (legs.point[i, 1] - q[1]) ** 2
        if sides[i] and down == 4 and distance < nearest:
            dropped, nearest = i, distance
    k = 0
    for i in range(6):
        if sides[i] and i != dropped:
            three[k] = i
            k += 1


@compiled
def contact_axes(yaw, tilt, axes):
    """Compute the axes of the contact frames in the inertial frame.

    All legs share them: R_y R_theta R_phi of Eq. (3-13) turns about y by theta + phi - pi/2, which
    is the arctangent of the tilt.

    Args:
        yaw: Yaw [rad].
        tilt: Tilt X of Eq. (3-21) [-].
        axes: Filled: forward, left and up, in rows, shape (3, 3) [-].
    """
    c, s, cb, sb = np.cos(yaw), np.sin(yaw), 1 / np.sqrt(1 + tilt**2), tilt / np.sqrt(1 + tilt**2)
    axes[0, 0], axes[0, 1], axes[0, 2] = c * cb, s * cb, -sb
    axes[1, 0], axes[1, 1], axes[1, 2] = -s, c, 0.0
    axes[2, 0], axes[2, 1], axes[2, 2] = c * sb, s * sb, cb


@compiled
def along(axis, v, arm):
    """Compute the component of the velocity v + w x arm along an axis.

    Args:
        axis: Unit vector, shape (3,) [-].
        v: Rates of the six coordinates: v [m/s], then w [rad/s], shape (6,).
        arm: Point from the body's centre, shape (3,) [m].

    Returns:
        Velocity [m/s].
    """
    x = v[0] + v[4] * arm[2] - v[5] * arm[1]
    y = v[1] + v[5] * arm[0] - v[3] * arm[2]
    z = v[2] + v[3] * arm[1] - v[4] * arm[0]
    return axis[0] * x + axis[1] * y + axis[2] * z


@compiled
def walk_slip(leg_speed, ground_speed, signed):
    r"""Compute the walk's slip ratio, Eq. (4-31) and (4-36), as Listing A.19 has it [-].

    .. math::
        \kappa = \frac{v_R - v_C}{v_C} \text{ rolling}, \qquad
        \kappa = \frac{v_T - v_H}{v_H} \text{ on the toe}

    with absolute values in the denominators, cut off at 100. Rolling, the listing takes
    sign(v_R) (v_R - |v_C|) for the numerator. This is the same while robot and legs go forward, but
    a leg that turns back very slowly gets full traction.

    Args:
        leg_speed: Speed of the leg's surface, v_R or v_T [m/s].
        ground_speed: Speed of the robot over the ground, v_C or v_H [m/s].
        signed: Whether to take the difference as in the equation above instead of the listing's.
    """
    if leg_speed == 0.0 and ground_speed == 0.0:
        return 0.0
    difference = leg_speed - ground_speed
    if not signed:
        difference = np.sign(leg_speed) * (leg_speed - abs(ground_speed))
    kappa = difference / abs(ground_speed)
    return min(max(kappa, -LARGEST_SLIP), LARGEST_SLIP)


@compiled
def lateral_walk_slip(axes, v, signed):
    """Compute the lateral slip of Eq. (4-41), (4-42) from the body's velocity, Listing A.21 [-].

    The listing has the wrong sign for a body that goes backward.

    Args:
        axes: Forward, left and up of the contact frames, in rows, shape (3, 3) [-].
        v: Rates of the six coordinates, shape (6,) [m/s, rad/s].
        signed: Whether to take the right sign instead of the listing's.
    """
    forward = axes[0, 0] * v[0] + axes[0, 1] * v[1] + axes[0, 2] * v[2]
    left = axes[1, 0] * v[0] + axes[1, 1] * v[1] + axes[1, 2] * v[2]
    if left == 0.0:
        return 0.0
    if signed:
        return np.arctan2(-left, abs(forward)) / (np.pi / 2)
    return np.arctan(-left / forward) / (np.pi / 2)


@compiled
def find_slip(machine, manner, traction, legs, three, q, v, balance):
    """Compute the lever arms and slip ratios of the three legs that carry load.

    v_R of Eq. (4-32) and v_T of Eq. (4-37) are the same, the rate of phi times the hip's height.

    Args:
        machine: The robot.
        manner: Settings of the steps.
        traction: The slip law.
        legs: Kinematics of the legs.
        three: Indices of the legs that carry load, shape (3,).
        q: Coordinates, shape (6,) [m, rad].
        v: Their rates, shape (6,) [m/s, rad/s].
        balance: Its `axes` are used; its `arms` and `slip` are filled.
    """
    arm = np.empty(3)
    for k in range(3):
        i = three[k]
        toe = leg_state(legs.phi[i], machine.toe_beyond) == TOE
        for a in range(3):
            balance.arms[k, a] = legs.point[i, a] - q[a]
            arm[a] = legs.hip[i, a] - q[a] if toe else balance.arms[k, a]
        leg_speed = -legs.phi_rate[i] * legs.height[i]
        ground_speed = along(balance.axes[0], v, arm)
        if traction.table.by_velocity:
            scale = traction.table.speed_scale
            balance.slip[k, 0] = (leg_speed - ground_speed) / scale
            body = balance.axes[1]
            balance.slip[k, 1] = -(body[0] * v[0] + body[1] * v[1] + body[2] * v[2]) / scale
        else:
            balance.slip[k, 0] = walk_slip(leg_speed, ground_speed, toe or manner.mend_slip)
            balance.slip[k, 1] = lateral_walk_slip(balance.axes, v, manner.mend_slip)


@compiled
def gyroscopic(inertia, v, out):
    """Compute the gyroscopic acceleration J^-1 (w x J w), Eq. (4-8) [rad/s2].

    Args:
        inertia: Principal moments of inertia J, shape (3,) [kg m2].
        v: Rates of the six coordinates, the last three taken for w, shape (6,) [m/s, rad/s].
        out: Filled: the acceleration, shape (3,) [rad/s2].
    """
    out[0] = (inertia[2] - inertia[1]) * v[4] * v[5] / inertia[0]
    out[1] = (inertia[0] - inertia[2]) * v[5] * v[3] / inertia[1]
    out[2] = (inertia[1] - inertia[0]) * v[3] * v[4] / inertia[2]


@compiled
def accelerate(machine, manner, traction, balance, loads, spin, v, forces):
    """Integrate the rates over one step by Newton's and Euler's equations, Eq. (4-14).

    Args:
        machine: The robot.
        manner: Settings of the steps.
        traction: The slip law.
        balance: Lever arms, axes and slip of the legs that carry load.
        loads: Their normal forces, shape (3,) [N].
        spin: Gyroscopic acceleration, shape (3,) [rad/s2].
        v: Rates of the six coordinates, updated, shape (6,) [m/s, rad/s].
        forces: Filled: forward and leftward force of each leg, shape (3, 2) [N].
    """
    force, dt = np.empty(3), manner.dt
    v[2] -= dt * GRAVITY
    for a in range(3):
        v[3 + a] -= dt * spin[a]
    for k in range(3):
        x, y, z = balance.arms[k]
        forces[k, 0] = traction_force(traction, balance.slip[k, 0], loads[k])
        forces[k, 1] = traction_force(traction, balance.slip[k, 1], loads[k])
        leg_force(balance.axes, forces[k, 0], forces[k, 1], loads[k], force)
        for a in range(3):
            v[a] += dt * force[a] / machine.mass
        v[3] += dt * (y * force[2] - z * force[1]) / machine.inertia[0]
        v[4] += dt * (z * force[0] - x * force[2]) / machine.inertia[1]
        v[5] += dt * (x * force[1] - y * force[0]) / machine.inertia[2]


@compiled
def demands(machine, manner, legs, sides, q, v, spin, balance):
    """Compute the accelerations and the sum that normal forces have to produce, Eq. (4-22).

    The ground does not pull. Where the kinematic acceleration asks for a negative sum (a leg that
    meets the ground at flight speed), the sum is zero. The thesis's problem has no solution there.

    Args:
        machine: The robot.
        manner: Settings of the steps.
        legs: Kinematics of the legs.
        sides: Whether a leg is on the ground, shape (6,).
        q: Coordinates, shape (6,) [m, rad].
        v: Their rates, shape (6,) [m/s, rad/s].
        spin: Gyroscopic acceleration, shape (3,) [rad/s2].
        balance: Its `wanted` is filled.

    Returns:
        Sum of the normal forces, at most three times the weight [N].
    """
    balance.wanted[0] = (roll_rate(machine, manner, legs, sides, q[3]) - v[3]) / manner.dt + spin[0]
    balance.wanted[1] = -v[4] / manner.dt + spin[1]
    up = 0.5 * (
        side_mean(legs.height_acceleration, sides, 0)
        + side_mean(legs.height_acceleration, sides, 1)
    )
    weight = machine.mass * GRAVITY
    return min(max(weight + machine.mass * up, 0.0), 3 * weight)


@compiled
def run(machine, manner, traction, motion, q, v, sides, record):
    """Integrate the thesis's model over all steps.

    Args:
        machine: The robot.
        manner: Settings of the steps.
        traction: The slip law.
        motion: Leg angles and speeds at every step.
        q: Coordinates at the start, overwritten, shape (6,) [m, rad].
        v: Their rates, overwritten, shape (6,) [m/s, rad/s].
        sides: Contact state at the start, overwritten, shape (6,).
        record: Filled: the samples that are kept.

    Returns:
        Number of steps whose rates stayed below `RUNAWAY`.
    """
    legs = Legs(
        np.empty(6), np.empty(6), np.empty(6), np.empty(6), np.empty(6),
        np.empty((6, 3)), np.empty((6, 3)),
    )  # fmt: skip
    balance = Balance(
        np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 2)), machine.inertia[:2], np.empty(2)
    )
    three, loads, spin, forces = np.zeros(3, np.intp), np.empty(3), np.empty(3), np.empty((3, 2))
    centre_before = q[:3].copy()
    steps = len(motion.theta)
    for step in range(steps):
        keep, row = step % manner.every == 0, step // manner.every
        if keep:
            record.state[row] = q
        theta, speed, stance_speed = (
            motion.theta[step], motion.speed[step], motion.stance_speed[step]
        )  # fmt: skip
        tilt = place_legs(machine, q, v, theta, speed, stance_speed, centre_before, legs)
        centre_before[:] = q[:3]
        if manner.by_table:
            changed = switch_by_table(legs.height, sides)
        else:
            changed = switch_by_listing(legs.height, sides, manner.inner)
        three_legs(sides, legs, q, three)
        if changed or step == 0:
            reset(machine, manner, legs, sides, q, v)
        contact_axes(q[5], tilt, balance.axes)
        find_slip(machine, manner, traction, legs, three, q, v, balance)
        gyroscopic(machine.inertia, v, spin)
        total = demands(machine, manner, legs, sides, q, v, spin, balance)
        static_loads(balance.arms, total, loads)
        normal_forces(balance, traction, total, machine.mass * GRAVITY, loads)
        accelerate(machine, manner, traction, balance, loads, spin, v, forces)
        if not np.abs(v).max() < RUNAWAY:
            return step
        if keep:
            for k in range(3):
                i = three[k]
                record.contact[row, i] = True
                record.kappa[row, i] = balance.slip[k, 0]
                record.normal[row, i] = loads[k]
                record.forward[row, i], record.left[row, i] = forces[k, 0], forces[k, 1]
        for a in range(6):
            q[a] += manner.dt * v[a]
    return steps
