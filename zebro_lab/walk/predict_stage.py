# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab predict`: read leg angles, compute the path, write the walk folder."""

from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

import numpy as np

from model.gait.inexact_log import InexactLog
from model.robot import N_LEGS
from model.tasks import Watcher
from zebro_lab.files.names import PATH_CSV, is_ros_log
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.files.source_names import is_simulated
from zebro_lab.robot.leg_warnings import leg_warnings
from zebro_lab.robot.robot_file import ROBOT_FILE, RobotFile
from zebro_lab.runs.legs import LegNames, read_leg_log
from zebro_lab.runs.recorded_walk import is_recorded
from zebro_lab.terminal.leg_options import joint_names
from zebro_lab.walk.band import predict_band
from zebro_lab.walk.folder import PREDICTION, WALKED
from zebro_lab.walk.leg_angles import angles_from
from zebro_lab.walk.output import write_walk
from zebro_lab.walk.request import PredictRequest
from zebro_lab.walk.shown_time import require_shown_times
from zebro_lab.walk.walking import Walked, ground_of, robot_of, walk_with, with_contacts
from zebro_lab.workers import open_executor


def prediction_folder(request: PredictRequest) -> Path:
    """Return `--out` if given, else RUN/prediction if a run is read, else `prediction`."""
    if request.out is not None:
        return request.out
    return request.log / PREDICTION if is_recorded(request.log) else Path(PREDICTION)


def predict(request: PredictRequest, watcher: Watcher) -> Walked:
    """Predict the path from measured leg angles and write the walk folder.

    The path has the log's time base. The robot is that of the request, else the `robot.toml` of the
    run, else the thesis's robot; for the exact angles of a walk folder, without its leg signs and
    offsets.

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
        return _predict(request, watcher, executor)


def _predict(request: PredictRequest, watcher: Watcher, executor: Executor | None) -> Walked:
    recover(request.log)
    request = with_own_robot(request)
    out = prediction_folder(request)
    require_replaceable(out, WALKED["predict"], inputs=request.inputs)
    described, is_walk = robot_of(request.model), is_walk_folder(request.log)
    ground = ground_of(request.model)
    if is_walk:
        described = without_offsets(described)
    log = read_leg_log(
        request.log, columns=request.columns, leg_sign=described.leg_sign,
        names=LegNames(joint_names(request.joints), request.topic),
    )  # fmt: skip
    suspected = leg_warnings(
        log.reference, leg_offset=described.robot.leg_offset, columns=log.columns_file
    )
    start, end = float(log.reference.t[0]), float(log.reference.t[-1])
    pictures = request.model.pictures
    require_shown_times(pictures.snapshots, pictures.window, start, end)
    legs, notes = angles_from(log, start)
    watcher.step("walking", None)
    walked = walk_with(
        request.model,
        described,
        legs.smooth() if isinstance(legs, InexactLog) else legs,
        duration=end - start,
        what=f"{'simulated' if is_simulated(log.source) else 'logged'} leg angles",
        direction=request.direction,
        logs=log.files,
        angles_are_true=is_walk,
        ground=ground,
        notes=(*log.notes, *notes, *suspected),
    )
    if request.model.band.draws:
        band = predict_band(
            request.model.band, walked, legs,
            duration=end - start, watcher=watcher, executor=executor,
        )  # fmt: skip
        walked = replace(walked, band=band)
    walked = with_contacts(walked.delayed(start), request.model.contact, watcher)
    write_walk(
        out, request.model, walked, watcher, kind="predict", files=log.files,
        settings={"leg_angles": log.source, "direction": request.direction},
    )  # fmt: skip
    return walked


def with_own_robot(request: PredictRequest) -> PredictRequest:
    """Return a request with the `robot.toml` of the run it reads, if it names no other."""
    own = request.log / ROBOT_FILE
    if request.model.robot is not None or not is_recorded(request.log) or not own.is_file():
        return request
    return replace(request, model=replace(request.model, robot=own))


def is_walk_folder(log: Path) -> bool:
    """Return whether leg angles are read from a walk folder: a folder or `path.csv`, no run."""
    return (log.is_dir() or log.name == PATH_CSV) and not (is_recorded(log) or is_ros_log(log))


def without_offsets(described: RobotFile) -> RobotFile:
    """Return the robot with leg signs 1 and leg offsets 0: angles in a walk folder are exact."""
    robot = replace(described.robot, leg_offset=np.zeros(N_LEGS))
    return replace(described, robot=robot, leg_sign=(1,) * N_LEGS)
