# SPDX-License-Identifier: MIT
"""Compute the leg angles of a walking program, walking it where a segment ends at a place."""

from dataclasses import asdict
from pathlib import Path

import numpy as np

from model.leg_state import corrected
from model.robot import GRAVITY
from model.routes.manoeuvre import Surroundings
from model.routes.program import lay_out
from model.tasks import Watcher
from model.walk.bend import STRAIGHT
from model.walk.dynamics import DynamicsOptions
from model.walk.ground import FLAT, Ground
from model.walk_models import MODELS
from zebro_lab.calibration.slip_argument import NamedSlip, parse_slip
from zebro_lab.files.errors import SettingsError
from zebro_lab.ground.ground_file import GroundFile
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.informed_legs import informed_legs
from zebro_lab.walk.notes import speed_warnings
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.program_file import Program, read_program
from zebro_lab.walk.request import ModelRequest
from zebro_lab.walk.walking import MOST_STEPS, WalkedLegs, WalkedSegment, time_step

_MISSED = np.radians(1.0)  # a miss that is told of
_WALKS = "dynamics"  # the model that finds where segments end


def laid_out(
    file: Path,
    request: ModelRequest,
    described: RobotFile,
    watcher: Watcher,
    *,
    ground: GroundFile | None = None,
) -> WalkedLegs:
    """Read a program and compute its leg angles.

    Args:
        file: The `program.toml`.
        request: Model, slip law with what fitted walks say of legs and floor, and time step,
            with which headings and places are found.
        described: The robot.
        watcher: Receives progress.
        ground: The ground; None for level ground.

    Raises:
        NotFound: There is no such file.
        SettingsError: The program is invalid, or a segment ends at a heading or a place and the
            model is not "dynamics".
        WalkStopped: A stop was requested.
        ModelError: A gait is impossible, a segment does not end, the program is too long, or the
            walk diverged.
    """
    program = read_program(file, leg_arc=described.robot.leg_arc)
    slip = _slip(program, request)
    around = _unwalked(request, described, ground) if slip is None else surroundings_of(
        slip, request, described, ground
    )  # fmt: skip

    def progress(share: float) -> None:
        """Show the share that is done; raise `WalkStopped` if a stop is requested."""
        watcher.step("laying out the program", share)
        if watcher.stop_requested():
            raise WalkStopped("stopped; nothing was written")

    legs, ends = lay_out(
        program.segments, around.robot, around.table, options=around.options,
        ground=around.ground, bend=around.bend, longest=MOST_STEPS * around.options.dt,
        progress=progress,
    )  # fmt: skip
    segments = tuple(
        WalkedSegment(what, end.cycles, end.end)
        for what, end in zip(program.names, ends, strict=True)
    )
    missed = tuple(
        f"WARNING: segment {number} turns by {np.degrees(end.missed):+.1f} deg more than asked "
        "for: the heading jumps as legs lift off; ask for another heading, or steer nearer to 1"
        for number, end in enumerate(ends, start=1)
        if abs(end.missed) > _MISSED
    )
    settings = {"program": str(file), "duration": legs.end,
                "segments": [asdict(each) for each in segments]}  # fmt: skip
    reference = legs.reference()
    return WalkedLegs(
        reference, legs.end, _named(file), settings, segments=segments,
        stances=legs.stance_intervals(), files=(file,),
        notes=(*missed, *speed_warnings(reference, described.leg_speed_limit)),
    )  # fmt: skip


def _named(file: Path) -> str:
    """Return the name of a program for titles, which says once that it is one.

    >>> _named(Path("garden.toml")), _named(Path("program.toml"))
    ("program 'garden'", 'program')
    """
    return "program" if file.stem == "program" else f"program '{file.stem}'"


def _slip(program: Program, request: ModelRequest) -> NamedSlip | None:
    """Return the slip law with which headings and places are found; None if no segment has one.

    Raises:
        SettingsError: A segment has one, and the model is not "dynamics" or the slip law is missing
            or invalid.
    """
    if not program.needs_walking:
        return None
    if request.model != _WALKS or request.slip is None:
        raise SettingsError(
            f"'{request.model}' does not find where a segment of {program.file} ends, at a heading "
            f"or a place; expected '{_WALKS}', or segments that end after strides or a time",
            key="--model",
        )
    return parse_slip(request.slip)


def surroundings_of(
    slip: NamedSlip, request: ModelRequest, described: RobotFile, ground: GroundFile | None
) -> Surroundings:
    """Return robot, slip law, time step and ground for walking a program to find where it ends.

    Where the slip law has fitted walks, these correct the robot's legs and the traction.

    Args:
        slip: The slip law.
        request: The time step.
        described: The robot.
        ground: The ground; None for level ground.

    Raises:
        ModelError: The slip law loses its shape at the robot's loads.
    """
    informed = None if slip.walks is None else informed_legs(slip.walks, described)
    options = DynamicsOptions(dt=time_step(request, MODELS[_WALKS], informed))
    weight = described.robot.mass * GRAVITY
    law = slip.traction_table(weight=weight)
    robot, bend = described.robot, STRAIGHT
    if informed is not None:
        robot, law, bend = corrected(robot, law, informed.middle)
    return Surroundings(robot, law, options, _heights(ground), bend)


def _unwalked(
    request: ModelRequest, described: RobotFile, ground: GroundFile | None
) -> Surroundings:
    """Return robot, time step and ground, without slip law, for a program that needs no walking."""
    options = DynamicsOptions(dt=time_step(request, MODELS[request.model], None))
    return Surroundings(described.robot, None, options, _heights(ground))


def _heights(ground: GroundFile | None) -> Ground:
    """Return the heights of a ground; level ground for None."""
    return FLAT if ground is None else ground.ground
