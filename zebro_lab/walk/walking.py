# SPDX-License-Identifier: MIT
"""Compute a path from leg angles, for `walk` and `predict`."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np

from model.errors import DefinitionMismatch
from model.gait import CyclicReference, EventSystem, SampledReference
from model.gait.direction import Direction
from model.gait.reference import LegReference
from model.gait.stance import Intervals
from model.poses import Poses
from model.predict import FINE
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from model.walk_models import (
    MODELS,
    ModelRun,
    Rule,
    WalkModel,
    decides_contact,
    is_kinematic,
)
from zebro_lab.calibration.slip_argument import EXPECTED_SLIP, NamedSlip, parse_slip
from zebro_lab.files.errors import SettingsError
from zebro_lab.ground.ground_file import GroundFile, read_ground
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.walk.contacts import WalkContacts
from zebro_lab.walk.folder import INFORMED_MODEL
from zebro_lab.walk.informed_legs import InformedLegs, informed_legs
from zebro_lab.walk.notes import ground_notes
from zebro_lab.walk.request import ModelRequest


@dataclass(frozen=True)
class WalkedSegment:
    """A segment of a walked program, for a table.

    Attributes:
        what: Gait and turn, or "stand".
        cycles: Number of cycles; 0 of a stand.
        end: Time of its end [s].
    """

    what: str
    cycles: int
    end: float


@dataclass(frozen=True)
class WalkedLegs:
    """Leg angles to walk: those of a gait, a program or a log.

    Attributes:
        reference: The angles over time, from time zero on.
        duration: Time to walk [s].
        what: Name of gait, program or log, for titles.
        settings: Where they come from, JSON-serialisable, for the manifest.
        direction: Side that the gait turns to.
        rule: What the thesis's model follows where its listing and its text differ.
        exact: Whether the angles are exact, as in a walk folder: then only the floor of fitted
            walks applies, not their leg offsets.
        schedule: The max-plus system of a gait's events; None for others.
        segments: Of a program, where each segment ended.
        stances: Of a program, when each leg stands; None for others.
        files: Files that were read; by the hash of a log a walk that was fitted is recognised.
        notes: Notes, one line each.
    """

    reference: CyclicReference | SampledReference
    duration: float
    what: str
    settings: Mapping[str, object] = field(default_factory=dict)
    direction: Direction = "left"
    rule: Rule = "listing"
    exact: bool = False
    schedule: EventSystem | None = None
    segments: tuple[WalkedSegment, ...] = ()
    stances: Intervals | None = None
    files: tuple[Path, ...] = ()
    notes: tuple[str, ...] = ()


MOST_STEPS: Final = 500_000
"""Largest number of time steps; each takes about 1.1 kB while a path is computed and written."""


_KINEMATIC: Final = (
    "this walk is kinematics: contact detection keeps a rigid body on the legs, and the motion "
    "over the ground, which the thesis does not compute, is that without slip"
)


@dataclass(frozen=True)
class Walked:
    """A computed walk with what it was computed from.

    Attributes:
        path: Poses, leg angles, slip and forces over time.
        reference: Leg angles that the path was computed from.
        described: Parameters of the robot, with the requested arc; for the exact angles of a walk
            folder without leg signs and offsets.
        slip: Slip law of the legs; None for a model without slip.
        model: Name of the model.
        dt: Time step of the computation [s].
        title: Gait or log, model and slip law, for titles.
        notes: Notes, one line each.
        informed: Posterior of legs and floor that was used; None without fitted walks.
        ground: The ground as read; None for level ground.
        contact_by: What decides contact in the model: "force", "rest" (legs on which the robot
            rests), or the rule of the thesis's model.
        band: Paths with slip law, legs, floor and start drawn; None unless requested.
        schedule: The max-plus system of the gait's events; None for other gaits and for logs.
        segments: Of a program, where each segment ended; empty for others.
        stances: When each leg stands by a program's schedule [s]; None for others.
        contacts: Contact states and touchdowns; None unless requested.
    """

    path: WalkPath
    reference: LegReference
    described: RobotFile
    slip: NamedSlip | None
    model: str
    dt: float
    title: str
    notes: tuple[str, ...]
    informed: InformedLegs | None = None
    contact_by: str = "force"
    ground: GroundFile | None = None
    band: Poses | None = None
    schedule: EventSystem | None = None
    segments: tuple[WalkedSegment, ...] = ()
    stances: Intervals | None = None
    contacts: WalkContacts | None = None

    @property
    def heights(self) -> Ground:
        """Heights of the ground, level without a file of it."""
        return FLAT if self.ground is None else self.ground.ground

    @property
    def files(self) -> tuple[Path, ...]:
        """Files that were read of robot, slip law and ground."""
        robot = () if self.described.file is None else (self.described.file,)
        return (*robot, *(file for part in (self.slip, self.ground) if part for file in part.files))

    @property
    def settings(self) -> dict[str, object]:
        """Model, time step, slip law, doubts and ground for a manifest, JSON-serialisable."""
        slip = self.slip
        return {
            "model": self.model,
            "dt": self.dt,
            "slip": None if slip is None else {"named": slip.text, "source": slip.source},
            "doubts": list(self.doubts),
            **({} if self.ground is None else {"ground": self.ground.settings}),
        }

    @property
    def doubts(self) -> tuple[str, ...]:
        """Why the slip law or the fitted walks cannot be trusted, a warning for each."""
        return tuple(line for part in (self.slip, self.informed) if part for line in part.doubts)

    def delayed(self, delay: float) -> "Walked":
        """Return a copy with `delay` [s] added to times of path and band, not of `reference`."""
        path = replace(self.path, t=self.path.t + delay)
        return replace(self, path=path, band=self.band and self.band.delayed(delay))


def robot_of(request: ModelRequest) -> RobotFile:
    """Return the robot of `--robot`, else the thesis's robot.

    Raises:
        NotFound: The `robot.toml` of the request does not exist.
        SettingsError: The file has an invalid value.
    """
    return RobotFile() if request.robot is None else read_robot_file(request.robot)


def ground_of(request: ModelRequest) -> GroundFile | None:
    """Return the ground of `--ground`; None for level ground.

    Raises:
        ZebroLabError: As `read_ground`.
    """
    return None if request.ground is None else read_ground(request.ground)


def walk_with(
    request: ModelRequest,
    described: RobotFile,
    legs: WalkedLegs,
    *,
    ground: GroundFile | None = None,
) -> Walked:
    """Compute the path of a robot from its leg angles, from time zero on.

    Args:
        request: Model, slip law and time step.
        described: Parameters of the robot.
        legs: Leg angles over time.
        ground: The ground; None for level ground.

    Raises:
        SettingsError: The model needs a slip law and has none or one of another slip definition,
            there are too many time steps, or an option has an invalid value.
        NotFound, DataError: The slip law cannot be read.
        ModelError: The walk cannot be computed.
    """
    model = MODELS[request.model]
    kinematic = is_kinematic(request.model, legs.reference)
    slip, unused = _slip_for(model, request.slip, kinematic=kinematic)
    informed = None
    if slip is not None and slip.walks is not None and model.name == INFORMED_MODEL:
        same_legs = False if legs.exact else None
        informed = informed_legs(slip.walks, described, logs=legs.files, same_legs=same_legs)
    dt = time_step(request, model, informed)
    _require_steps(legs.duration, dt)
    run = ModelRun(
        described.robot, legs.reference, slip, legs.duration, dt, legs.direction, legs.rule,
        None if informed is None else informed.middle, FLAT if ground is None else ground.ground,
    )  # fmt: skip
    path = _run(run, model, slip)
    notes = [*legs.notes]
    if slip is not None and dt > model.dt:
        notes.append(f"in steps of {dt:g} s, longer than {model.dt:g} s, legs slip too much")
    if ground is not None:
        notes += ground_notes(ground, path, described.robot)
    notes += [*unused, *(note for part in (informed, slip) if part for note in part.notes)]
    grip = "" if slip is None else f", slip {slip.title}"
    how = " (kinematics by contact detection)" if kinematic else (
        " (by the thesis's text)" if legs.rule == "text" else ""
    )  # fmt: skip
    on = "" if request.ground is None else f", on {request.ground.name}"
    return Walked(
        path, legs.reference, described, slip, model.name, dt,
        f"{legs.what}, model '{model.name}'{how}{grip}{on}", tuple(notes), informed,
        decides_contact(run, model.name), ground, schedule=legs.schedule, segments=legs.segments,
        stances=legs.stances,
    )  # fmt: skip


def _slip_for(
    model: WalkModel, text: str | None, *, kinematic: bool
) -> tuple[NamedSlip | None, tuple[str, ...]]:
    """Parse `--slip` for a model; also return notes.

    Args:
        model: The walking model.
        text: Value of `--slip`; None if it was not given.
        kinematic: Whether the thesis's model walks without forces, as for gaits other than tripods.

    Returns:
        The slip law, None if the model does not use one; a note if `--slip` is given but not used,
        and one on kinematics.

    Raises:
        SettingsError: The model needs a slip law, and `--slip` is missing or invalid.
    """
    slip = None if text is None else parse_slip(text)
    if model.slips and not kinematic:
        if slip is None:
            raise SettingsError(f"missing: give {EXPECTED_SLIP}", key="--slip")
        return slip, ()
    notes = (_KINEMATIC,) if kinematic else ()
    if slip is not None:
        without = "its kinematics have" if kinematic else "has"
        notes += (f"the model '{model.name}': {without} no slip, --slip {slip.text} is not used",)
    return None, notes


def time_step(request: ModelRequest, model: WalkModel, informed: InformedLegs | None) -> float:
    """Return `--dt` if given, else the model's time step, for fitted legs at most `FINE.dt` [s].

    Args:
        request: The options.
        model: The walking model.
        informed: What fitted walks say of legs and floor; None without.
    """
    dt = model.dt if request.dt is None else request.dt
    return min(dt, FINE.dt) if informed is not None and request.dt is None else dt


def _run(run: ModelRun, model: WalkModel, slip: NamedSlip | None) -> WalkPath:
    """Run the model; raise `SettingsError` for a slip law of a definition that it cannot take."""
    try:
        return model.run(run)
    except DefinitionMismatch as error:
        raise SettingsError(
            f"was fitted to '{error.found}' slip, but the thesis's model takes '{error.expected}' "
            f"slip; calibrate again with --slip-definition {error.expected}, or use --model "
            "dynamics, which converts",
            file=None if slip is None else slip.text,
        ) from error


def _require_steps(duration: float, dt: float) -> None:
    """Raise `SettingsError` unless the walk has more than 1 and at most `MOST_STEPS` steps."""
    if not (dt > 0 and duration > dt and np.isfinite(duration)):
        raise SettingsError(
            f"found a walk of {duration:g} s in steps of {dt:g} s; expected a step above 0 and a "
            "finite duration longer than one step (predict takes that of its leg log)",
            key="--duration, --dt",
        )
    if duration / dt > MOST_STEPS:
        raise SettingsError(
            f"{duration:g} s in steps of {dt:g} s is {duration / dt:.3g} steps; at most "
            f"{MOST_STEPS:,} are walked, which take 1 GB of memory: shorten the walk (for predict "
            "its leg log), or lengthen --dt",
            key="--duration, --dt",
        )
