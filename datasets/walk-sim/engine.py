# SPDX-License-Identifier: MIT
"""Walk a six-legged robot in MuJoCo, with friction written out; shares nothing with `model`.

A rigid body on six weightless half-circle legs, turned by stiff servos. Each leg has one contact,
at its exact lowest point: a ball too small to matter is moved there at each step. Normal forces are
the engine's, from frictionless contacts. Friction is explicit and Coulomb's, regularised:

    F = -friction · N · v / √(v² + v₀²)

with v the horizontal velocity of the leg's material at the contact. The engine's own friction is
not used: sliding contacts chatter on its cone.

Frames, leg numbers and signs: docs/conventions.md.
"""

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np

HIPS = np.column_stack([(0.097, 0.097, 0.0, 0.0, -0.097, -0.097), (0.1156, -0.1156) * 3, [0.0] * 6])
LEG_RADIUS = 0.035  # m
BODY_SIZE = (0.194, 0.2512, 0.069)  # length, width, height of a uniform cuboid [m]
MASS = 2.17  # kg
GRAVITY = 9.81  # m/s2

_BALL = 1e-3  # radius of the ball at each contact [m]
_ARMATURE = 2e-3  # of each leg: keeps explicit friction stable at the time step [kg m2]
_STIFFNESS = 1000.0  # of each servo: the load bends it by 0.03 degrees [N m/rad]
_DAMPING = 2.0 * np.sqrt(_STIFFNESS * _ARMATURE)  # critical [N m s/rad]
_LEG_MASS = 1e-3  # kg


@dataclass(frozen=True)
class Walk:
    """A walk, sampled evenly.

    Attributes:
        t: Times, shape (n,) [s].
        position: Of the body's centre, shape (n, 3) [m].
        roll_pitch_yaw: Orientation, shape (n, 3) [rad].
        yaw_rate: Rate of turn about the vertical, shape (n,) [rad/s].
        theta: Leg angles, shape (n, 6) [rad].
        normal_force: Of the ground on each leg, the mean since the sample before, shape (n, 6) [N].
    """

    t: np.ndarray
    position: np.ndarray
    roll_pitch_yaw: np.ndarray
    yaw_rate: np.ndarray
    theta: np.ndarray
    normal_force: np.ndarray


def tripod_gait(
    steering: float, *, cycle_time: float, touchdown: float = np.radians(50.0)
) -> Callable[[float], tuple[np.ndarray, np.ndarray]]:
    """Build a tripod gait that turns left: right legs sweep more in the same time.

    Touchdown and lift-off have the hip at the same height, r(1 + sin TD) = 2r sin LO, on each side;
    half a cycle is stance.

    Args:
        steering: Ratio of the sweeps of right and left legs [-].
        cycle_time: Time of a cycle [s].
        touchdown: Of the left legs [rad].

    Returns:
        The gait: from a time [s] to angles [rad] and rates [rad/s], both shape (6,).
    """
    inner = _lift_off(touchdown) - touchdown
    outer_touchdown = _touchdown_of_sweep(steering * inner)
    down = np.array([touchdown, outer_touchdown] * 3)
    sweep = np.array([inner, steering * inner] * 3)
    phase = np.array([0.0, 0.5, 0.5, 0.0, 0.0, 0.5])

    def at(t: float) -> tuple[np.ndarray, np.ndarray]:
        turns, within = np.divmod(t / cycle_time + phase, 1.0)
        stance = np.minimum(within, 0.5) / 0.5
        flight = np.maximum(within - 0.5, 0.0) / 0.5
        angle = down + 2 * np.pi * turns + sweep * stance + (2 * np.pi - sweep) * flight
        rate = np.where(within < 0.5, sweep, 2 * np.pi - sweep) / (0.5 * cycle_time)
        return angle, rate

    return at


def _lift_off(touchdown: float) -> float:
    return np.pi - np.arcsin((1 + np.sin(touchdown)) / 2)


def _touchdown_of_sweep(sweep: float) -> float:
    low, high = 0.0, np.pi / 2  # the sweep falls from 150 degrees to none over these
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _lift_off(middle) - middle > sweep else (low, middle)
    return (low + high) / 2


def simulate(
    gait: Callable[[float], tuple[np.ndarray, np.ndarray]],
    *,
    duration: float,
    friction: float,
    regularisation_speed: float = 1e-3,
    time_step: float = 6.25e-5,
    sample_time: float = 0.01,
    settling_time: float = 0.3,
) -> Walk:
    """Simulate a walk that starts at the origin and heads along x.

    Args:
        gait: From a time [s] to the legs' angles [rad] and rates [rad/s], both shape (6,).
        duration: Length of the walk [s].
        friction: Of every leg [-].
        regularisation_speed: v0 [m/s].
        time_step: Of the engine [s].
        sample_time: Between samples; a multiple of the time step [s].
        settling_time: For which the robot stands before time 0, on its first leg angles [s].
    """
    model = mujoco.MjModel.from_xml_string(_world(time_step))
    data = mujoco.MjData(model)
    data.qpos[2] = LEG_RADIUS * (1 + np.sin(gait(0.0)[0].min())) + 5e-4
    data.qpos[7:] = gait(0.0)[0]
    bodies = np.array([model.body(f"leg{leg}").id for leg in range(1, 7)])
    every = round(sample_time / time_step)
    rows, normal, pressed = [], np.zeros(6), np.zeros(6)
    for step in range(-round(settling_time / time_step), round(duration / time_step) + 1):
        theta_set, rate_set = gait(step * time_step) if step >= 0 else (gait(0.0)[0], 0.0)
        if step == 0:
            data.qpos[:2] = 0.0
        point_body, slip = _contact(data)
        _apply_friction(data, bodies, point_body, slip, normal, friction, regularisation_speed)
        data.ctrl[:] = _STIFFNESS * (theta_set - data.qpos[7:]) + _DAMPING * (
            rate_set - data.qvel[6:]
        )
        model.geom_pos[1:] = _ball_places(data)
        pressed += normal / every
        if step >= 0 and step % every == 0:
            rows.append(_sample(step * time_step, data, pressed))
            pressed[:] = 0.0
        mujoco.mj_step(model, data)
        normal = _normal_forces(data)
    columns = np.array(rows)
    angles = np.unwrap(columns[:, 4:7], axis=0)
    return Walk(columns[:, 0], columns[:, 1:4], angles, columns[:, 7], columns[:, 8:14],
                columns[:, 14:])  # fmt: skip


def turning_radius(walk: Walk, *, cycle_time: float, start: float) -> float:
    """Compute the radius of the circle through whole strides after `start` [m].

    The stride's displacement and turn are those of a rotation about a fixed point:
    radius = |d| / (2 sin(turn/2)), which is free of the wobble within a stride.
    """
    rows = round(cycle_time / (walk.t[1] - walk.t[0]))
    first = int(np.searchsorted(walk.t, start - 1e-9))
    places, yaw = walk.position[first::rows, :2], walk.roll_pitch_yaw[first::rows, 2]
    chord = np.linalg.norm(np.diff(places, axis=0), axis=1)
    return float(np.mean(chord / (2 * np.sin(np.diff(yaw) / 2))))


def _world(time_step: float) -> str:
    mass = MASS - 6 * _LEG_MASS
    l, w, h = BODY_SIZE  # noqa: E741 length, width and height as in the cuboid's formula
    inertia = MASS / 12 * np.array([w**2 + h**2, l**2 + h**2, w**2 + l**2])
    # the balls start off their bodies' origins, or the engine would take them to stay there
    legs = "".join(
        f'<body name="leg{i}" pos="{x} {y} {z}"><inertial pos="0 0 0" mass="{_LEG_MASS}" '
        f'diaginertia="1e-7 1e-7 1e-7"/><joint name="hip{i}" axis="0 1 0" armature="{_ARMATURE}"/>'
        f'<geom type="sphere" size="{_BALL}" pos="{LEG_RADIUS} 0 {-LEG_RADIUS}" contype="2" '
        f'conaffinity="1"/></body>'
        for i, (x, y, z) in enumerate(HIPS, start=1)
    )
    servos = "".join(f'<motor joint="hip{i}"/>' for i in range(1, 7))
    return f"""
    <mujoco>
      <option timestep="{time_step}" gravity="0 0 {-GRAVITY}" integrator="Euler"/>
      <default><geom condim="1" solref="0.004 1"/></default>
      <worldbody>
        <geom type="plane" size="0 0 1" contype="1" conaffinity="2"/>
        <body name="robot"><freejoint/>
          <inertial pos="0 0 0" mass="{mass}"
            diaginertia="{inertia[0]} {inertia[1]} {inertia[2]}"/>
          {legs}
        </body>
      </worldbody>
      <actuator>{servos}</actuator>
    </mujoco>"""


def _rotation(quaternion: np.ndarray) -> np.ndarray:
    w, x, y, z = quaternion
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def _lowest(up_x: np.ndarray, up_z: np.ndarray) -> np.ndarray:
    """Find the lowest point of each arc in its hip frame, shape (6, 2) for x and z [m].

    Args:
        up_x: Vertical component of the hip frame's x axis, shape (6,).
        up_z: That of its z axis, shape (6,).
    """
    length = np.hypot(up_x, up_z)
    rolls = up_z >= 0  # down points to the side the arc is on
    rolling_x = LEG_RADIUS * (1 - up_x / length)
    end_x = np.where(up_x < 0, 2 * LEG_RADIUS, 0.0)  # toe, or hip
    return np.column_stack(
        [np.where(rolls, rolling_x, end_x), np.where(rolls, -LEG_RADIUS * up_z / length, 0.0)]
    )


def _leg_geometry(data: mujoco.MjData) -> tuple[np.ndarray, ...]:
    rotation = _rotation(data.qpos[3:7])
    cos, sin = np.cos(data.qpos[7:]), np.sin(data.qpos[7:])
    up = rotation[2]
    up_x, up_z = cos * up[0] - sin * up[2], sin * up[0] + cos * up[2]
    return rotation, cos, sin, up_x, up_z, _lowest(up_x, up_z)


def _ball_places(data: mujoco.MjData) -> np.ndarray:
    """Place each ball in its leg's frame so that its lowest point is the arc's, shape (6, 3)."""
    rotation, _, _, up_x, up_z, low = _leg_geometry(data)
    return np.column_stack(
        [low[:, 0] + _BALL * up_x, np.full(6, _BALL * rotation[2, 1]), low[:, 1] + _BALL * up_z]
    )


def _contact(data: mujoco.MjData) -> tuple[np.ndarray, np.ndarray]:
    """Compute each leg's lever from its hip [m] and material velocity [m/s], inertial, (6, 3)."""
    rotation, cos, sin, _, _, low = _leg_geometry(data)
    lever = np.zeros((6, 3))
    lever[:, 0] = cos * low[:, 0] + sin * low[:, 1]
    lever[:, 2] = -sin * low[:, 0] + cos * low[:, 1]
    point, rate = HIPS + lever, data.qvel[6:]
    wx, wy, wz = data.qvel[3:6]
    velocity = np.column_stack([
        wy * point[:, 2] - wz * point[:, 1] + rate * lever[:, 2],
        wz * point[:, 0] - wx * point[:, 2],
        wx * point[:, 1] - wy * point[:, 0] - rate * lever[:, 0],
    ])  # fmt: skip
    return lever @ rotation.T, velocity @ rotation.T + data.qvel[:3]


def _apply_friction(
    data: mujoco.MjData, bodies: np.ndarray, lever: np.ndarray, slip: np.ndarray,
    normal: np.ndarray, friction: float, v0: float,
) -> None:  # fmt: skip
    speed = np.sqrt(slip[:, 0] ** 2 + slip[:, 1] ** 2 + v0**2)
    fx, fy = -friction * normal / speed * slip[:, :2].T
    x, y, z = lever.T
    wrench = np.column_stack([fx, fy, np.zeros(6), -z * fy, z * fx, x * fy - y * fx])
    data.xfrc_applied[bodies] = wrench


def _normal_forces(data: mujoco.MjData) -> np.ndarray:
    forces = np.zeros(6)
    contacts = data.contact
    if data.ncon:
        balls = contacts.geom.max(axis=1) - 1  # geom 0 is the ground
        rows = contacts.efc_address
        held = rows >= 0
        forces[balls[held]] = data.efc_force[rows[held]]
    return forces


def _sample(t: float, data: mujoco.MjData, normal: np.ndarray) -> np.ndarray:
    R = _rotation(data.qpos[3:7])
    angles = np.arctan2(R[2, 1], R[2, 2]), -np.arcsin(R[2, 0]), np.arctan2(R[1, 0], R[0, 0])
    yaw_rate = float(R[2] @ data.qvel[3:6])
    return np.concatenate([[t], data.qpos[:3], angles, [yaw_rate], data.qpos[7:], normal])
