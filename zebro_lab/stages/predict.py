# SPDX-License-Identifier: MIT
"""Measured leg angles in, walk folder out."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from model.gait.reference import SampledReference
from model.robot import N_LEGS
from zebro_lab.leg_log import LegLog, read_leg_log
from zebro_lab.robot_file import RobotFile
from zebro_lab.walk_folder import PATH_CSV
from zebro_lab.walk_models import Direction
from zebro_lab.walking import ModelRequest, Walked, Watcher, robot_of, walk_with, write_walk


@dataclass(frozen=True)
class PredictRequest:
    """What is asked of a prediction.

    Attributes:
        log: Leg angles: CSV, Parquet, or a walk folder.
        model: Which model, on what, and what to write.
        columns: A `columns.toml` in place of the one beside the log.
        direction: Side the gait turns to; only the source's model asks.
    """

    log: Path
    model: ModelRequest
    columns: Path | None = None
    direction: Direction = "left"


def predict(request: PredictRequest, watcher: Watcher) -> Walked:
    """Predict where measured leg angles lead and write the walk folder.

    The path keeps the log's own time.

    Raises:
        ZebroLabError: A file is missing or holds what cannot be followed.
        ModelError: The walk cannot be computed.
    """
    described = robot_of(request.model)
    if request.log.is_dir() or request.log.name == PATH_CSV:
        described = _as_walked(described)
    log = read_leg_log(request.log, columns=request.columns, leg_sign=described.leg_sign)
    start, end = float(log.reference.t[0]), float(log.reference.t[-1])
    watcher.step("walking", None)
    walked = walk_with(
        request.model,
        described,
        SampledReference(log.reference.t - start, log.reference.theta),
        duration=end - start,
        what=_what(log),
        direction=request.direction,
        notes=log.notes,
    )
    walked = replace(walked, path=replace(walked.path, t=walked.path.t + start))
    settings = {"leg_angles": log.source, "direction": request.direction}
    write_walk(request.model, walked, watcher, kind="predict", settings=settings, files=log.files)
    return walked


def _as_walked(described: RobotFile) -> RobotFile:
    """Return the robot without signs and offsets: the angles of a walked path are true ones."""
    robot = replace(described.robot, leg_offset=np.zeros(N_LEGS))
    return replace(described, robot=robot, leg_sign=(1,) * N_LEGS)


def _what(log: LegLog) -> str:
    return "simulated leg angles" if log.source.startswith("sim:") else "logged leg angles"
