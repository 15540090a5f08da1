# SPDX-License-Identifier: MIT
"""Compute the leg angles of a walking program, walking it where a segment ends at a place."""

from dataclasses import asdict
from pathlib import Path

import numpy as np

from model.progress import Watcher
from model.robot import GRAVITY
from model.walk.areas import AreaTractions, with_areas
from model.walk.dynamics import DynamicsOptions
from model.walk.program import lay_out
from model.walk.terrain import LEVEL, Terrain
from model.walk.traction import TractionTable
from model.walk_models import MODELS
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.errors import SettingsError
from zebro_lab.ground.ground_file import GroundFile
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.asked import AskedWalk, WalkedSegment
from zebro_lab.walk.program_file import Program, read_program
from zebro_lab.walk.request import ModelRequest

_MISSED = np.radians(1.0)  # a miss that is told of
_WALKS = "dynamics"  # the model that finds where segments end


def laid_out(
    file: Path,
    request: ModelRequest,
    described: RobotFile,
    watcher: Watcher,
    *,
    ground: GroundFile | None = None,
) -> AskedWalk:
    """Read a program and compute its leg angles.

    Args:
        file: The `program.toml`.
        request: Model, slip law, toe law and time step, with which headings and places are found.
        described: The robot.
        watcher: Receives progress.
        ground: The ground and its areas; None for level ground of one slip law.

    Raises:
        NotFound: There is no such file.
        SettingsError: The program is invalid, or a segment ends at a heading or a place and the
            model is not "dynamics".
        ModelError: A gait is impossible, a segment does not end, or the walk diverged.
    """
    robot = described.robot
    program = read_program(file, leg_arc=robot.leg_arc)
    terrain = LEVEL if ground is None else ground.terrain
    table, notes = _table(program, request, described, terrain)
    legs, ends = lay_out(
        program.segments, robot, table,
        options=DynamicsOptions(dt=request.dt or MODELS[_WALKS].dt), ground=terrain.ground,
        progress=lambda share: watcher.step("laying out the program", share),
    )  # fmt: skip
    segments = tuple(
        WalkedSegment(what, end.cycles, end.end)
        for what, end in zip(program.names, ends, strict=True)
    )
    missed = tuple(
        f"WARNING: segment {number} turns by {np.degrees(end.missed):+.1f} deg more than asked "
        "for: legs that stand turn the robot however short the last steps are; ask for another "
        "heading, or steer nearer to 1"
        for number, end in enumerate(ends, start=1)
        if abs(end.missed) > _MISSED
    )
    settings = {"program": str(file), "duration": legs.end,
                "segments": [asdict(each) for each in segments]}  # fmt: skip
    return AskedWalk(
        legs.reference(), legs.end, f"program {file.stem}", settings, segments=segments,
        files=(file,), notes=(*notes, *missed),
    )  # fmt: skip


def _table(
    program: Program, request: ModelRequest, described: RobotFile, terrain: Terrain
) -> tuple[TractionTable | AreaTractions | None, tuple[str, ...]]:
    """Return the slip law that headings and places are found with, if any is needed, and notes."""
    if not program.needs_walking:
        return None, ()
    if request.model != _WALKS or request.slip is None:
        raise SettingsError(
            f"'{request.model}' does not find where a segment of {program.file} ends, at a heading "
            f"or a place; expected '{_WALKS}', or segments that end after strides or a time",
            key="--model",
        )
    slip = parse_slip(request.slip)
    weight = described.robot.mass * GRAVITY
    note = (
        "headings and places at which segments end were found without what the walks of the "
        "calibration say of legs and floor"
    )
    notes = () if slip.walks is None else (note,)
    law = slip.traction_table(weight=weight, toe=request.toe)
    return with_areas(law, terrain.tabulated(weight=weight, toe=request.toe)), notes
