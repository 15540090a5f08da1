# SPDX-License-Identifier: MIT
"""Compute and predict walks, for notebooks."""

from dataclasses import dataclass
from pathlib import Path

from typer import BadParameter

from model.gait.direction import Direction
from model.poses import Poses
from model.walk.path import WalkPath
from zebro_lab.files.errors import SettingsError
from zebro_lab.front.defaults import PathLike, Silent, kept_or_temporary, optional
from zebro_lab.robot.gait_request import GaitRequest
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.walk.folder import read_draws
from zebro_lab.walk.request import (
    BandRequest,
    ModelName,
    ModelRequest,
    PredictRequest,
    RuleName,
    WalkRequest,
)
from zebro_lab.walk.stage import predict, walk
from zebro_lab.walk.walking import Walked


@dataclass(frozen=True)
class WalkResult:
    """A walk, or a predicted walk.

    Attributes:
        walk: Body, legs, slip and forces over time.
        draws: Paths with slip law, legs, floor and start drawn; None if draws were not requested.
        notes: Notes, one line each.
    """

    walk: WalkPath
    draws: Poses | None
    notes: tuple[str, ...]

    @property
    def path(self) -> Poses:
        """Poses of the body over time: x, y [m] and yaw [rad]."""
        return self.walk.poses


def read_legs(path: PathLike, *, columns: PathLike | None = None) -> LegLog:
    """Read leg angles over time from a table, a recorded run or a walk folder.

    Leg signs of a `robot.toml` are not applied.

    Args:
        path: Table, run folder or walk folder to read.
        columns: A `columns.toml` to use instead of the one beside the table; ignored for a run.

    Raises:
        ZebroLabError: A file is missing or cannot be used; names file, row and column if known.
    """
    return read_leg_log(Path(path), columns=optional(columns))


def walk_gait(
    gait: str = "tripod",
    *,
    slip: str | None = "thesis",
    duration: float = 10.0,
    model: ModelName = "dynamics",
    steering: float | None = None,
    direction: Direction | None = None,
    thesis: RuleName = "listing",
    ground: PathLike | None = None,
    robot: PathLike | None = None,
    draws: int = 0,
    seed: int = 1,
    out: PathLike | None = None,
) -> WalkResult:
    """Simulate a gait and compute the robot's path, as `zebro-lab walk` does.

    Args:
        gait: "tripod", "suriana", "maxplus", "tetrapod" or "buehler", or groups of legs in the
            order of their steps, such as "{1,4} < {2,5} < {3,6}".
        slip: A calibration folder or `slip.toml`, "coulomb:MU[:V]" or "thesis"; None for a model
            without slip.
        duration: Duration of the walk [s].
        model: "dynamics", "thesis", or without slip "no-slip" or "no-slip-simple".
        steering: Ratio of the outer to the inner legs' stance angle, of the tripod alone; None for
            1, straight [-].
        direction: Side to turn to, "left" or "right", of tripod, suriana and maxplus; None for
            left.
        thesis: What the model "thesis" follows where its "listing" and its "text" differ.
        ground: A `ground.toml` for the model "dynamics"; None for level ground of one slip law.
        robot: A `robot.toml`; None for the thesis's robot.
        draws: Number of draws for a band, at least two, with the model "dynamics"; 0 for the single
            path only.
        seed: Seed of the band's draws.
        out: Walk folder to write; None to keep no files.

    Raises:
        ZebroLabError: A file or an option cannot be used.
        ModelError: The walk cannot be computed.
    """
    with kept_or_temporary(out) as folder:
        try:
            request = WalkRequest(
                GaitRequest(gait, steering=steering, direction=direction),
                duration,
                folder,
                _model_request(slip, model, ground, robot, BandRequest(draws, seed)),
                thesis,
            )
        except BadParameter as error:
            raise SettingsError(error.message, key="thesis") from error
        return _walk_result(walk(request, Silent()), folder, draws)


def predict_walk(
    legs: PathLike,
    *,
    slip: str | None,
    model: ModelName = "dynamics",
    ground: PathLike | None = None,
    robot: PathLike | None = None,
    columns: PathLike | None = None,
    draws: int = 0,
    seed: int = 1,
    out: PathLike | None = None,
) -> WalkResult:
    """Predict the path from measured leg angles, in their time base, as `zebro-lab predict` does.

    Args:
        legs: A table of leg angles, a recorded run, or a walk folder.
        slip: As in `walk_gait`.
        model: As in `walk_gait`.
        ground: As in `walk_gait`.
        robot: A `robot.toml`; None for that of the run, else the thesis's robot.
        columns: A `columns.toml` to use instead of the one beside the table; ignored for a run.
        draws: As in `walk_gait`.
        seed: Seed of the band's draws.
        out: Walk folder to write; None to keep no files.

    Raises:
        ZebroLabError: A file or an option cannot be used.
        ModelError: The walk cannot be computed.
    """
    with kept_or_temporary(out) as folder:
        request = PredictRequest(
            Path(legs),
            folder,
            optional(columns),
            model=_model_request(slip, model, ground, robot, BandRequest(draws, seed)),
        )
        return _walk_result(predict(request, Silent()), folder, draws)


def _model_request(
    slip: str | None,
    model: ModelName,
    ground: PathLike | None,
    robot: PathLike | None,
    band: BandRequest,
) -> ModelRequest:
    """Return the options of model and band; arguments as those of `walk_gait`."""
    return ModelRequest(slip, model, ground=optional(ground), robot=optional(robot), band=band)


def _walk_result(walked: Walked, folder: Path, draws: int) -> WalkResult:
    """Return the result of a walk; draws are read from its folder, if there are any."""
    return WalkResult(walked.path, read_draws(folder) if draws else None, walked.notes)
