# SPDX-License-Identifier: MIT
"""The robot in MuJoCo: a free body, six prescribed hinges, frictionless contacts that are placed.

A contact is a bead on a leg, or on a corner of the body, and a plane of its own in the world. Both
are moved every step to where `arcs` finds leg and ground nearest, so that MuJoCo's normal force
acts there; its own friction is off.
"""
# The group `bench` need not be installed:
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

import mujoco
import numpy as np

from benchmarks.accuracy.rigid_engine.arcs import N_CORNERS, N_SLOTS, PER_LEG
from model.robot import GRAVITY, N_LEGS, Robot

ROTOR = 1e3  # kg m2 of a hinge: contacts do not move it, and its angle is set anew every step
BEAD = 1e-3  # m
CONTACT_TIME = 0.002  # s, MuJoCo's solref: legs sink some micrometres


def compiled(robot: Robot, *, dt: float, contact_time: float = CONTACT_TIME) -> mujoco.MjModel:
    """Compile the robot; geoms are the contacts' planes, then their beads, in the same order."""
    engine = mujoco.MjModel.from_xml_string(mjcf(robot, dt=dt, contact_time=contact_time))
    engine.geom_sameframe[:] = 0  # the beads' places are to be read every step
    engine.geom_pos[:N_SLOTS, 2] = -100.0
    return engine


def mjcf(robot: Robot, *, dt: float, contact_time: float) -> str:
    """Write the robot as MJCF."""
    planes = "".join(f'<geom name="p{k}" type="plane" size="0 0 1"/>' for k in range(N_SLOTS))
    corners = "".join(_bead(k) for k in range(N_CORNERS))
    legs = "".join(_leg(robot, leg) for leg in range(N_LEGS))
    pairs = "".join(f'<pair geom1="p{k}" geom2="b{k}" condim="1"/>' for k in range(N_SLOTS))
    sensors = "".join(
        f'<contact geom1="p{k}" geom2="b{k}" data="force" num="1"/>' for k in range(N_SLOTS)
    )
    inertia = " ".join(str(x) for x in robot.principal_inertia)
    return f"""<mujoco>
    <compiler angle="radian" inertiafromgeom="false"/>
    <option timestep="{dt}" integrator="Euler" solver="Newton" tolerance="1e-12"
      gravity="0 0 -{GRAVITY}"><flag eulerdamp="disable" island="disable"/></option>
    <default><geom contype="0" conaffinity="0"/><pair solref="{contact_time} 1"/></default>
    <worldbody>{planes}
    <body><freejoint/><inertial pos="0 0 0" mass="{robot.mass}" diaginertia="{inertia}"/>
    {corners}{legs}</body></worldbody>
    <contact>{pairs}</contact><sensor>{sensors}</sensor></mujoco>"""


def _leg(robot: Robot, leg: int) -> str:
    """Write a leg of next to no mass and the beads on it."""
    place = " ".join(str(x) for x in robot.hips[leg])
    beads = "".join(_bead(N_CORNERS + leg * PER_LEG + k) for k in range(PER_LEG))
    return (
        f'<body pos="{place}"><inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
        f'<joint axis="0 1 0" armature="{ROTOR}"/>{beads}</body>'
    )


def _bead(slot: int) -> str:
    return f'<geom name="b{slot}" type="sphere" size="{BEAD}" pos="0 0 {1e-4 * slot}"/>'


def loads(data: mujoco.MjData) -> np.ndarray:
    """Return the view of the contacts' normal forces in the order of slots, shape (20,) [N]."""
    return data.sensordata.reshape(N_SLOTS, 3)[:, 0]
