# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab walk`: construct a gait or program, compute and write its path."""

from concurrent.futures import Executor
from dataclasses import replace

from model.tasks import Watcher
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.robot.gait_argument import make_gait
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.asked import AskedWalk
from zebro_lab.walk.band import predict_band
from zebro_lab.walk.folder import WALKED
from zebro_lab.walk.output import write_walk
from zebro_lab.walk.program_stage import laid_out
from zebro_lab.walk.request import WalkRequest
from zebro_lab.walk.shown_time import require_shown_times
from zebro_lab.walk.walking import (
    Walked,
    ground_of,
    robot_of,
    speed_warnings,
    walk_with,
    with_contacts,
)
from zebro_lab.workers import open_executor


def walk(request: WalkRequest, watcher: Watcher) -> Walked:
    """Simulate a gait and write the walk folder.

    Args:
        request: Gait and duration, or program; model, band and output folder.
        watcher: Receives progress, and may request a stop.

    Returns:
        The walk with its notes.

    Raises:
        ZebroLabError: An option or file is invalid, a scheduler cannot be used, the folder cannot
            be replaced, or a stop was requested.
        ModelError: The gait is impossible, or the walk cannot be computed.
    """
    with open_executor(request.model.band.workers) as executor:  # a wrong address is told at once
        return _walk(request, watcher, executor)


def _walk(request: WalkRequest, watcher: Watcher, executor: Executor | None) -> Walked:
    inputs = request.model.inputs if request.program is None else (
        request.program, *request.model.inputs
    )  # fmt: skip
    require_replaceable(request.out, WALKED["walk"], inputs=inputs)
    described, ground = robot_of(request.model), ground_of(request.model)
    asked = _gait(request, described) if request.program is None else laid_out(
        request.program, request.model, described, watcher, ground=ground
    )  # fmt: skip
    watcher.step("walking", None)
    duration, pictures = asked.duration, request.model.pictures
    require_shown_times(pictures.snapshots, pictures.window, 0.0, duration)
    walked = walk_with(
        request.model, described, asked.reference, duration=duration, what=asked.what,
        direction=asked.direction, rule=request.thesis, ground=ground,
        notes=(*asked.notes, *speed_warnings(asked.reference, described.leg_speed_limit)),
    )  # fmt: skip
    if request.model.band.draws:
        band = predict_band(
            request.model.band, walked, asked.reference,
            duration=duration, watcher=watcher, executor=executor,
        )  # fmt: skip
        walked = replace(walked, band=band)
    walked = replace(
        walked, schedule=asked.schedule, segments=asked.segments, stances=asked.stances
    )
    walked = with_contacts(walked, request.model.contact, watcher)
    write_walk(
        request.out, request.model, walked, watcher, kind="walk", settings=asked.settings,
        files=asked.files,
    )  # fmt: skip
    return walked


def _gait(request: WalkRequest, described: RobotFile) -> AskedWalk:
    if request.duration is None:
        raise SettingsError("missing: the duration of the walk [s]", key="--duration")
    gait = make_gait(request.gait, leg_arc=described.robot.leg_arc)
    settings = {
        "gait": {"name": request.gait.name, **request.gait.given()},
        "duration": request.duration,
        "direction": gait.direction,
    }
    return AskedWalk(
        gait.reference, request.duration, gait.what, settings, direction=gait.direction,
        schedule=gait.schedule,
    )  # fmt: skip
