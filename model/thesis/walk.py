# SPDX-License-Identifier: MIT
"""Walk by the thesis's model: options, initial state and the resulting path."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.errors import DomainError, WalkError
from model.frames import roll_pitch_yaw, thesis_attitude
from model.gait.cyclic import CyclicReference
from model.gait.direction import Direction, inner_legs
from model.gait.reference import LegReference
from model.leg import hip_height, wrap_angle
from model.robot import N_LEGS, Robot
from model.thesis.legs import SwitchedLegs, ThesisLegMotion, leg_motion
from model.thesis.path import ThesisPath
from model.thesis.record import Record, empty_record
from model.thesis.step import Machine, Manner, run
from model.thesis.traction import THESIS_TRACTION, Traction
from model.thesis.tripod import RULES, Rule
from model.walk.dynamics import step_times

TRIPODS = ((0, 3, 4), (1, 2, 5))
SAME_SIDE = ((0, 4), (1, 5))  # legs of one tripod on one side, which turn alike
APART = np.radians(45.0)  # largest angle between these legs in a tripod gait [rad]
_LOOKS = 721  # instants of a cycle at which leg angles are compared: every half degree


@dataclass(frozen=True)
class ThesisOptions:
    """Options of the thesis's walking model.

    Attributes:
        dt: Length of a step [s].
        direction: Side to which the gait turns; the legs of that side are the inner ones.
        rule: "listing": contacts change by Listing A.32, and each change sets the body's height.
            "text": they change by Table 3-1 and leave the height as it is, so that the body sinks,
            as in Fig. 5-8.
        mend_slip: Give slip the sign of the equations where legs turn back or the body goes
            backward, instead of the listing's; see `walk_slip` and `lateral_walk_slip`.
        heading: Yaw at the start, on which the walk depends [rad].

    Raises:
        DomainError: The step is not positive and finite, or the direction or the rule is unknown.
    """

    dt: float = 0.001
    direction: Direction = "left"
    rule: Rule = "listing"
    mend_slip: bool = False
    heading: float = 0.0

    def __post_init__(self) -> None:
        """Check that step, direction and rule are valid."""
        if not (self.dt > 0 and np.isfinite(self.dt)):
            raise DomainError(f"dt is {self.dt:g} s; expected more than zero, and finite")
        inner_legs(self.direction)
        if self.rule not in RULES:
            raise DomainError(f"rule is '{self.rule}'; expected {' or '.join(RULES)}")

    @property
    def manner(self) -> Manner:
        """Settings of the compiled loop: `direction` as inner side."""
        right = self.direction == "right"
        return Manner(self.dt, int(right), self.rule == "text", self.mend_slip)


AS_PRINTED = ThesisOptions()


def walk_thesis(
    robot: Robot,
    reference: LegReference | SwitchedLegs,
    *,
    duration: float,
    traction: Traction = THESIS_TRACTION,
    options: ThesisOptions = AS_PRINTED,
) -> ThesisPath:
    """Compute a tripod walk by the thesis's hybrid dynamic model, Listing A.4.

    Args:
        robot: The robot, whose leg offsets are added; the thesis's has half-circle legs.
        reference: Legs that switch speed by angle, as the thesis's do, or leg angles over time,
            which are followed by the clock.
        duration: Time walked [s].
        traction: The slip law; see `model.thesis.traction`.
        options: Settings of the model.

    Returns:
        The path from t = 0, x = y = 0 and rest; forces of a sample are those of the step that
        begins there. Roll, pitch and yaw are converted to those of `attitude`.
        `slip_ratio` is the thesis's, Eq. (4-31), or slip velocity over its scale for a law by
        velocity; `slip_velocity` is NaN on the ground, as the model has no velocity of the
        material contact point. The model's own quantities are the path's further attributes.

    Raises:
        DomainError: The duration is not finite or rounds to no step, or the gait is not a tripod:
            two legs of a tripod's side are more than 45 degrees apart.
        WalkError: The walk diverged; the message says when and in what state.
    """
    t = step_times(duration, options.dt)
    steps = len(t)
    turned = leg_motion(reference, dt=options.dt, steps=steps)
    motion = turned._replace(theta=turned.theta + robot.leg_offset)
    _require_tripod(motion, options.dt)
    sides, q = _start(robot, motion.theta, options)
    record = empty_record(steps)
    state, rates = q.copy(), np.zeros(6)
    done = run(_machine(robot), options.manner, traction, motion, state, rates, sides, record)
    if done < steps:
        raise _diverged(done * options.dt, state, rates)
    return _path(record, motion, t)


def _machine(robot: Robot) -> Machine:
    """Convert a robot's geometry, mass and inertia to the arrays of the thesis's loop."""
    return Machine(
        robot.hips, robot.leg_radius, robot.toe_beyond, robot.mass, robot.principal_inertia,
        robot.track,
    )  # fmt: skip


def is_tripod(gait: CyclicReference) -> bool:
    """Return whether the thesis's dynamics can walk a gait: one of tripods {1,4,5} and {2,3,6}.

    Only legs of one tripod and side are compared, 1 with 5 and 2 with 6: they must stay within
    `APART` of each other, modulo a turn.

    Args:
        gait: Gait of six legs.
    """
    theta = gait.angles(np.linspace(0.0, gait.period, _LOOKS))
    return all(np.all(_apart(theta, pair) <= APART) for pair in SAME_SIDE)


def _apart(theta: Array, pair: tuple[int, int]) -> Array:
    """Compute the absolute angle between two legs, up to half a turn, shape (n,) [rad]."""
    return np.abs(wrap_angle(theta[:, pair[0]] - theta[:, pair[1]]))


def _require_tripod(motion: ThesisLegMotion, dt: float) -> None:
    """Raise `DomainError` where two legs of one tripod and side are more than `APART` apart."""
    for first, other in SAME_SIDE:
        apart = _apart(motion.theta, (first, other))
        worst = int(np.argmax(apart))
        if apart[worst] > APART:
            raise DomainError(
                f"legs {first + 1} and {other + 1} are {np.degrees(apart[worst]):.3g} degrees "
                f"apart at t = {worst * dt:.4g} s, expected at most {np.degrees(APART):g}; the "
                "thesis's dynamics walks tripods only, {1,4,5} and {2,3,6}: use the dynamics model"
            )


def _start(robot: Robot, theta: Array, options: ThesisOptions) -> tuple[NDArray[np.bool_], Array]:
    """Compute the initial stance legs and pose of a robot on one tripod, without pitch.

    Mean inner minus mean outer hip height, over the track, gives the roll (by its arctangent), the
    mean of both the height. The tripod with the higher inner hips after the first step stands: at
    the start of a matched gait they are equal.

    Returns:
        Mask of the stance legs, shape (6,); x, y, z [m], roll, pitch and yaw [rad], shape (6,).
    """
    inner = options.manner.inner
    heights = _side_heights(robot, theta[0])
    first = int(np.argmax(_side_heights(robot, theta[1])[:, inner]))
    sides = np.isin(np.arange(N_LEGS), TRIPODS[first])
    difference = heights[first, inner] - heights[first, 1 - inner]
    roll = np.arctan(difference / robot.track)
    q = np.array([0.0, 0.0, heights[first].mean(), roll, 0.0, options.heading])
    return sides, q


def _side_heights(robot: Robot, theta: Array) -> Array:
    """Compute mean hip heights [m] of a level body by tripod (2 rows) and side (left, right)."""
    phi = wrap_angle(np.pi / 2 - theta)
    height = np.asarray(hip_height(phi, robot.leg_radius, robot.toe_beyond))
    return np.array(
        [
            [height[[i for i in three if i % 2 == side]].mean() for side in (0, 1)]
            for three in TRIPODS
        ]
    )


def _path(record: Record, motion: ThesisLegMotion, t: Array) -> ThesisPath:
    """Convert the record to a path, angles of Eq. (3-7) to roll, pitch and yaw of `attitude`."""
    angles = record.state[:, 3:]
    on_ground = np.where(record.contact, np.nan, 0.0)
    return ThesisPath(
        t=t,
        position=record.state[:, :3],
        orientation=_orientation(angles),
        theta=motion.theta,
        contact=record.contact,
        slip_velocity=np.stack([on_ground, on_ground], axis=-1),
        slip_ratio=record.kappa,
        normal_force=record.normal,
        traction_force=np.stack([record.forward, record.left], axis=-1),
        angles=angles,
        rates=record.rates,
        acceleration=record.acceleration,
        phi=record.phi,
        phi_rate=record.phi_rate,
        hip_height=record.height,
        static_load=record.static,
        leg_speed=record.speeds[..., 0],
        contact_speed=record.speeds[..., 1],
        hip_speed=record.speeds[..., 2],
    )


def _orientation(angles: Array) -> Array:
    """Convert angles of Eq. (3-7) to roll, pitch and yaw of `attitude`, yaw unwrapped, (n, 3)."""
    yaw = angles[:, 2]
    ours = roll_pitch_yaw(thesis_attitude(*angles.T))
    ours[:, 2] = yaw + wrap_angle(ours[:, 2] - yaw)  # keeps count of full turns
    return ours


def _diverged(t: float, q: Array, rates: Array) -> WalkError:
    """Create the error of a walk that diverged at time t with coordinates q and their rates."""
    x, y, z = q[:3]
    roll, pitch, yaw = np.degrees(q[3:])
    return WalkError(
        f"the walk diverged at t = {t:.4g} s, with the body at x {x:.4g}, y {y:.4g}, z {z:.4g} m, "
        f"roll {roll:.4g}, pitch {pitch:.4g}, yaw {yaw:.4g} degrees and its velocity at "
        f"{rates[0]:.4g}, {rates[1]:.4g}, {rates[2]:.4g} m/s; look at the leg angles there, or "
        "take a smaller dt"
    )
