# SPDX-License-Identifier: MIT
"""The walking models by name, and the baselines that a prediction is compared with."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from model.errors import DomainError, WalkError
from model.gait.cyclic import CyclicReference
from model.gait.direction import Direction
from model.gait.reference import LegReference, SampledReference
from model.leg_state import LegState, bend_in, law_in, robot_in
from model.path_draws import bent_walk
from model.poses import Poses
from model.robot import GRAVITY, Robot
from model.slip.thesis import thesis_curve
from model.walk.path import WalkPath
from model.walk.slip import Slip
from model.walk.slipping import SLIPPING
from model.walk.terrain import LEVEL, Terrain
from model.walk.thesis_switches import AS_LISTED, ThesisSwitches
from model.walk.traction import ToeLaw

if TYPE_CHECKING:
    from model.contact.detection import Detection
    from model.contact.tripod import Automaton
    from model.walk.thesis import Switch, SwitchedLegs

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
        toe: Traction of a leg on its toe, see `law_table`; only the model "dynamics" uses it.
        direction: Side to which the gait turns; only the thesis's model uses it.
        automaton: What decides contact in the thesis's model: "listing" or "table" in its dynamics
            of tripods, "events" or "balanced" in its kinematics of any gait; None for "listing",
            or for "events" if a cyclic gait is no tripod.
        switch: Where the legs of a gait change speed; only the thesis's model uses it.
        legs: Corrections to robot, slip law and path, of which draw 0 is used; None for none. Only
            the model "dynamics" uses them.
        thesis: Switches of the thesis's model; only that model uses them.
        terrain: The ground; only the model "dynamics" walks on other than level ground of one law.
    """

    robot: Robot
    reference: LegReference
    slip: Slip | None
    duration: float
    dt: float
    toe: ToeLaw = "saturated"
    direction: Direction = "left"
    automaton: "Automaton | Detection | None" = None
    switch: "Switch" = "angle"
    legs: LegState | None = None
    thesis: ThesisSwitches = AS_LISTED
    terrain: Terrain = LEVEL


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
    from model.walk.areas import with_areas
    from model.walk.bent_walk import walk_bent
    from model.walk.dynamics import DynamicsOptions, walk

    weight, options = run.robot.mass * GRAVITY, DynamicsOptions(dt=run.dt)
    robot, law = run.robot, _slip_of(run).traction_table(weight=weight, toe=run.toe)
    if run.legs is not None:
        robot, law = robot_in(robot, run.legs, 0), law_in(law, run.legs, 0)
    laws = with_areas(law, run.terrain.tabulated(weight=weight, toe=run.toe))
    if run.legs is not None and not run.terrain.is_alike_everywhere:
        return walk_bent(
            robot, run.reference, laws, bend=bend_in(run.legs, 0), duration=run.duration,
            options=options, ground=run.terrain.ground,
        )  # fmt: skip
    path = walk(
        robot, run.reference, laws, duration=run.duration, options=options,
        ground=run.terrain.ground,
    )  # fmt: skip
    if run.legs is None:
        return path
    return bent_walk(path, bend_in(run.legs, 0))


def _thesis(run: ModelRun) -> WalkPath:
    """Walk by the thesis's model: dynamics of tripods, or kinematics of any gait.

    The dynamics have `ThesisOptions.mend_slip` unless a cyclic gait is walked.
    """
    from model.walk.detected import walk_detected
    from model.walk.thesis import ThesisOptions, walk_thesis
    from model.walk.thesis.kinematic import kinematic_path

    automaton = thesis_automaton(run.automaton, run.reference)
    if automaton == "events" or automaton == "balanced":
        if run.switch == "contact":
            raise DomainError(
                f"legs that change speed at contact need the dynamics of tripods; by '{automaton}' "
                "the legs follow the gait: use the automaton 'listing' or 'table' and a tripod"
            )
        if run.thesis != AS_LISTED:
            raise DomainError(
                "switches of the thesis's model are of its dynamics of tripods; by the automaton "
                f"'{automaton}' it walks kinematics: leave them out, or walk a tripod"
            )
        path = walk_detected(
            run.robot, run.reference, duration=run.duration, dt=run.dt, detection=automaton
        )
        return kinematic_path(run.robot, path)
    traction = _slip_of(run).thesis_traction(weight=run.robot.mass * GRAVITY)
    legs = _legs_of_the_thesis(run.reference)
    # The legs of a log stand still and turn back by fractions of a degree; by the listing's slip
    # ratio such a leg would have full traction.
    logged = not isinstance(run.reference, CyclicReference)
    mended = replace(run.thesis, mend_slip=logged or run.thesis.mend_slip)
    options = ThesisOptions(
        **vars(mended), dt=run.dt, direction=run.direction, automaton=automaton, switch=run.switch
    )
    return walk_thesis(run.robot, legs, duration=run.duration, traction=traction, options=options)


def thesis_automaton(
    asked: "Automaton | Detection | None", reference: LegReference
) -> "Automaton | Detection":
    """Return what decides contact in the thesis's model: what was asked for, or its default.

    Args:
        asked: The rule that was asked for; None for the default: "events" for a cyclic gait that is
            no tripod, "listing" for all other leg angles.
        reference: Leg angles over time.
    """
    from model.walk.thesis import is_tripod

    if asked is not None:
        return asked
    cyclic = isinstance(reference, CyclicReference)
    return "events" if cyclic and not is_tripod(reference) else "listing"


def decides_contact(run: ModelRun, model: str) -> str:
    """Name what decides contact in a model: "force", "rest" or the rule of the thesis's model.

    Args:
        run: Inputs of the model.
        model: Name of the model. "rest": legs on which the robot rests, as in models without slip.
    """
    if model == "thesis":
        return thesis_automaton(run.automaton, run.reference)
    return "force" if MODELS[model].slips else "rest"


def _legs_of_the_thesis(reference: LegReference) -> "LegReference | SwitchedLegs":
    """Convert a cyclic gait to legs that switch speed by angle, as the thesis's do.

    A log is returned unchanged, and so is a gait with pauses or offsets, or with touchdown or
    lift-off outside 0 to 360 degrees: these are followed by the clock.
    """
    from model.walk.thesis import SwitchedLegs

    if not isinstance(reference, CyclicReference):
        return reference
    try:
        return SwitchedLegs.of(reference)
    except DomainError:
        return reference


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
