# SPDX-License-Identifier: MIT
"""The thesis's model as a walking model: dynamics of tripods, kinematics of all other gaits."""

from model.errors import DomainError
from model.gait.cyclic import CyclicReference
from model.gait.direction import Direction
from model.gait.reference import LegReference
from model.robot import GRAVITY, Robot
from model.thesis.detected import kinematic_path, walk_detected
from model.thesis.legs import SwitchedLegs
from model.thesis.path import ThesisPath
from model.thesis.traction import slip_traction
from model.thesis.tripod import Rule
from model.thesis.walk import ThesisOptions, is_tripod, walk_thesis
from model.walk.slip import Slip


def walk_by_thesis(
    robot: Robot,
    reference: LegReference,
    slip: Slip | None,
    *,
    duration: float,
    dt: float,
    direction: Direction = "left",
    rule: Rule = "listing",
) -> ThesisPath:
    """Walk by the thesis's model.

    The legs of a log stand still and turn back by fractions of a degree; by the listing's slip
    ratio such a leg would have full traction. Of logs slip therefore has the sign of the equations.

    Args:
        robot: The robot; its leg offsets are added to the angles.
        reference: Leg angles over time, from time zero on.
        slip: The slip law; None for kinematics.
        duration: Time walked [s].
        dt: Length of a step [s].
        direction: Side to which the gait turns.
        rule: What the dynamics follows where listing and text differ.

    Raises:
        DomainError: A tripod or a log has no slip law, the law loses its shape at a leg's loads, or
            as `walk_thesis` and `walk_detected`.
        DefinitionMismatch: The slip curve's definition is not `material`.
        WalkError: The walk diverged, or no contact state fits.
    """
    if is_kinematic(reference):
        path = walk_detected(robot, reference, duration=duration, dt=dt)
        return kinematic_path(robot, path)
    if slip is None:
        raise DomainError("the thesis's model of tripods needs a slip law; none was given")
    options = ThesisOptions(
        dt=dt, direction=direction, rule=rule,
        mend_slip=not isinstance(reference, CyclicReference),
    )  # fmt: skip
    return walk_thesis(
        robot, _legs(reference), duration=duration, options=options,
        traction=slip_traction(slip, weight=robot.mass * GRAVITY),
    )  # fmt: skip


def is_kinematic(reference: LegReference) -> bool:
    """Return whether legs are walked by kinematics, without slip: a gait that is no tripod.

    Args:
        reference: Leg angles over time.
    """
    return isinstance(reference, CyclicReference) and not is_tripod(reference)


def _legs(reference: LegReference) -> LegReference | SwitchedLegs:
    """Convert a cyclic gait to legs that switch speed by angle, as the thesis's do.

    A log is returned unchanged, and so is a gait with pauses or offsets, or with touchdown or
    lift-off outside 0 to 360 degrees: these are followed by the clock.
    """
    if not isinstance(reference, CyclicReference):
        return reference
    try:
        return SwitchedLegs.of(reference)
    except DomainError:
        return reference
