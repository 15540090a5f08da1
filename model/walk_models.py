# SPDX-License-Identifier: MIT
"""The walking models by name, and the baselines that a prediction is compared with."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, TypeAlias

from model.errors import DomainError, WalkError
from model.gait.direction import Direction
from model.gait.reference import LegReference, SampledReference
from model.leg_state import LegState, corrected
from model.path_draws import bent_walk
from model.poses import Poses
from model.robot import GRAVITY, Robot
from model.slip.thesis_curve import thesis_curve
from model.walk.bend import STRAIGHT
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from model.walk.slip import Slip
from model.walk.slipping import SLIPPING

Rule: TypeAlias = Literal["listing", "text"]
"""What the thesis's dynamics follows where its listing and its text differ."""
BASELINES = ("no-slip-simple", "no-slip", "thesis")


@dataclass(frozen=True)
class ModelRun:
    """Inputs of a walking model.

    Attributes:
        robot: The robot; its leg offsets are added to the angles.
        reference: Leg angles over time, from time zero on.
        slip: The slip law; None for a model without slip.
        duration: Time walked [s].
        dt: Length of a step [s].
        direction: Side to which the gait turns; only the thesis's model uses it.
        rule: What the thesis's dynamics follows where its listing and its text differ; only that
            model uses it.
        legs: Corrections to robot, slip law and path, of which draw 0 is used; None for none. Only
            the model "dynamics" uses them.
        ground: The ground; only the model "dynamics" walks on other than level ground.
    """

    robot: Robot
    reference: LegReference
    slip: Slip | None
    duration: float
    dt: float
    direction: Direction = "left"
    rule: Rule = "listing"
    legs: LegState | None = None
    ground: Ground = FLAT


@dataclass(frozen=True)
class WalkModel:
    """A walking model.

    Attributes:
        name: Key of the model in `MODELS`.
        dt: Default length of a step [s].
        run: Function that computes the path from the model's inputs.
    """

    name: str
    dt: float
    run: Callable[[ModelRun], WalkPath]

    @property
    def slips(self) -> bool:
        """Whether the model needs a slip law."""
        return self.name in SLIPPING


def baseline_paths(
    robot: Robot, reference: SampledReference, *, direction: Direction = "left", start: float = 0.0
) -> tuple[dict[str, Poses], tuple[str, ...]]:
    """Compute the path of a leg log by every baseline model, `BASELINES`.

    The thesis's model walks with the thesis's slip curve, the others without slip.

    Args:
        robot: The robot; its leg offsets are added to the angles, so 0 where angles are true.
        reference: Leg angles; walked from time zero to the last sample.
        direction: Side the gait turns to; only the thesis's model uses it.
        start: Added to the paths' times [s].

    Returns:
        Paths by the models' names, and one line of text with the reason for each model that cannot
        walk these angles and is left out.
    """
    duration = float(reference.t[-1])
    paths, notes = {}, []
    for name in BASELINES:
        model = MODELS[name]
        slip = Slip(thesis_curve(), source="thesis") if model.slips else None
        run = ModelRun(robot, reference, slip, duration, model.dt, direction=direction)
        try:
            path = model.run(run)
        except (WalkError, DomainError) as error:
            notes.append(f"baseline '{name}' cannot walk these leg angles: {error}")
            continue
        paths[name] = path.poses.delayed(start)
    return paths, tuple(notes)


def _dynamics(run: ModelRun) -> WalkPath:
    """Walk by the project's model; with `legs`, correct robot, law and path by their draw 0."""
    from model.walk.dynamics import DynamicsOptions, walk

    robot, law = run.robot, _slip_of(run).traction_table(weight=run.robot.mass * GRAVITY)
    bend = STRAIGHT
    if run.legs is not None:
        robot, law, bend = corrected(robot, law, run.legs)
    path = walk(
        robot, run.reference, law, duration=run.duration, options=DynamicsOptions(dt=run.dt),
        ground=run.ground,
    )  # fmt: skip
    return bent_walk(path, bend, run.ground)


def _thesis(run: ModelRun) -> WalkPath:
    """Walk by the thesis's model."""
    from model.thesis.model import walk_by_thesis

    return walk_by_thesis(
        run.robot, run.reference, run.slip, duration=run.duration, dt=run.dt,
        direction=run.direction, rule=run.rule,
    )  # fmt: skip


def decides_contact(run: ModelRun, model: str) -> str:
    """Name what decides contact in a model.

    Args:
        run: Inputs of the model.
        model: Name of the model, a key of `MODELS`.

    Returns:
        "force" of the model "dynamics"; "rest", the legs on which the robot rests, of models
        without slip; of the thesis's model the rule of the run, or "events", the detection at
        touchdowns, where it walks by kinematics.
    """
    if model == "thesis":
        return "events" if is_kinematic(model, run.reference) else run.rule
    return "force" if MODELS[model].slips else "rest"


def is_kinematic(model: str, reference: LegReference) -> bool:
    """Return whether a model that has slip walks these leg angles by kinematics, without slip.

    Only the thesis's model does so, with a cyclic gait that is no tripod.

    Args:
        model: Name of the model.
        reference: Leg angles over time.
    """
    if model != "thesis":
        return False
    from model.thesis.model import is_kinematic as is_no_tripod

    return is_no_tripod(reference)


def _no_slip(run: ModelRun) -> WalkPath:
    """Walk by `walk_no_slip`."""
    from model.walk.no_slip import walk_no_slip

    return walk_no_slip(run.robot, run.reference, duration=run.duration, dt=run.dt)


def _wheels(run: ModelRun) -> WalkPath:
    """Walk by `walk_wheels`."""
    from model.walk.no_slip import walk_wheels

    return walk_wheels(run.robot, run.reference, duration=run.duration, dt=run.dt)


def _slip_of(run: ModelRun) -> Slip:
    """Return the slip law of a run; raise `DomainError` if the run has none."""
    if run.slip is None:
        raise DomainError("this walking model needs a slip law; none was given")
    return run.slip


MODELS: Mapping[str, WalkModel] = MappingProxyType({
    model.name: model
    for model in (
        WalkModel("dynamics", dt=0.002, run=_dynamics),
        WalkModel("thesis", dt=0.001, run=_thesis),
        WalkModel("no-slip", dt=0.002, run=_no_slip),
        WalkModel("no-slip-simple", dt=0.002, run=_wheels),
    )
})  # fmt: skip
"""Walking models by name: the project's own, the thesis's, and the two without slip."""
