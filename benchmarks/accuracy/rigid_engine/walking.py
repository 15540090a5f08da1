# SPDX-License-Identifier: MIT
"""Walks of the engine: a robot whose leg angles follow a log, on a map of heights."""
# The group `bench` need not be installed:
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

from dataclasses import dataclass

import mujoco
import numpy as np

from benchmarks.accuracy.rigid_engine.arcs import (
    FLAT,
    N_CORNERS,
    N_SLOTS,
    NEAR,
    Heights,
    Places,
    find_places,
    height_at,
    no_places,
    shape_of,
)
from benchmarks.accuracy.rigid_engine.rigid_body import BEAD, CONTACT_TIME, compiled, loads
from benchmarks.accuracy.rigid_engine.stepping import (
    Friction,
    Views,
    leg_loads,
    rotation_of,
    stepper,
)
from model.arrays import Array
from model.robot import N_LEGS, Robot

DT = 6.25e-5  # s; friction about rest, of 1 mm/s, is explicit and unstable above 0.2 ms
EVERY = 0.01  # s between the samples of a walk
SETTLING = 1.0  # s on still legs before the walk
MOST_DROPS = 20  # times that it is put down
AT_REST = 5e-4  # m that it may creep in that time: friction is smooth about rest
STICKY = Friction(3.0, 1e-2)  # as stiff about rest as one of 0.3 at 1 mm/s


@dataclass(frozen=True)
class Settings:
    """How finely the engine walks.

    Attributes:
        dt: Step [s].
        contact_time: Time constant of MuJoCo's contacts; those of half the time are four times as
            stiff [s].
    """

    dt: float = DT
    contact_time: float = CONTACT_TIME


SETTINGS = Settings()


@dataclass(frozen=True)
class EnginePath:
    """A walk of the engine, sampled every `EVERY` seconds.

    Attributes:
        t: Times, shape (n,) [s].
        position: Centre of the body, shape (n, 3) [m].
        yaw: Heading, unwrapped, shape (n,) [rad].
        load: Normal force on each leg, mean of the time since the last sample, shape (n, 6) [N].
        body_load: The same on the body's corners, shape (n,) [N].
        point: Where each leg's lowest contact was, NaN in the air, shape (n, 6, 3) [m].
        angle_error: Largest departure of a leg from its angle [rad].
    """

    t: Array
    position: Array
    yaw: Array
    load: Array
    body_load: Array
    point: Array
    angle_error: float


def walk(
    robot: Robot,
    t: Array,
    theta: Array,
    friction: Friction,
    *,
    heights: Heights = FLAT,
    settings: Settings = SETTINGS,
) -> EnginePath:
    """Walk the legs through a log of their angles, from x = y = yaw = 0, settled and at rest.

    Args:
        robot: The robot; leg offsets are taken to be in the angles.
        t: Times of the log from zero on [s].
        theta: Leg angles, unwrapped, linear in between, shape (n, 6) [rad].
        friction: The friction.
        heights: The ground.
        settings: Step and contacts.
    """
    run = _Run(robot, heights, settings)
    run.settle(theta[0])
    return run.walk(t, theta, friction)


class _Run:
    """One robot in MuJoCo and the arrays that its steps use."""

    def __init__(self, robot: Robot, heights: Heights, settings: Settings) -> None:
        dt = settings.dt
        self.dt, self.heights = dt, heights
        self.engine = compiled(robot, dt=dt, contact_time=settings.contact_time)
        self.data = mujoco.MjData(self.engine)
        data = self.data
        self.views = Views(data.qpos, data.qvel, self.engine.geom_pos, self.engine.geom_quat,
                           data.xfrc_applied[1], loads(data))  # fmt: skip
        self.shape, self.places = shape_of(robot), no_places()
        self.scratch = np.empty(len(self.shape.phi))
        self.reach = 2 * robot.leg_radius

    def step(self, theta: Array, speed: Array, friction: Friction) -> Array:
        """Walk steps from leg angles [rad] at speeds [rad/s], shape (n, 6); return mean loads."""
        carried = np.zeros(N_SLOTS)
        stepper()(self.engine._address, self.data._address, theta, speed, carried, self.views,
                  self.shape, self.heights, friction, BEAD, self.places, self.scratch)  # fmt: skip
        return carried / len(theta)

    def settle(self, theta: Array) -> None:
        """Put the robot on still legs and sticky ground until it rests at x = y = yaw = 0.

        On uneven ground it comes to rest beside the place. Put back, it would tip: it therefore
        settles again there.
        """
        data = self.data
        x, y = np.meshgrid(np.linspace(-0.2, 0.2, 41), np.linspace(-0.2, 0.2, 41))
        highest = max(height_at(self.heights, a, b) for a, b in zip(x.flat, y.flat, strict=True))
        data.qpos[2] = highest + self.reach
        still = np.tile(theta, (round(SETTLING / self.dt), 1))
        for _ in range(MOST_DROPS):
            self._lower(theta)
            self.step(still, np.zeros_like(still), STICKY)
            moved = float(np.hypot(*data.qpos[:2]))
            self._put_back()
            if moved < AT_REST or self.heights.z.size == 1:
                break
            data.qpos[2] += moved

    def _lower(self, theta: Array) -> None:
        """Lower the robot until it nearly touches the ground: in a hard landing it turns over."""
        data, places = self.data, self.places
        for _ in range(round(self.reach / (0.5 * NEAR))):
            rotation = rotation_of(data.qpos[3:7])
            find_places(data.qpos[:3], rotation, theta, self.shape, self.heights, places,
                        self.scratch)  # fmt: skip
            if places.near.any():
                break
            data.qpos[2] -= 0.5 * NEAR

    def _put_back(self) -> None:
        """Move the robot to x = y = yaw = 0, as high over the ground there, and stop it."""
        data = self.data
        data.qpos[2] += height_at(self.heights, 0.0, 0.0) - height_at(self.heights, *data.qpos[:2])
        data.qpos[:2] = 0.0
        half = -0.5 * _yaw(data.qpos[3:7])
        turned = np.empty(4)
        mujoco.mju_mulQuat(
            turned, np.array([np.cos(half), 0.0, 0.0, np.sin(half)]), data.qpos[3:7].copy()
        )
        data.qpos[3:7] = turned
        data.qvel[:] = 0.0

    def walk(self, t: Array, theta: Array, friction: Friction) -> EnginePath:
        """Walk through a log of leg angles and record it."""
        per_sample = round(EVERY / self.dt)
        n = int((t[-1] + 1e-9) // EVERY)
        times = self.dt * np.arange(n * per_sample + 1)
        angles = np.column_stack([np.interp(times, t, each) for each in theta.T])
        speeds = np.diff(angles, axis=0) / self.dt
        rows = [self._row(np.zeros(N_SLOTS))]
        error = 0.0
        for sample in range(n):
            steps = slice(sample * per_sample, (sample + 1) * per_sample)
            rows.append(self._row(self.step(angles[steps], speeds[steps], friction)))
            departure = self.data.qpos[7:] - angles[steps.stop]
            error = max(error, float(np.abs(departure).max()))
        table = np.array(rows)
        return EnginePath(
            t=EVERY * np.arange(n + 1, dtype=float),
            position=table[:, :3],
            yaw=np.unwrap(table[:, 3]),
            load=table[:, 4:10],
            body_load=table[:, 10],
            point=table[:, 11:].reshape(-1, N_LEGS, 3),
            angle_error=error,
        )

    def _row(self, carried: Array) -> Array:
        """Return the body's place and yaw, loads of legs and body, and where the legs touch."""
        data = self.data
        return np.concatenate([
            data.qpos[:3], [_yaw(data.qpos[3:7])], leg_loads(carried),
            [carried[:N_CORNERS].sum()], _points(self.places, self.views.loads).ravel(),
        ])  # fmt: skip


def _yaw(q: Array) -> float:
    """Return the heading of a quaternion, rotations by R = Rz(yaw) Ry(pitch) Rx(roll) [rad]."""
    rotation = rotation_of(q)
    return float(np.arctan2(rotation[1, 0], rotation[0, 0]))


def _points(places: Places, forces: Array) -> Array:
    """Return the place of each leg's larger force, NaN of legs without one, shape (6, 3) [m]."""
    by_leg = forces[N_CORNERS:].reshape(N_LEGS, -1)
    points = places.point[N_CORNERS:].reshape(N_LEGS, -1, 3)
    largest = points[np.arange(N_LEGS), by_leg.argmax(axis=1)]
    return np.where((by_leg.max(axis=1) > 0)[:, None], largest, np.nan)
