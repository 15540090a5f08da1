# SPDX-License-Identifier: MIT
"""The thesis's main loop, Listing A.4, compiled.

State: q = (x, y, z, roll, pitch, yaw) and its rates v, with the angles of Eq. (3-7). The thesis
takes the rates of these angles for the components of the angular velocity, and does not turn the
inertia with the body; both are kept.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled
from model.robot import GRAVITY
from model.thesis.kinematics import Legs, place_legs, reset, roll_rate, side_mean
from model.thesis.loads import Balance, leg_force, normal_forces, static_loads
from model.thesis.record import keep_contacts, keep_legs
from model.thesis.slip_ratio import find_slip
from model.thesis.traction import traction_force
from model.thesis.tripod import switch_by_listing, switch_by_table

RUNAWAY = 50.0  # faster than any walking robot [m/s, rad/s]


class Machine(NamedTuple):
    """A robot as arrays for the compiled loop; see `model.robot.Robot`.

    Attributes:
        hips: Hip positions in the body frame, shape (6, 3) [m].
        radius: Radius of the legs' arcs [m].
        toe_beyond: Angle of the arcs beyond a half circle [rad].
        mass: Mass [kg].
        inertia: Principal moments of inertia, shape (3,) [kg m2].
        track: Mean distance between left and right hips [m].
    """

    hips: Array
    radius: float
    toe_beyond: float
    mass: float
    inertia: Array
    track: float


class Manner(NamedTuple):
    """Settings of the steps for the compiled loop; see `ThesisOptions`.

    Attributes:
        dt: Length of a step [s].
        inner: Side of the inner legs: 0 left, 1 right.
        by_text: Whether contacts change by Table 3-1 and leave the body's height as it is, instead
            of by the listing's rule.
        mend_slip: Whether slip has the sign of the equations instead of the listing's.
    """

    dt: float
    inner: int
    by_text: bool
    mend_slip: bool


@compiled
def three_legs(sides, legs, q, three):
    """Select the three legs that carry load from the legs on the ground.

    With fewer than three legs down the listing keeps the three of the step before. Of four it
    keeps, by an oversight in its sorting, the three furthest from the body's centre.

    Args:
        sides: Whether a leg is on the ground, shape (6,).
        legs: Kinematics of the legs.
        q: Coordinates, the first two the body's x and y [m], shape (6,).
        three: Overwritten with the indices of the legs, ascending, shape (3,).
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
    """Compute the axes of the contact frames in the inertial frame from yaw and tilt.

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
        loads: Normal forces of these legs, shape (3,) [N].
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
    """Compute what normal forces have to produce: roll and pitch acceleration and sum, Eq. (4-22).

    The ground does not pull. Where the kinematic acceleration asks for a negative sum (a leg that
    meets the ground at flight speed), the sum is zero. The thesis's problem has no solution there.

    Args:
        machine: The robot.
        manner: Settings of the steps.
        legs: Kinematics of the legs.
        sides: Whether a leg is on the ground, shape (6,).
        q: Coordinates, shape (6,) [m, rad].
        v: Rates of the coordinates, shape (6,) [m/s, rad/s].
        spin: Gyroscopic acceleration, shape (3,) [rad/s2].
        balance: Contacts, of which `wanted` is filled.

    Returns:
        Sum of the normal forces, from zero to three times the weight [N].
    """
    balance.wanted[0] = (roll_rate(machine, manner, legs, sides, q[3]) - v[3]) / manner.dt + spin[0]
    balance.wanted[1] = -v[4] / manner.dt + spin[1]
    up = 0.5 * (
        side_mean(legs.height_acceleration, sides, 0)
        + side_mean(legs.height_acceleration, sides, 1)
    )
    weight = machine.mass * GRAVITY
    return min(max(weight + machine.mass * up, 0.0), 3 * weight)


class ThesisSpare(NamedTuple):
    """Preallocated work arrays of a step.

    Attributes:
        legs: Kinematics of the legs.
        balance: Contacts of the legs that carry load.
        three: Indices of these legs, shape (3,).
        loads: Their normal forces, shape (3,) [N].
        static: Their normal forces in static equilibrium, shape (3,) [N].
        forces: Their forces forward and to the left, shape (3, 2) [N].
        spin: Gyroscopic acceleration, shape (3,) [rad/s2].
        centre_before: Position of the body one step ago, shape (3,) [m].
    """

    legs: Legs
    balance: Balance
    three: NDArray[np.intp]
    loads: Array
    static: Array
    forces: Array
    spin: Array
    centre_before: Array


@compiled
def _new_spare(machine, q):
    """Allocate the work arrays of a step; the body's position one step ago is that of `q`."""
    legs = Legs(
        np.empty(6), np.empty(6), np.empty(6), np.empty(6), np.empty(6),
        np.empty((6, 3)), np.empty((6, 3)),
    )  # fmt: skip
    balance = Balance(
        np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 2)), machine.inertia[:2], np.empty(2),
        np.empty((3, 3)),
    )  # fmt: skip
    return ThesisSpare(
        legs, balance, np.zeros(3, np.intp), np.empty(3), np.empty(3), np.empty((3, 2)),
        np.empty(3), q[:3].copy(),
    )  # fmt: skip


@compiled
def run(machine, manner, traction, motion, q, v, sides, record):
    """Integrate the thesis's model over all steps.

    Args:
        machine: The robot.
        manner: Settings of the steps.
        traction: The slip law.
        motion: Leg angles and speeds at every step.
        q: Coordinates at the start, overwritten, shape (6,) [m, rad].
        v: Rates of the coordinates, overwritten, shape (6,) [m/s, rad/s].
        sides: Whether a leg is on the ground at the start, overwritten, shape (6,).
        record: Filled: the samples.

    Returns:
        Number of steps computed: all, or those before one in which a rate reached `RUNAWAY` or
        became NaN.
    """
    spare = _new_spare(machine, q)
    three_legs(
        sides, spare.legs, q, spare.three
    )  # by Table 3-1 two may stand after the first switch
    for step in range(len(motion.theta)):
        if not _one_step(machine, manner, traction, motion, step, q, v, sides, spare, record):
            return step
    return len(motion.theta)


@compiled
def _one_step(machine, manner, traction, motion, step, q, v, sides, spare, record):
    """Integrate one step, and keep its sample.

    Arguments are those of `run`, the number of the step, and work arrays.

    Returns:
        False if a rate reached `RUNAWAY` or became NaN; the coordinates are then not moved.
    """
    legs, balance, three, loads, static, forces, spin, _ = spare
    record.state[step] = q
    tilt = _find_contacts(machine, manner, motion, step, q, v, sides, spare)
    contact_axes(q[5], tilt, balance.axes)
    find_slip(machine, manner, traction, legs, three, q, v, balance)
    gyroscopic(machine.inertia, v, spin)
    total = demands(machine, manner, legs, sides, q, v, spin, balance)
    weight = machine.mass * GRAVITY
    static_loads(balance.arms, weight, static)
    static_loads(balance.arms, total, loads)
    normal_forces(balance, traction, total, weight, loads)
    record.rates[step] = v
    keep_legs(record, step, legs)
    accelerate(machine, manner, traction, balance, loads, spin, v, forces)
    if not np.abs(v).max() < RUNAWAY:
        return False
    record.acceleration[step] = (v - record.rates[step]) / manner.dt
    keep_contacts(record, step, three, balance, static, loads, forces)
    for a in range(6):
        q[a] += manner.dt * v[a]
    return True


@compiled
def _find_contacts(machine, manner, motion, step, q, v, sides, spare):
    """Find the legs on the ground, and set what a change of contacts sets; return the tilt X.

    Arguments are those of `run`, the number of the step, and work arrays, of which the legs and the
    three that carry load are filled.
    """
    legs = spare.legs
    tilt = place_legs(
        machine, q, v, motion.theta[step], motion.speed[step], motion.stance_speed[step],
        spare.centre_before, legs,
    )  # fmt: skip
    spare.centre_before[:] = q[:3]
    if manner.by_text:
        changed = switch_by_table(legs.height, sides)
    else:
        changed = switch_by_listing(legs.height, sides, manner.inner)
    three_legs(sides, legs, q, spare.three)
    if changed or step == 0:
        reset(machine, manner, legs, sides, q, v)
    return tilt
