# SPDX-License-Identifier: MIT
"""Kinematics of the thesis's legs: contact points, hip heights and the state set from them."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.compiled import compiled
from model.leg import (
    contact_angle,
    contact_in_body,
    hip_height,
    hip_height_acceleration,
    hip_height_rate,
    thesis_lowest_angle,
    thesis_lowest_angle_rate,
    thesis_tilt,
    thesis_tilt_rate,
)


class Legs(NamedTuple):
    """Kinematics of the six legs at one instant, overwritten at every step.

    Attributes:
        phi: Angle of the lowest point of each leg's circle, shape (6,) [rad].
        phi_rate: Rate of phi, shape (6,) [rad/s].
        height: Height of each hip above its leg's lowest point, in the leg's plane, (6,) [m].
        height_rate: Rate of that height at the stance speed of the leg, without rotation of the
            body, shape (6,) [m/s].
        height_acceleration: Second derivative of that height at constant phi_rate, (6,) [m/s2].
        point: Lowest point of each leg in the inertial frame, shape (6, 3) [m].
        hip: Position of each hip in the inertial frame, computed with the body's position one step
            ago and its orientation now, shape (6, 3) [m].
    """

    phi: Array
    phi_rate: Array
    height: Array
    height_rate: Array
    height_acceleration: Array
    point: Array
    hip: Array


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
    """Compute lowest points, hip heights and their rates of all legs at one instant.

    Hips are placed from the body's position one step ago, as in the listing, where that variable
    is set after its use.

    Args:
        machine: The robot.
        q: Coordinates x, y, z [m], roll, pitch and yaw [rad], shape (6,).
        v: Rates of the coordinates, shape (6,) [m/s, rad/s].
        theta: Leg angles, shape (6,) [rad].
        speed: Leg speeds, shape (6,) [rad/s].
        stance_speed: Speed of each leg when on the ground, shape (6,) [rad/s].
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
    """Compute the mean of a value over the legs of one side that are on the ground.

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
    """Compute the kinematic roll rate: inner minus outer rate of hip height, over the track.

    Eq. (3-41), with means over the legs on the ground; divided by cos(roll).

    Args:
        machine: The robot.
        manner: Settings of the steps.
        legs: Kinematics of the legs.
        sides: Whether a leg is on the ground, shape (6,).
        roll: Roll [rad].

    Returns:
        Roll rate, NaN where no leg of a side is on the ground [rad/s].
    """
    inner = side_mean(legs.height_rate, sides, manner.inner)
    outer = side_mean(legs.height_rate, sides, 1 - manner.inner)
    return (inner - outer) / (np.cos(roll) * machine.track)


@compiled
def reset(machine, manner, legs, sides, q, v):
    """Set roll, pitch and the rates of height and roll from hip heights at a change of contacts.

    Eq. (3-40), (3-41): roll from the difference of mean inner and outer hip height, pitch zero;
    except by the text height too, to the mean of both sides. The rate of height is the mean of both
    sides' rates.

    Args:
        machine: The robot.
        manner: Settings of the steps.
        legs: Kinematics of the legs.
        sides: Whether a leg is on the ground, shape (6,).
        q: Coordinates; roll, pitch and perhaps height are overwritten, shape (6,) [m, rad].
        v: Rates of the coordinates; of height and roll overwritten, shape (6,) [m/s, rad/s].
    """
    inner = side_mean(legs.height, sides, manner.inner) * np.cos(q[3])
    outer = side_mean(legs.height, sides, 1 - manner.inner) * np.cos(q[3])
    v[3] = roll_rate(machine, manner, legs, sides, q[3])
    v[2] = 0.5 * (side_mean(legs.height_rate, sides, 0) + side_mean(legs.height_rate, sides, 1))
    q[3] = np.arcsin((inner - outer) / machine.track)
    q[4] = 0.0
    if not manner.by_text:
        q[2] = 0.5 * (inner + outer)
