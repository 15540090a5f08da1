# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab walk`: construct a gait, compute the path, write the walk folder."""

from dataclasses import replace
from pathlib import Path

from model.progress import Watcher
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.robot.gait_argument import make_gait
from zebro_lab.robot.robot_file import render_robot_file
from zebro_lab.walk.folder import WALKED
from zebro_lab.walk.output import write_walk
from zebro_lab.walk.path_band import predict_band
from zebro_lab.walk.request import ModelRequest, WalkRequest
from zebro_lab.walk.shown_time import require_shown_times
from zebro_lab.walk.walking import Walked, robot_of, walk_with


def walk(request: WalkRequest, watcher: Watcher) -> Walked:
    """Simulate a gait and write the walk folder.

    Args:
        request: Gait, model, duration, band and output folder.
        watcher: Receives progress, and may request a stop.

    Returns:
        The walk with its notes.

    Raises:
        ZebroLabError: An option or file is invalid, the folder cannot be replaced, or a stop was
            requested.
        ModelError: The gait is impossible, or the walk cannot be computed.
    """
    if request.duration is None:
        raise SettingsError("missing: the duration of the walk [s]", key="--duration")
    require_replaceable(request.out, WALKED["walk"], inputs=request.model.inputs)
    described = robot_of(request.model)
    gait = make_gait(request.gait, leg_arc=described.robot.leg_arc)
    watcher.step("walking", None)
    duration, pictures = request.duration, request.model.pictures
    require_shown_times(pictures.snapshots, pictures.window, 0.0, duration)
    walked = walk_with(
        request.model, described, gait.reference,
        duration=duration, what=gait.what, direction=gait.direction,
    )  # fmt: skip
    if request.model.band.draws:
        band = predict_band(
            request.model.band, walked, gait.reference,
            duration=duration, toe=request.model.toe, watcher=watcher,
        )  # fmt: skip
        walked = replace(walked, band=band)
    walked = replace(walked, schedule=gait.schedule)
    settings = {
        "gait": {"name": request.gait.name, **request.gait.given()},
        "duration": duration,
        "direction": gait.direction,
    }
    write_walk(request.out, request.model, walked, watcher, kind="walk", settings=settings)
    return walked


def write_robot(file: Path, request: ModelRequest) -> Path:
    """Write the robot of a request as a commented `robot.toml`, as a template for editing.

    Args:
        file: File to write; it must not exist.
        request: Options `--robot` and `--arc-deg`; without them the thesis's robot is written.

    Returns:
        The file written.

    Raises:
        AlreadyExists: The file to write exists.
        NotFound: The file of `--robot` does not exist.
        SettingsError: The robot file or the arc has an invalid value.
    """
    if file.exists():
        raise AlreadyExists(f"{file} exists already; edit it, or choose another file name")
    return atomic_write_text(file, render_robot_file(robot_of(request)))
