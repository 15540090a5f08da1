# SPDX-License-Identifier: MIT
"""What happens before each of MuJoCo's steps: contacts are placed, friction applied; compiled."""

# The group `bench` need not be installed:
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

import ctypes
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import mujoco
import numba
import numpy as np

from benchmarks.accuracy.rigid_engine.arcs import (
    N_CORNERS,
    N_SLOTS,
    PER_LEG,
    find_places,
    turn_into,
)
from model.arrays import Array
from model.robot import N_LEGS

PARKED = -100.0  # m; height of planes whose bead is not near the ground


class Friction(NamedTuple):
    """Coulomb friction, smooth about rest, F = mu N v / sqrt(v^2 + v0^2).

    Attributes:
        mu: Friction coefficient [-].
        v0: Slip velocity at which friction is 71 % of the full one [m/s].
    """

    mu: float
    v0: float


class Views(NamedTuple):
    """MuJoCo's own arrays, which are read and overwritten in place.

    Attributes:
        qpos: Place, quaternion and leg angles, shape (13,).
        qvel: Velocity, angular velocity in the body's frame, leg speeds, shape (12,).
        geom_pos: Places of the geoms in their bodies, shape (40, 3) [m].
        geom_quat: Their orientations, shape (40, 4).
        wrench: Force [N] and torque [N m] on the body, shape (6,).
        loads: Normal forces of the last step, shape (20,) [N].
    """

    qpos: Array
    qvel: Array
    geom_pos: Array
    geom_quat: Array
    wrench: Array
    loads: Array


@numba.njit(cache=True)
def prepare(views, theta, speed, shape, heights, friction, bead, places, scratch):
    """Set the legs, place the contacts and apply friction, before a step.

    Args:
        views: Arrays of MuJoCo.
        theta: Leg angles, shape (6,) [rad].
        speed: Leg speeds until the step's end, shape (6,) [rad/s].
        shape: What of the robot touches the ground.
        heights: The ground.
        friction: The law; it takes the normal forces of the step before.
        bead: Radius of the beads [m].
        places: Overwritten by where contacts may be.
        scratch: Overwritten.
    """
    views.qpos[7:] = theta
    views.qvel[6:] = speed
    p, rotation = views.qpos[:3], rotation_of(views.qpos[3:7])
    find_places(p, rotation, theta, shape, heights, places, scratch)
    views.wrench[:] = 0.0
    spin, hip = np.empty(3), np.empty(3)
    turn_into(rotation, views.qvel[3:6], spin)
    for slot in range(N_SLOTS):
        if not places.near[slot]:
            views.geom_pos[slot, 2] = PARKED
            continue
        leg = (slot - N_CORNERS) // PER_LEG
        _place(slot, leg, theta, rotation, bead, places, views)
        if views.loads[slot] > 0:
            arm = places.point[slot] - p
            v = views.qvel[:3] + cross(spin, arm)
            if leg >= 0:
                turn_into(rotation, shape.hips[leg], hip)
                v = v + speed[leg] * cross(rotation[:, 1], arm - hip)
            force = _friction(friction, v, places.normal[slot], views.loads[slot])
            views.wrench[:3] += force
            views.wrench[3:] += cross(arm, force)


@numba.njit(cache=True)
def cross(a, b):
    """Return the cross product of two vectors, shape (3,)."""
    return np.array([
        a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
    ])  # fmt: skip


@numba.njit(cache=True)
def rotation_of(q):
    """Return the rotation of a quaternion (w, x, y, z), body to world, shape (3, 3)."""
    w, x, y, z = q / np.sqrt(q @ q)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


@numba.njit(cache=True)
def _place(slot, leg, theta, rotation, bead, places, views):
    """Move a contact's plane to the ground and its bead to the point, with its surface there."""
    normal = places.normal[slot]
    views.geom_pos[slot] = places.ground[slot]
    # The plane's z axis is turned from the vertical to the normal by the shortest way.
    q = np.array([1.0 + normal[2], -normal[1], normal[0], 0.0])
    views.geom_quat[slot] = q / np.sqrt(q @ q)
    inward = np.empty(3)
    turn_into(rotation.T, bead * normal, inward)
    at = views.geom_pos[N_SLOTS + slot]
    at[:] = places.local[slot]
    if leg < 0:
        at += inward
        return
    c, s = np.cos(theta[leg]), np.sin(theta[leg])
    at[0] += c * inward[0] - s * inward[2]
    at[1] += inward[1]
    at[2] += s * inward[0] + c * inward[2]


@numba.njit(cache=True)
def _friction(friction, v, normal, load):
    """Return the friction force on a contact, against its sliding velocity, shape (3,) [N]."""
    slip = v - (v @ normal) * normal
    return -friction.mu * load / np.sqrt(slip @ slip + friction.v0**2) * slip


@cache
def stepper() -> Callable[..., None]:
    """Compile many steps in one call, MuJoCo's among them.

    Calls from Python cost as much as a step. The compiled function takes the addresses of MuJoCo's
    model and data, leg angles at each step's start and speeds in it, both of shape (n, 6), the sums
    of normal forces to add to, shape (20,), then the arguments of `prepare` but its second and
    third.
    """
    library = next(Path(str(mujoco.__file__)).parent.glob("libmujoco.*"))
    mj_step = ctypes.CDLL(str(library)).mj_step
    mj_step.argtypes, mj_step.restype = (ctypes.c_size_t, ctypes.c_size_t), None

    @numba.njit
    def steps(model, data, theta, speed, carried, views, shape, heights, friction, bead, places,
              scratch):  # fmt: skip
        """Prepare forces and step, once for each row of leg angles; sum up the loads."""
        for k in range(len(theta)):
            prepare(views, theta[k], speed[k], shape, heights, friction, bead, places, scratch)
            mj_step(model, data)
            carried += views.loads

    return steps


@numba.njit(cache=True)
def leg_loads(loads):
    """Return the normal force on each leg, shape (6,) [N]."""
    out = np.zeros(N_LEGS)
    for leg in range(N_LEGS):
        for k in range(PER_LEG):
            out[leg] += max(loads[N_CORNERS + leg * PER_LEG + k], 0.0)
    return out
