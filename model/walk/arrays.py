# SPDX-License-Identifier: MIT
"""Arrays of the compiled loop of the walk."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled, inlined
from model.robot import N_LEGS, Robot

N_CONTACTS = N_LEGS + 8  # legs, then the corners of the body


class Body(NamedTuple):
    """A robot as arrays for compiled code; see `Robot`.

    Attributes:
        hips: Hip positions in the body frame, shape (6, 3) [m].
        leg_radius: Radius of the legs' arcs [m].
        toe_cos: Cosine of the arcs' angle beyond a half circle [-].
        toe_sin: Sine of the arcs' angle beyond a half circle [-].
        mass: Mass [kg].
        inertia: Principal moments of inertia, shape (3,) [kg m2].
        half_size: Half the body's length, width and height, shape (3,) [m].
    """

    hips: Array
    leg_radius: float
    toe_cos: float
    toe_sin: float
    mass: float
    inertia: Array
    half_size: Array


class Contacts(NamedTuple):
    """Stiffness and damping of every contact along the ground's normal.

    Attributes:
        stiffness: Normal force for each metre of sinkage [N/m].
        damping: Normal force for each metre a second of sinking [N s/m].
    """

    stiffness: float
    damping: float


class State(NamedTuple):
    """Position, orientation and velocities of the body; each step overwrites them.

    Attributes:
        p: Position of the body's centre in the world frame, shape (3,) [m].
        q: Orientation as a unit quaternion (w, x, y, z), body to world, shape (4,).
        v: Velocity of the body's centre in the world frame, shape (3,) [m/s].
        w: Angular velocity in the world frame, shape (3,) [rad/s].
    """

    p: Array
    q: Array
    v: Array
    w: Array


class Work(NamedTuple):
    """Work arrays of a step, one row a contact: six legs, then eight corners of the body.

    Attributes:
        place: Contact from the body's centre, world frame, shape (14, 3) [m].
        velocity: Velocity of the contact's material point relative to the body, world frame,
            shape (14, 3) [m/s].
        normal: Normal of the ground, shape (14, 3) [-].
        gap: Distance over the ground, negative below it, shape (14,) [m].
        across: Direction along the ground and across the leg's rolling direction, filled where
            traction differs by direction, shape (14, 3) [-].
        lateral: By how much traction differs by direction, see `model.walk.anisotropy`; zero where
            it does not, shape (14, 2) [-].
        flow: Radius of the arc where a leg rolls, else zero, shape (14,) [m].
        kind: HIP, ROLLING or TOE; TOE for corners, shape (14,).
        load: Normal force, zero in the air, shape (14,) [N].
        secant: Traction over slip velocity, zero in the air, shape (14,) [N s/m].
        R: Rotation of the body, body to world, shape (3, 3).
        A: Matrix of the step's linear system, lower half, shape (6, 6).
        b: Right side of the system, then its solution: final v [m/s] and w [rad/s], shape (6,).
        v: Guess of the final velocity, shape (3,) [m/s].
        w: Guess of the final angular velocity, shape (3,) [rad/s].
        force: Force on one contact at zero velocity of the body, shape (3,) [N].
        point: Velocity of one material contact point, shape (3,) [m/s].
        inertia: Inertia in the world frame, shape (3, 3) [kg m2].
        gyro: Gyroscopic moment, shape (3,) [N m].
        gain: Change of v and w over the step before, by its length, shape (6,) [m/s2, rad/s2].
    """

    place: Array
    velocity: Array
    normal: Array
    gap: Array
    across: Array
    lateral: Array
    flow: Array
    kind: NDArray[np.int64]
    load: Array
    secant: Array
    R: Array
    A: Array
    b: Array
    v: Array
    w: Array
    force: Array
    point: Array
    inertia: Array
    gyro: Array
    gain: Array


def body_arrays(robot: Robot) -> Body:
    """Convert a robot's geometry, mass and inertia to the arrays of the compiled loop."""
    return Body(
        robot.hips, robot.leg_radius, float(np.cos(robot.toe_beyond)),
        float(np.sin(robot.toe_beyond)), robot.mass,
        robot.principal_inertia, 0.5 * np.array(robot.body_size),
    )  # fmt: skip


@compiled
def new_work():
    """Allocate the work arrays of a step; loads, secants, kinds and gains are zero."""
    n = N_CONTACTS
    return Work(
        np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3)), np.empty(n), np.zeros((n, 3)),
        np.zeros((n, 2)), np.empty(n), np.zeros(n, dtype=np.int64), np.zeros(n), np.zeros(n),
        np.empty((3, 3)), np.empty((6, 6)), np.empty(6), np.empty(3), np.empty(3), np.empty(3),
        np.empty(3), np.empty((3, 3)), np.empty(3), np.zeros(6),
    )  # fmt: skip


@compiled
def new_state():
    """Allocate a state whose arrays are uninitialised."""
    return State(np.empty(3), np.empty(4), np.empty(3), np.empty(3))


@inlined
def copy_state(state, to):
    """Copy the values of a state's arrays into the arrays of another state.

    Args:
        state: State to copy.
        to: State whose arrays are overwritten.
    """
    for i in range(3):
        to.p[i], to.v[i], to.w[i] = state.p[i], state.v[i], state.w[i]
    for i in range(4):
        to.q[i] = state.q[i]
