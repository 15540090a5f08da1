# SPDX-License-Identifier: MIT
"""The walking model: a rigid body whose position-controlled legs slip by a measured law.

Leg angles are inputs. Each leg touches the ground at its lowest point, with a stiff and damped
normal force and a traction vector against the slip vector of the material contact point; force
alone decides which legs are in contact. Where this departs from the thesis's model, and why, is in
`docs/theory.md`.
"""

from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from model.errors import DomainError, WalkError
from model.gait.reference import LegReference
from model.robot import N_LEGS, Robot
from model.walk.arrays import Contacts, State, body_arrays
from model.walk.ground import FLAT, Ground, ground_at, highest_near, is_even, is_level
from model.walk.loop import run_steps
from model.walk.path import WalkPath, path_of
from model.walk.quaternion import roll_pitch_yaw, turned_about_vertical
from model.walk.traction import TractionTable, VelocityCoulomb

SETTLE_STEP = 0.005  # s
SETTLE_TIME = 1.0  # s; ten times the duration of the drop
REST_TIME, MOST_RESTS = 0.2, 20  # s on uneven ground without being held, and how often
AT_REST = 1e-5  # m by which a robot at rest moves in that time
STICKY = VelocityCoulomb(3.0, 1e-4).table(weight=1.0)  # to settle on a slope without sliding down
SLIPPERY = VelocityCoulomb(0.01).table(weight=1.0)  # to settle in a place where the body is held


@dataclass(frozen=True)
class DynamicsOptions:
    """Step length, and stiffness and damping of contacts, of the walking model.

    Attributes:
        dt: Length of a step [s].
        stiffness: Normal force for each metre of sinkage; a leg sinks micrometres [N/m].
        damping: Normal force for each metre a second of sinking; a third of critical for a third
            of the body's mass. Steps longer than damping over stiffness damp more, by stiffness
            times their length [N s/m].

    Raises:
        DomainError: A value is not positive and finite.
    """

    dt: float = 0.002
    stiffness: float = 2e5
    damping: float = 300.0

    def __post_init__(self) -> None:
        """Check that step, stiffness and damping are positive and finite."""
        for name, unit in (("dt", "s"), ("stiffness", "N/m"), ("damping", "N s/m")):
            value = getattr(self, name)
            if not (value > 0 and np.isfinite(value)):
                raise DomainError(f"{name} is {value:g} {unit}; expected more than zero, finite")


DEFAULT_OPTIONS = DynamicsOptions()


@dataclass(frozen=True)
class Start:
    """Initial pose and velocity of a walk in the inertial frame.

    Attributes:
        x: x of the body's centre [m].
        y: y of the body's centre [m].
        yaw: Heading [rad].
        height: z of the body's centre, from which the level body drops; None to start settled on
            the legs [m].
        velocity: Velocity of the body's centre, in either case [m/s].
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    height: float | None = None
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)


ORIGIN = Start()


def walk(
    robot: Robot,
    reference: LegReference,
    table: TractionTable,
    *,
    duration: float,
    ground: Ground = FLAT,
    start: Start = ORIGIN,
    options: DynamicsOptions = DEFAULT_OPTIONS,
) -> WalkPath:
    """Compute the walk of a robot whose legs follow given angles, sampled at every step.

    Args:
        robot: The robot; its leg offsets are added to the angles.
        reference: Leg angles over time.
        table: The slip law; see `model.walk.traction`.
        duration: Time walked, from the reference's time zero on [s].
        ground: The ground.
        start: Initial pose and velocity.
        options: Step length and contacts.

    Returns:
        The path; its first sample is the start, with the slip and forces of the first step's end.
        Slip ratios, of a leg that rolls, are material ones; NaN for others.

    Raises:
        DomainError: The duration is not finite or rounds to no step.
        WalkError: The robot cannot stand at the start, or a step diverged; the message says where.
    """
    t = step_times(duration, options.dt)
    theta = reference.angles(t) + robot.leg_offset
    state = start_state(robot, theta[0], options, ground=ground, start=start)
    pose, legs = integrate(robot, table, state, theta, options, ground=ground, keep_legs=True)
    return path_of(t, pose, theta, legs)


def step_times(duration: float, dt: float) -> Array:
    """Compute the times 0, dt, 2 dt, ... of all steps; the duration is rounded to whole steps.

    Args:
        duration: Time walked [s].
        dt: Length of a step [s].

    Returns:
        Times from zero, shape (n + 1,) [s].

    Raises:
        DomainError: The duration is not finite or rounds to no step.
    """
    n = round(duration / dt) if duration > 0 and np.isfinite(duration) else 0
    if n < 1:
        raise DomainError(
            f"the duration is {duration:g} s; expected a finite time that rounds to at least one "
            f"step of {dt:g} s"
        )
    return dt * np.arange(n + 1, dtype=float)


def integrate(
    robot: Robot,
    table: TractionTable,
    state: State,
    theta: Array,
    options: DynamicsOptions,
    *,
    ground: Ground = FLAT,
    keep_legs: bool = False,
    began: float = 0.0,
) -> tuple[Array, Array]:
    """Integrate the body's motion from an initial state through leg angles at equal steps.

    Args:
        robot: The robot.
        table: The slip law.
        state: Initial state, overwritten with the final one.
        theta: Leg angles at every step's start and the last one's end, shape (n + 1, 6) [rad].
        options: Step length and contacts.
        ground: The ground.
        keep_legs: Whether to return slip and forces of the legs and the body.
        began: Time of the first step, for the message of an error [s].

    Returns:
        Position [m] and quaternion (w, x, y, z) at the times of `theta`, shape (n + 1, 7), and slip
        and forces at each step's end as in `run_steps`, shape (n, 7, 6), or (0, 7, 6) if not kept.

    Raises:
        WalkError: A step diverged; the message says when and where.
    """
    contacts, dt = Contacts(options.stiffness, options.damping), options.dt
    n = len(theta) - 1
    pose, legs = np.empty((n + 1, 7)), np.empty((n if keep_legs else 0, N_LEGS + 1, 6))
    pose[0] = np.concatenate([state.p, state.q])
    done = run_steps(body_arrays(robot), table, ground, contacts, state, theta, dt, pose[1:], legs)
    require_finished(pose, done, dt, began=began)
    return pose, legs


def require_finished(pose: Array, done: int, dt: float, *, began: float = 0.0) -> None:
    """Raise `WalkError` if a walk diverged; its message says when and where.

    Args:
        pose: Position and quaternion at the times of all steps, shape (n + 1, 7).
        done: Number of steps computed.
        dt: Length of a step [s].
        began: Time of the first step [s].
    """
    if done < len(pose) - 1:
        x, y, z = pose[done, :3]
        raise WalkError(
            f"the walk diverged at t = {began + done * dt:.4g} s, with the body at "
            f"x {x:.4g}, y {y:.4g}, z {z:.4g} m; look at the leg angles there, or take a smaller dt"
        )


def start_state(
    robot: Robot,
    theta: Array,
    options: DynamicsOptions,
    *,
    ground: Ground = FLAT,
    start: Start = ORIGIN,
) -> State:
    """Compute the initial state: the robot settled on its legs, or level at the start's height.

    Angular velocity is zero. A robot that its legs do not hold settles on its body.
    On uneven ground it is held above its place all the time, and the ground is slippery: moved back
    there afterwards, its legs could be deep in the ground. It then comes to rest by itself, see
    `_come_to_rest`.

    Args:
        robot: The robot.
        theta: Leg angles to stand on, shape (6,) [rad].
        options: Stiffness and damping of contacts; its step is not used.
        ground: The ground.
        start: Initial pose and velocity.

    Raises:
        WalkError: Settling diverged, as with leg angles that are not finite.
    """
    state = unsettled_state(robot, ground=ground, start=start)
    if start.height is not None:
        return state
    still, slow = standing_angles(theta), replace(options, dt=SETTLE_STEP)
    try:
        if is_level(ground) or is_even(ground):
            integrate(robot, STICKY, state, still, slow, ground=ground)
        else:
            for _ in range(len(still) - 1):
                integrate(robot, SLIPPERY, state, still[:2], slow, ground=ground)
                _hold(state, start.x, start.y, start.yaw)
            _come_to_rest(robot, still, ground, state, slow)
    except WalkError as error:
        raise cannot_stand(theta, start) from error
    return settled(state, ground=ground, start=start)


def unsettled_state(robot: Robot, *, ground: Ground = FLAT, start: Start = ORIGIN) -> State:
    """Compute the state that settling begins from: level above the ground, at rest.

    With a height given by the start it is the initial state itself, with the start's velocity.

    Args:
        robot: The robot.
        ground: The ground.
        start: Initial pose and velocity.
    """
    half = 0.5 * start.yaw
    far = float(np.linalg.norm(robot.hips, axis=1).max()) + 2 * robot.leg_radius
    highest = highest_near(ground, start.x, start.y, far)
    reach = 2 * robot.leg_radius + max(0.5 * robot.body_size[2], -float(robot.hips[:, 2].min()))
    return State(
        p=np.array([start.x, start.y, highest + reach if start.height is None else start.height]),
        q=np.array([np.cos(half), 0.0, 0.0, np.sin(half)]),
        v=np.zeros(3) if start.height is None else np.array(start.velocity, dtype=float),
        w=np.zeros(3),
    )


def standing_angles(theta: Array) -> Array:
    """Repeat leg angles (6,) for all steps of settling, shape (n + 1, 6) [rad]."""
    return np.tile(theta, (round(SETTLE_TIME / SETTLE_STEP) + 1, 1))


def cannot_stand(theta: Array, start: Start = ORIGIN) -> WalkError:
    """Return the error of a robot whose settling at a start on leg angles (6,) [rad] diverged."""
    return WalkError(
        f"the robot cannot stand at x {start.x:g}, y {start.y:g} m on legs at "
        f"{np.degrees(theta).round(1)} degrees: settling diverged; check that all are finite, and "
        "stiffness and damping"
    )


def settled(state: State, *, ground: Ground = FLAT, start: Start = ORIGIN) -> State:
    """Move a body that has settled back to the start's x, y and yaw.

    Args:
        state: State after 1 s on motionless legs, overwritten and returned: its height as settled
            over the ground at x and y, roll and pitch as settled, its velocity the start's, angular
            velocity zero.
        ground: The ground.
        start: Initial pose and velocity.
    """
    if not is_level(ground):
        there, here = (ground_at(ground, *each)[0] for each in ((start.x, start.y), state.p[:2]))
        state.p[2] += there - here
    _hold(state, start.x, start.y, start.yaw)
    state.v[:] = start.velocity
    state.w[:] = 0.0
    return state


def _come_to_rest(
    robot: Robot, still: Array, ground: Ground, state: State, options: DynamicsOptions
) -> None:
    """Let a held robot go on sticky ground, and move it back, until it moves no more.

    Feet on slopes push a robot aside, which holds it up as no friction under the feet would: let
    go, it may tip onto other legs. Each time it is moved back its feet come to other heights, but
    by a tenth or less of the way, so that few times suffice. The state is overwritten. Where the
    robot does not come to rest it is left as it is after the last time.
    """
    x, y = state.p[:2].tolist()
    yaw = float(roll_pitch_yaw(state.q[None])[0, 2])
    rest = still[: round(REST_TIME / options.dt) + 1]
    for _ in range(MOST_RESTS):
        integrate(robot, STICKY, state, rest, options, ground=ground)
        moved = float(np.hypot(state.p[0] - x, state.p[1] - y))
        _hold(state, x, y, yaw)
        if moved < AT_REST:
            break


def _hold(state: State, x: float, y: float, yaw: float) -> None:
    """Move a state to x, y [m] and yaw [rad], and stop its motion along the ground and its yaw."""
    state.p[:2] = x, y
    state.q[:] = turned_about_vertical(state.q, yaw - roll_pitch_yaw(state.q[None])[0, 2])
    state.v[:2] = 0.0
    state.w[2] = 0.0
