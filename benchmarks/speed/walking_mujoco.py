# SPDX-License-Identifier: MIT
"""The same walk in MuJoCo, for `walking.py`: its fastest honest set-up, found by a study.

A free box with the robot's mass and inertia and six hinges whose motion is prescribed: a rotor
inertia that no contact can move, driven by the reference's accelerations, costs nothing and holds
the angles to 0.01 degrees, where position servos lag and make the contact solver take the legs for
soft. Contact and friction are the engine's own, steps run in C (`mujoco.rollout`), and what the
model does not need is switched off. Three shapes of leg, two friction cones and two solvers are
tried, and for spheres fewer of them and softer contacts; each takes the largest step whose radius
is within a percent of its own converged one.
"""
# The group `bench` need not be installed:
# pyright: reportMissingImports=false

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product
from typing import Literal

import mujoco
import numpy as np
from mujoco import rollout

from model.arrays import Array
from model.gait import LegReference
from model.robot import GRAVITY, N_LEGS, Robot
from model.walk.dynamics import DEFAULT_OPTIONS, start_state
from model.walk.path import turning_radius
from model.walk.quaternion import roll_pitch_yaw

Shape = Literal["spheres", "capsules", "half disc"]

ROTOR = 1e5  # kg m2; hinges only, so the body does not feel it
SOLVER_TOLERANCE = 1e-11  # MuJoCo scales it by the mean inertia, here the rotors'
CONTACT_TIMES = (0.01, 0.02)  # s, solref: legs sink a millimetre, and four; MuJoCo's default
EDGE = 1e-4  # m, radius of spheres and capsules: a sharp toe
ARC_USED = np.radians(70.0)  # of the arc from the toe: the rest never meets flat ground
VERTICES = (16, 8)  # over it; the lowest point is up to 0.03 and 0.13 mm off the arc's
DISC_VERTICES = 64  # of a half disc, whose hull is the arc's
STEPS = (
    0.0005,
    0.001,
    0.002,
    0.004,
    0.005,
    0.008,
    0.01,
    0.0125,
    0.016,
    0.02,
)  # s; each divides the cycle
ALLOWED = 0.01  # of the radius at the smallest step
STUDY_CYCLES = 7  # the radius is taken from the end of the first one on
OFF = ("clampctrl", "damper", "equality", "frictionloss", "island", "limit", "sensor", "spring")


@dataclass(frozen=True)
class Setup:
    """One way to set MuJoCo up.

    Attributes:
        shape: What a leg is made of.
        cone: Friction cone.
        solver: Constraint solver.
        vertices: How many points of the arc spheres or capsules stand on.
        contact_time: Time constant of a contact [s].
        dt: Step [s].
    """

    shape: Shape = "spheres"
    cone: str = "elliptic"
    solver: str = "Newton"
    vertices: int = VERTICES[0]
    contact_time: float = CONTACT_TIMES[0]
    dt: float = STEPS[0]


@dataclass(frozen=True)
class Run:
    """What a rollout gave.

    Attributes:
        setup: How it was computed.
        radius: Turning radius [m].
        angle_error: Largest departure from the leg angles asked for [rad].
        wall: Simulated seconds per wall second, median over repeats.
        processor: The same per second of processor time.
    """

    setup: Setup
    radius: float
    angle_error: float
    wall: float
    processor: float


def leg_geoms(robot: Robot, setup: Setup) -> str:
    """Write a leg's geoms in its own frame: x from the hip to the toe, the arc at negative z."""
    r = robot.leg_radius
    phi = np.linspace(0.0, ARC_USED, setup.vertices)
    arc = np.column_stack([np.cos(phi), np.zeros_like(phi), -np.sin(phi)])
    points = [" ".join(f"{x:.9g}" for x in row) for row in np.array([r, 0, 0]) + (r - EDGE) * arc]
    if setup.shape == "spheres":
        return "".join(f'<geom type="sphere" size="{EDGE}" pos="{point}"/>' for point in points)
    if setup.shape == "capsules":
        return "".join(
            f'<geom type="capsule" size="{EDGE}" fromto="{a} {b}"/>' for a, b in pairwise(points)
        )
    return '<geom type="mesh" mesh="half disc"/>'


def half_disc(robot: Robot) -> str:
    """Write the half disc that an arc is the edge of, as the mesh of a leg."""
    r = robot.leg_radius
    corners = [
        f"{r * (1 + np.cos(phi)):.9g} {y} {-r * np.sin(phi):.9g}"
        for phi in np.linspace(0.0, np.pi, DISC_VERTICES)
        for y in (-EDGE, EDGE)
    ]
    return f'<mesh name="half disc" vertex="{" ".join(corners)}" inertia="shell"/>'


def mjcf(robot: Robot, friction: float, setup: Setup) -> str:
    """Write the robot on flat ground as MJCF; the legs' own mass is next to nothing."""
    geoms = leg_geoms(robot, setup)
    legs = "".join(
        f'<body pos="{x} {y} {z}"><inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>'
        f'<joint name="{i}" axis="0 1 0" armature="{ROTOR}"/>{geoms}</body>'
        for i, (x, y, z) in enumerate(robot.hips)
    )
    motors = "".join(f'<motor joint="{i}" gear="{ROTOR}"/>' for i in range(N_LEGS))
    inertia = " ".join(str(x) for x in robot.principal_inertia)
    mesh = f"<asset>{half_disc(robot)}</asset>" if setup.shape == "half disc" else ""
    off = " ".join(f'{name}="disable"' for name in OFF)
    return f"""<mujoco>
    <compiler angle="radian" inertiafromgeom="false"/>
    <option timestep="{setup.dt}" integrator="Euler" cone="{setup.cone}" solver="{setup.solver}"
      tolerance="{SOLVER_TOLERANCE}" gravity="0 0 -{GRAVITY}"><flag {off}/></option>
    <default><geom contype="1" conaffinity="0" condim="3" friction="{friction} 0 0"
      solref="{setup.contact_time} 1"/></default>{mesh}
    <worldbody><geom type="plane" size="0 0 1" contype="0" conaffinity="1"/>
    <body><freejoint/><inertial pos="0 0 0" mass="{robot.mass}" diaginertia="{inertia}"/>
    {legs}</body></worldbody><actuator>{motors}</actuator></mujoco>"""


def run(
    robot: Robot,
    reference: LegReference,
    friction: float,
    setup: Setup,
    *,
    duration: float,
    repeats: int = 1,
) -> Run:
    """Walk in MuJoCo; only the rollout is timed, not the making of model and controls."""
    engine = mujoco.MjModel.from_xml_string(mjcf(robot, friction, setup))
    n = round(duration / setup.dt)
    theta = reference.angles(setup.dt * np.arange(n + 1))
    speed = np.diff(theta, axis=0) / setup.dt
    acceleration = np.diff(speed, axis=0, prepend=speed[:1]) / setup.dt
    start, data = _start(engine, robot, theta[0], speed[0])
    wall, processor, states = [], [], np.empty(0)
    for _ in range(repeats):
        began, used = time.perf_counter(), time.process_time()
        states, _ = rollout.rollout(engine, [data], start[None], acceleration[None])
        wall.append(time.perf_counter() - began)
        processor.append(time.process_time() - used)
    q = np.vstack([start, states[0]])[:, 1 : 1 + engine.nq]  # the state begins with time
    return Run(
        setup,
        _radius(q, round(float(reference.period or duration) / setup.dt)),
        float(np.abs(q[:, 7:] - theta).max()),
        duration / float(np.median(wall)),
        duration / float(np.median(processor)),
    )


def _start(
    engine: mujoco.MjModel, robot: Robot, theta: Array, speed: Array
) -> tuple[Array, mujoco.MjData]:
    """Stand the robot as our own walk starts, its legs already at speed."""
    data = mujoco.MjData(engine)
    state = start_state(robot, theta, DEFAULT_OPTIONS)
    data.qpos[:] = np.concatenate([state.p, state.q, theta])
    data.qvel[6:] = speed
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start = np.empty(mujoco.mj_stateSize(engine, kind))
    mujoco.mj_getState(engine, data, start, kind)
    return start, data


def _radius(q: Array, cycle: int) -> float:
    """Compute the turning radius over whole cycles, the first one left out [m]."""
    ends = [cycle, (len(q) - 1) // cycle * cycle]
    return turning_radius(q[ends, :2], roll_pitch_yaw(q[:, 3:7])[ends, 2])


def step_study(
    robot: Robot, reference: LegReference, friction: float, setup: Setup
) -> Sequence[Run]:
    """Walk at every step, the smallest first."""
    duration = STUDY_CYCLES * float(reference.period or 2.0)
    return [
        run(robot, reference, friction, replace(setup, dt=dt), duration=duration) for dt in STEPS
    ]


def describe(setup: Setup) -> str:
    """Name a set-up, without its step."""
    points = "" if setup.shape == "half disc" else f"{setup.vertices} "
    if setup.shape == "capsules":
        points = f"{setup.vertices - 1} "
    return (
        f"{points}{setup.shape}, {setup.cone} cone, {setup.solver}, contacts of "
        f"{1000 * setup.contact_time:g} ms"
    )


def departure(study: Sequence[Run], one: Run) -> float:
    """Compute how far a radius is from that of the smallest step, as a share of it."""
    return one.radius / study[0].radius - 1


def largest_step(study: Sequence[Run]) -> Run:
    """Choose the largest step up to which every radius is within `ALLOWED` of the converged."""
    best = study[0]
    for one in study[1:]:
        if not abs(departure(study, one)) <= ALLOWED:
            break
        best = one
    return best


def all_studies(robot: Robot, reference: LegReference, friction: float) -> list[Sequence[Run]]:
    """Study every set-up worth trying, the fastest first."""
    solvers = ("Newton", "CG")
    setups = [
        Setup(*each)
        for each in product(
            ("spheres", "capsules", "half disc"), ("elliptic", "pyramidal"), solvers
        )
    ]
    setups += [
        Setup("spheres", "elliptic", *each) for each in product(solvers, VERTICES, CONTACT_TIMES)
    ]
    studies = [step_study(robot, reference, friction, setup) for setup in dict.fromkeys(setups)]
    # By processor time, which other programs on the machine disturb least.
    return sorted(studies, key=lambda study: -largest_step(study).processor)
