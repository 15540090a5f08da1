# SPDX-License-Identifier: MIT
"""Stages of `walk` and `predict`: leg angles of a gait, a program or a log to a walk folder."""

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference
from model.robot import N_LEGS
from model.tasks import Watcher
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.names import PATH_CSV, is_ros_log
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.files.source_names import is_simulated
from zebro_lab.ground.ground_file import GroundFile
from zebro_lab.robot.gait_argument import make_gait
from zebro_lab.robot.leg_warnings import leg_warnings
from zebro_lab.robot.robot_file import ROBOT_FILE, RobotFile
from zebro_lab.runs.legs import LegNames, read_leg_log
from zebro_lab.runs.recorded_walk import is_recorded
from zebro_lab.terminal.leg_options import joint_names
from zebro_lab.walk.band import in_the_middle, predict_band
from zebro_lab.walk.contacts import contacts_of
from zebro_lab.walk.folder import PREDICTION, WALKED
from zebro_lab.walk.leg_angles import angles_from
from zebro_lab.walk.notes import speed_warnings
from zebro_lab.walk.output import write_walk
from zebro_lab.walk.program_stage import laid_out
from zebro_lab.walk.request import ModelRequest, PredictRequest, WalkRequest
from zebro_lab.walk.shown_time import require_shown_times
from zebro_lab.walk.walking import (
    Walked,
    WalkedLegs,
    ground_of,
    robot_of,
    walk_with,
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
    model = request.model
    with open_executor(model.band.workers) as executor:  # a wrong address is told at once
        inputs = (*(() if request.program is None else (request.program,)), *model.inputs)
        require_replaceable(request.out, WALKED["walk"], inputs=inputs)
        described, ground = robot_of(model), ground_of(model)
        if request.program is None:
            legs = _gait(request, described)
        else:
            legs = laid_out(request.program, model, described, watcher, ground=ground)
        walking = _Walking("walk", request.out, model, described, ground, watcher, executor)
        return _walked(walking, legs, legs.reference)


def _gait(request: WalkRequest, described: RobotFile) -> WalkedLegs:
    """Return the leg angles of the requested gait, with warnings on their speed.

    Raises:
        SettingsError: The duration is missing.
        ModelError: The gait is impossible.
    """
    if request.duration is None:
        raise SettingsError("missing: the duration of the walk [s]", key="--duration")
    gait = make_gait(request.gait, leg_arc=described.robot.leg_arc)
    settings = {
        "gait": {"name": request.gait.name, **request.gait.given()},
        "duration": request.duration,
        "direction": gait.direction,
    }
    return WalkedLegs(
        gait.reference, request.duration, gait.what, settings, direction=gait.direction,
        rule=request.thesis, schedule=gait.schedule,
        notes=speed_warnings(gait.reference, described.leg_speed_limit),
    )  # fmt: skip


def prediction_folder(request: PredictRequest) -> Path:
    """Return `--out` if given, else RUN/prediction if a run is read, else `prediction`."""
    if request.out is not None:
        return request.out
    return request.log / PREDICTION if is_recorded(request.log) else Path(PREDICTION)


def predict(request: PredictRequest, watcher: Watcher) -> Walked:
    """Predict the path from measured leg angles and write the walk folder.

    The path has the log's time base. The robot is that of the request, else the `robot.toml` of the
    run, else the thesis's robot; for the exact angles of a walk folder, with leg signs of 1 and
    offsets of 0.

    Args:
        request: Leg log, model, band and output folder.
        watcher: Receives progress, and may request a stop.

    Returns:
        The predicted walk with its notes.

    Raises:
        ZebroLabError: A file is missing or has invalid content, the folder cannot be replaced, or
            a scheduler cannot be used.
        WalkStopped: The watcher requested a stop; nothing was written.
        ModelError: The walk cannot be computed.
    """
    with open_executor(request.model.band.workers) as executor:  # a wrong address is told at once
        recover(request.log)
        request = with_own_robot(request)
        out = prediction_folder(request)
        require_replaceable(out, WALKED["predict"], inputs=request.inputs)
        described, exact = robot_of(request.model), is_walk_folder(request.log)
        ground = ground_of(request.model)
        if exact:
            described = without_offsets(described)
        walking = _Walking("predict", out, request.model, described, ground, watcher, executor)
        return _walked_log(request, walking, exact=exact)


def _walked_log(request: PredictRequest, walking: "_Walking", *, exact: bool) -> Walked:
    """Read a leg log and walk its angles."""
    described = walking.described
    log = read_leg_log(
        request.log, columns=request.columns, leg_sign=described.leg_sign,
        names=LegNames(joint_names(request.joints), request.topic),
    )  # fmt: skip
    suspected = leg_warnings(
        log.reference, leg_offset=described.robot.leg_offset, columns=log.columns_file
    )
    start, end = float(log.reference.t[0]), float(log.reference.t[-1])
    angles, notes = angles_from(log, start)
    legs = WalkedLegs(
        angles.smooth() if isinstance(angles, InexactLog) else angles,
        end - start,
        f"{'simulated' if is_simulated(log.source) else 'logged'} leg angles",
        {"leg_angles": log.source, "direction": request.direction},
        direction=request.direction,
        exact=exact,
        files=log.files,
        notes=(*log.notes, *notes, *suspected),
    )
    return _walked(walking, legs, angles, start=start)


@dataclass(frozen=True)
class _Walking:
    """What a walk is computed and written with, whatever its leg angles."""

    kind: str
    out: Path
    request: ModelRequest
    described: RobotFile
    ground: GroundFile | None
    watcher: Watcher
    executor: Executor | None


def _walked(
    walking: _Walking, legs: WalkedLegs, angles: LegReference | InexactLog, *, start: float = 0.0
) -> Walked:
    """Walk; compute band and contacts if they are requested; and write the folder.

    Args:
        walking: Options, robot, ground and folder.
        legs: The leg angles, from time zero on.
        angles: The same; for a log with encoder counts or noise, the log itself, from which
            possible angles are drawn for the band.
        start: Time of the first sample in the folder [s].
    """
    request, watcher = walking.request, walking.watcher
    pictures = request.pictures
    require_shown_times(pictures.snapshots, pictures.window, start, start + legs.duration)
    watcher.step("walking", None)
    walked = walk_with(request, walking.described, legs, ground=walking.ground)
    if request.band.draws:
        band = predict_band(
            request.band, walked, angles,
            duration=legs.duration, watcher=watcher, executor=walking.executor,
        )  # fmt: skip
        told = walked.informed is not None  # else every unknown is at its central value already
        walked = in_the_middle(walked, band) if told else replace(walked, band=band)
    if start:
        walked = walked.delayed(start)
    if pictures.contacts:
        watcher.step("finding contacts", None)
        contacts = contacts_of(
            walked.path, walked.reference, by=walked.contact_by, stances=walked.stances
        )
        walked = replace(walked, contacts=contacts)
    write_walk(
        walking.out, request, walked, watcher, kind=walking.kind, settings=legs.settings,
        files=legs.files,
    )  # fmt: skip
    return walked


def with_own_robot(request: PredictRequest) -> PredictRequest:
    """Return a request with the `robot.toml` of the run it reads, if it names no other."""
    own = request.log / ROBOT_FILE
    if request.model.robot is not None or not is_recorded(request.log) or not own.is_file():
        return request
    return replace(request, model=replace(request.model, robot=own))


def is_walk_folder(log: Path) -> bool:
    """Return whether leg angles are read from a walk folder.

    That is a folder or a file `path.csv` that is neither a recorded run nor a ROS log.
    """
    return (log.is_dir() or log.name == PATH_CSV) and not (is_recorded(log) or is_ros_log(log))


def without_offsets(described: RobotFile) -> RobotFile:
    """Return the robot with leg signs 1 and leg offsets 0: angles in a walk folder are exact."""
    robot = replace(described.robot, leg_offset=np.zeros(N_LEGS))
    return replace(described, robot=robot, leg_sign=(1,) * N_LEGS)
