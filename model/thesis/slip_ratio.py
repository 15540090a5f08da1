# SPDX-License-Identifier: MIT
"""Slip ratios of the thesis's walk, longitudinal and lateral, Eq. (4-31) to (4-42)."""

import numpy as np

from model.compiled import compiled
from model.leg import TOE, leg_state

LARGEST_SLIP = 100.0  # where Listing A.19 cuts the slip ratio off [-]


@compiled
def along(axis, v, arm):
    """Compute the component along an axis of the velocity v + w x arm of a point on the body.

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
    r"""Compute the thesis's slip ratio of a walk, Eq. (4-31) and (4-36), as in Listing A.19 [-].

    .. math::
        \kappa = \frac{v_R - v_C}{v_C} \text{ rolling}, \qquad
        \kappa = \frac{v_T - v_H}{v_H} \text{ on the toe}

    with absolute values in the denominators, cut off at ±100; zero where both speeds are. Rolling,
    the listing takes sign(v_R) (v_R - |v_C|) for the numerator. This is the same while robot and
    legs go forward, but a leg that turns back very slowly gets full traction.

    Args:
        leg_speed: Speed of the leg's surface, v_R or v_T [m/s].
        ground_speed: Forward speed of the body's point at the contact, v_C, or hip, v_H [m/s].
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
def lateral_walk_slip(forward, left, signed):
    """Compute lateral slip, the slip angle over pi/2, of a velocity, Listing A.21 [-].

    Eq. (4-41), (4-42): from -1 to 1, positive when the point moves to the right and forward, zero
    without leftward velocity. The listing has the wrong sign for a body that goes backward.

    Args:
        forward: Forward component of the velocity [m/s].
        left: Its leftward component [m/s].
        signed: Whether to correct the sign for a body that goes backward.
    """
    if left == 0.0:
        return 0.0
    if signed:
        return np.arctan2(-left, abs(forward)) / (np.pi / 2)
    return np.arctan(-left / forward) / (np.pi / 2)


@compiled
def find_slip(machine, manner, traction, legs, three, q, v, balance):
    """Compute the lever arms and slip ratios of the three legs that carry load.

    v_R of Eq. (4-32) and v_T of Eq. (4-37) are the same, minus the rate of phi times the hip's
    height. The ground speed is that at the hip for a leg on its toe, else at the contact; lateral
    slip is the body's, the same for all legs, where Eq. (4-41) prints each contact's. Slip has the
    sign of the equations on the toe and with `manner.mend_slip`, else the listing's. For a law by
    slip velocity, slip is velocity over the table's `speed_scale`.

    Args:
        machine: The robot.
        manner: Settings of the steps.
        traction: The slip law.
        legs: Kinematics of the legs.
        three: Indices of the legs that carry load, shape (3,).
        q: Coordinates, shape (6,) [m, rad].
        v: Rates of the coordinates, shape (6,) [m/s, rad/s].
        balance: Contacts, of which `axes` are used, `arms`, `slip` and `speeds` filled.
    """
    arm, body = np.empty(3), np.zeros(3)
    forward, left = along(balance.axes[0], v, body), along(balance.axes[1], v, body)
    for k in range(3):
        i = three[k]
        toe = leg_state(legs.phi[i], machine.toe_beyond) == TOE
        for a in range(3):
            balance.arms[k, a] = legs.point[i, a] - q[a]
            arm[a] = legs.hip[i, a] - q[a]
        leg_speed = -legs.phi_rate[i] * legs.height[i]
        contact_speed = along(balance.axes[0], v, balance.arms[k])
        hip_speed = along(balance.axes[0], v, arm)
        balance.speeds[k, 0], balance.speeds[k, 1] = leg_speed, contact_speed
        balance.speeds[k, 2] = hip_speed
        ground_speed = hip_speed if toe else contact_speed
        if traction.table.by_velocity:
            scale = traction.table.speed_scale
            balance.slip[k, 0] = (leg_speed - ground_speed) / scale
            balance.slip[k, 1] = -left / scale
        else:
            balance.slip[k, 0] = walk_slip(leg_speed, ground_speed, toe or manner.mend_slip)
            balance.slip[k, 1] = lateral_walk_slip(forward, left, manner.mend_slip)
