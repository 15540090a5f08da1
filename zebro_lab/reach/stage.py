# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab reach`: plan both ways to each goal, walk them, and write the folder."""

import shlex
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from model.errors import DomainError
from model.routes.goal import Goal
from model.routes.manoeuvre import Fitted, Stepping, Surroundings
from model.routes.reach import NOTHING, Stride, curve, measured_stride, stop_turn_walk
from model.tasks import Watcher
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import require_replaceable, result_folder
from zebro_lab.reach.folder import (
    PICTURE,
    REACH,
    TABLE,
    draw_ways,
    program_name,
    program_text,
    write_table,
)
from zebro_lab.reach.request import ReachRequest, SteppingRequest, parse_goal
from zebro_lab.reach.way import CURVE, STOP_TURN_WALK, Way, named
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.program_file import CYCLE, even_times, groups_of
from zebro_lab.walk.program_stage import laid_out, surroundings_of
from zebro_lab.walk.request import ModelRequest
from zebro_lab.walk.walking import Walked, ground_of, robot_of, walk_with


@dataclass(frozen=True)
class ReachResult:
    """Ways to goals.

    Attributes:
        goals: The goals.
        ways: The ways that were walked, goal by goal.
        stride: How far a stride leads.
        title: Gait, model and slip law, for titles.
        notes: Notes of the walks, one line each.
    """

    goals: tuple[Goal, ...]
    ways: tuple[Way, ...]
    stride: Stride
    title: str
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _Walking:
    """What all ways are planned and walked with."""

    request: ReachRequest
    model: ModelRequest
    described: RobotFile
    stepping: Stepping
    around: Surroundings
    stride: Stride


def reach(request: ReachRequest, watcher: Watcher) -> ReachResult:
    """Plan both ways to each goal, walk them, and write table, programs and picture.

    Args:
        request: Goals, gait, slip law, robot and output folder.
        watcher: Receives progress, and may request a stop.

    Raises:
        ZebroLabError: An option or file is invalid, the folder cannot be replaced, or a stop was
            requested.
        ModelError: The gait is impossible, or a walk diverged.
    """
    goals, model = tuple(parse_goal(text) for text in request.goal), request.model
    require_replaceable(request.out, REACH, inputs=model.inputs)
    walking = _walking(request, model, watcher)
    planned = _planned(goals, walking, watcher)
    content: dict[str, object] = {}  # of the manifest, which is written last
    with result_folder(request.out, REACH, content=content) as draft:
        ways = tuple(
            _walked(draft, number, goals, manoeuvre, plan, walking, watcher)
            for number, manoeuvre, plan in planned
        )
        walked = ways[0].walked
        content |= _content(request, goals, walked)
        notes = tuple(dict.fromkeys(note for way in ways for note in way.walked.notes))
        slip = "" if walked.slip is None else walked.slip.title
        title = f"{request.stepping.gait}, model 'dynamics', slip {slip}"
        reached = ReachResult(goals, ways, walking.stride, title, notes)
        write_table(draft / TABLE, ways)
        watcher.step("drawing", None)
        draw_ways(
            draft / f"{PICTURE}.{request.form}", ways, walking.described.robot,
            title=f"Ways to goals: {title}",
        )  # fmt: skip
    return reached


def _walking(request: ReachRequest, model: ModelRequest, watcher: Watcher) -> _Walking:
    """Read the files of a request, and measure a stride; `SettingsError` without a slip law."""
    if request.slip is None:
        raise SettingsError("missing: legs slip; name a slip law", key="--slip")
    described, ground = robot_of(model), ground_of(model)
    stepping = stepping_of(request.stepping, described.robot.leg_arc)
    around = surroundings_of(parse_slip(request.slip), model, described, ground)
    watcher.step("measuring a stride", None)
    return _Walking(request, model, described, stepping, around, measured_stride(stepping, around))


def stepping_of(request: SteppingRequest, leg_arc: float) -> Stepping:
    """Return gait, times and angles of a request.

    Args:
        request: The options.
        leg_arc: Angle of the legs' arc [rad].

    Raises:
        SettingsError: The gait is unknown.
    """
    try:
        groups = groups_of(request.gait)
    except DomainError as error:
        raise SettingsError(str(error), key="--gait") from error
    ground, flight = even_times(CYCLE if request.cycle is None else request.cycle, groups)
    up = request.liftoff_deg
    return Stepping(
        groups,
        ground_time=ground if request.tau_ground is None else request.tau_ground,
        flight_time=flight if request.tau_flight is None else request.tau_flight,
        double_stance=request.tau_double,
        touchdown=float(np.radians(request.touchdown_deg)),
        liftoff=None if up is None else float(np.radians(up)),
        leg_arc=leg_arc,
    )  # fmt: skip


def _planned(
    goals: Sequence[Goal], walking: _Walking, watcher: Watcher
) -> list[tuple[int, str, Fitted]]:
    """Plan both ways to each goal: number of the goal from 1, name of the manoeuvre, plan.

    Raises:
        SettingsError: The robot is at a goal already.
        WalkStopped: A stop was requested.
    """
    planners = {STOP_TURN_WALK: stop_turn_walk, CURVE: curve}
    found = []
    for number, goal in enumerate(goals, start=1):
        for k, (manoeuvre, plan) in enumerate(planners.items()):
            watcher.step("planning ways", (number - 1 + k / len(planners)) / len(goals))
            if watcher.stop_requested():
                raise WalkStopped("stopped; nothing was written")
            way = plan(goal, walking.stride, walking.stepping, walking.around)
            if way is None:
                raise SettingsError(
                    f"goal {number} ({named(goal)}) is where the robot is; expected one more than "
                    f"{1000 * NOTHING * walking.stride.length:.1g} mm away", key="--goal",
                )  # fmt: skip
            found.append((number, manoeuvre, way))
    return found


def _walked(
    folder: Path, number: int, goals: Sequence[Goal], manoeuvre: str, plan: Fitted,
    walking: _Walking, watcher: Watcher,
) -> Way:  # fmt: skip
    """Write a plan's program and walk it, as `zebro-lab walk` does."""
    request, model = walking.request, walking.model
    name = program_name(number, manoeuvre, goals=len(goals))
    file = folder / name
    about = [
        f"{manoeuvre} to {named(goals[number - 1])}, planned by zebro-lab reach (simulated)",
        f"zebro-lab walk {name} {_options(request)}",
    ]
    text = program_text(plan.parts, walking.stepping, request.stepping, about=about)
    file.write_text(text, encoding="utf-8")
    ground = ground_of(model)
    legs = laid_out(file, model, walking.described, watcher, ground=ground)
    walked = walk_with(model, walking.described, legs, ground=ground)
    return Way(number, goals[number - 1], manoeuvre, plan.parts, walked, name)


def _options(request: ReachRequest) -> str:
    """Return the options with which `walk` walks a program as it was planned."""
    given = {"--slip": request.slip, "--robot": request.robot,
             "--dt": request.dt, "--ground": request.ground}  # fmt: skip
    return shlex.join(
        word for name, value in given.items() if value is not None for word in (name, str(value))
    )


def _content(request: ReachRequest, goals: Sequence[Goal], walked: Walked) -> dict[str, object]:
    """Return source, settings and hashes of inputs for the manifest."""
    settings = {
        "goals": [asdict(goal) for goal in goals],
        "gait": asdict(request.stepping),
        **walked.settings,
    }
    return {
        "source": f"sim:{walked.model}", "settings": settings, "inputs": file_hashes(walked.files)
    }  # fmt: skip
