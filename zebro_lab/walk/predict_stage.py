# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab predict`: read leg angles, compute the path, write the walk folder."""

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from model.gait.direction import Direction
from model.gait.quantised import QuantisedLog
from model.progress import Watcher
from model.robot import N_LEGS
from zebro_lab.files.names import PATH_CSV
from zebro_lab.files.replacement import settle
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.robot.robot_file import ROBOT_FILE, RobotFile
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.recorded_legs import is_recorded
from zebro_lab.walk.folder import WALKED
from zebro_lab.walk.leg_angles import angles_from
from zebro_lab.walk.path_band import BandRequest, write_band
from zebro_lab.walk.walked_band import band_of
from zebro_lab.walk.walking import ModelRequest, Walked, robot_of, walk_with, write_walk


@dataclass(frozen=True)
class PredictRequest:
    """Settings of a prediction.

    Attributes:
        log: Leg angles: CSV, Parquet, a recorded run or a walk folder.
        model: Model, slip law, robot, and what to write.
        columns: A `columns.toml` in place of the one beside the log.
        direction: Side the gait turns to; only the thesis's model uses it.
        band: Settings of the band; None for the path alone.
    """

    log: Path
    model: ModelRequest
    columns: Path | None = None
    direction: Direction = "left"
    band: BandRequest | None = None

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Files and folders that are read, as named."""
        columns = () if self.columns is None else (self.columns,)
        return (self.log, *columns, *self.model.inputs)


def predict(request: PredictRequest, watcher: Watcher) -> Walked:
    """Predict the path from measured leg angles and write the walk folder.

    The path has the log's time base. The robot is that of the request, else the `robot.toml` of the
    run, else the thesis's robot.

    Args:
        request: Leg log, model, band and output folder.
        watcher: Receives progress.

    Returns:
        The predicted walk with its notes.

    Raises:
        ZebroLabError: A file is missing or has invalid content.
        ModelError: The walk cannot be computed.
    """
    settle(request.log)
    request = _with_own_robot(request)
    require_replaceable(request.model.out, WALKED["predict"], inputs=request.inputs)
    described = robot_of(request.model)
    walked_before = request.log.is_dir() or request.log.name == PATH_CSV
    walked_before = walked_before and not is_recorded(request.log)
    if walked_before:
        described = _as_walked(described)
    log = read_leg_log(request.log, columns=request.columns, leg_sign=described.leg_sign)
    start, end = float(log.reference.t[0]), float(log.reference.t[-1])
    legs, notes = angles_from(log, start)
    watcher.step("walking", None)
    walked = walk_with(
        request.model,
        described,
        legs.smooth() if isinstance(legs, QuantisedLog) else legs,
        duration=end - start,
        what=_what(log),
        direction=request.direction,
        logs=log.files,
        angles_are_true=walked_before,
        notes=(*log.notes, *notes),
    )
    walked = replace(walked, path=replace(walked.path, t=walked.path.t + start))
    settings: dict[str, object] = {"leg_angles": log.source, "direction": request.direction}
    extra = None
    if request.band is not None:
        paths = band_of(
            request.band, walked, legs,
            duration=end - start, toe=request.model.toe, watcher=watcher,
        )  # fmt: skip
        settings["band"] = request.band.settings()
        extra = partial(write_band, paths=paths.delayed(start), title=walked.title)
    write_walk(
        request.model, walked, watcher,
        kind="predict", settings=settings, files=log.files, extra=extra,
    )  # fmt: skip
    return walked


def _with_own_robot(request: PredictRequest) -> PredictRequest:
    own = request.log / ROBOT_FILE
    if request.model.robot is not None or not is_recorded(request.log) or not own.is_file():
        return request
    return replace(request, model=replace(request.model, robot=own))


def _as_walked(described: RobotFile) -> RobotFile:
    """Return the robot without leg signs and offsets: angles of a walked path are exact."""
    robot = replace(described.robot, leg_offset=np.zeros(N_LEGS))
    return replace(described, robot=robot, leg_sign=(1,) * N_LEGS)


def _what(log: LegLog) -> str:
    return "simulated leg angles" if log.source.startswith("sim:") else "logged leg angles"
