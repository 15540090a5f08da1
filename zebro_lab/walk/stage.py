# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab walk`: construct a gait, compute the path, write the walk folder."""

from dataclasses import dataclass, replace
from pathlib import Path

from model.progress import Watcher
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.robot.gait_argument import GaitRequest, make_gait
from zebro_lab.robot.robot_file import render_robot_file
from zebro_lab.walk.folder import WALKED
from zebro_lab.walk.output import write_walk
from zebro_lab.walk.path_band import BandRequest, predict_band
from zebro_lab.walk.walking import ModelRequest, Walked, robot_of, walk_with


@dataclass(frozen=True)
class WalkRequest:
    """Settings of a walk.

    Attributes:
        gait: The gait.
        model: Model, slip law, robot, and what to write.
        duration: Duration of the walk [s].
        band: Settings of the band; None for the path alone.
    """

    gait: GaitRequest
    model: ModelRequest
    duration: float
    band: BandRequest | None = None


def walk(request: WalkRequest, watcher: Watcher) -> Walked:
    """Simulate a gait and write the walk folder.

    Args:
        request: Gait, model, duration, band and output folder.
        watcher: Receives progress.

    Returns:
        The walk with its notes.

    Raises:
        ZebroLabError: A file or an option has an invalid value.
        ModelError: The gait is impossible, or the walk cannot be computed.
    """
    require_replaceable(request.model.out, WALKED["walk"], inputs=request.model.inputs)
    described = robot_of(request.model)
    gait = make_gait(request.gait, leg_arc=described.robot.leg_arc)
    watcher.step("walking", None)
    duration = request.duration
    walked = walk_with(
        request.model, described, gait.reference,
        duration=duration, what=gait.what, direction=gait.direction,
    )  # fmt: skip
    if request.band is not None:
        band = predict_band(
            request.band, walked, gait.reference,
            duration=duration, toe=request.model.toe, watcher=watcher,
        )  # fmt: skip
        walked = replace(walked, band=band)
    settings = {
        "gait": {"name": request.gait.name, **request.gait.given()},
        "duration": duration,
        "direction": gait.direction,
    }
    write_walk(request.model, walked, watcher, kind="walk", settings=settings, band=request.band)
    return walked


def write_robot(file: Path, request: ModelRequest) -> Path:
    """Write the robot of a request as a commented `robot.toml`, as a template for editing.

    Args:
        file: File to write.
        request: Request that names the robot.

    Returns:
        The file written.

    Raises:
        AlreadyExists: The file exists.
        SettingsError: The robot is described with invalid values.
    """
    if file.exists():
        raise AlreadyExists(f"{file} exists already; edit it, or name another")
    return atomic_write_text(file, render_robot_file(robot_of(request)))
