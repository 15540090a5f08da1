# SPDX-License-Identifier: MIT
"""The end pose of a walk as a target: walked with draws of the law, and regressed on these."""

from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.bayes.posterior import SlipPosterior
from model.design.targets import Target, regressed_target
from model.errors import DomainError, InsufficientData
from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference
from model.leg_state import LegState
from model.predict import ModelSpread, predict_paths, walk_draws
from model.robot import GRAVITY, Robot
from model.walk.traction import TractionTable, law_table
from zebro_lab.files.replacement import recover
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.walk.leg_angles import angles_from
from zebro_lab.walk.request import PredictRequest
from zebro_lab.walk.stage import is_walk_folder, with_own_robot, without_offsets
from zebro_lab.walk.walking import robot_of

WALKED: Final = 40
"""Draws of the law that are walked."""
PARTS: Final = ("x", "y", "heading")
UNITS: Final = ("m", "m", "rad")
_SAMPLING = 0.1  # s between the poses of a walk, of which the heading is unwrapped
_EXACT = ModelSpread(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class LoggedWalk:
    """Leg angles of a walk, and the robot.

    Attributes:
        robot: The robot.
        legs: Leg angles from time zero on.
        duration: Duration of the walk [s].
        files: Files that were read.
    """

    robot: Robot
    legs: LegReference
    duration: float
    files: tuple[Path, ...]


def read_walk(path: Path) -> LoggedWalk:
    """Read leg angles and robot as `zebro-lab predict` does.

    Args:
        path: A run, a walk folder or a leg log.

    Raises:
        ZebroLabError: There are no leg angles, or they cannot be read.
    """
    recover(path)
    request = with_own_robot(PredictRequest(path))
    described = robot_of(request.model)
    if is_walk_folder(path):
        described = without_offsets(described)
    log = read_leg_log(path, leg_sign=described.leg_sign)
    start, end = float(log.reference.t[0]), float(log.reference.t[-1])
    legs, _ = angles_from(log, start)
    smooth = legs.smooth() if isinstance(legs, InexactLog) else legs
    own = () if request.model.robot is None else (request.model.robot,)
    return LoggedWalk(described.robot, smooth, end - start, (*log.files, *own))


def end_poses(
    walk: LoggedWalk, posterior: SlipPosterior, z: Array, *, executor: Executor | None = None
) -> tuple[Array, Array]:
    """Walk with draws of the law; return coordinates (w, d) and end poses (w, 3) [m, m, rad].

    Draws whose curve has no shape at the robot's loads are left out.

    Args:
        walk: The walk.
        posterior: Law and priors; coordinates are independent a priori.
        z: Draws of the coordinates, shape (n, d).
        executor: Where draws are walked; None for here.

    Raises:
        InsufficientData: No draw can be walked.
        ModelError: A walk diverged.
    """
    k = len(posterior.law.parameters)
    tables: list[TractionTable] = []
    walked: list[Array] = []
    for each, values in zip(z, posterior.values(z)[:, :k], strict=True):
        try:
            table = law_table(
                posterior.law, values, weight=walk.robot.mass * GRAVITY,
                definition=posterior.blocks.definition,
            )  # fmt: skip
        except DomainError:
            continue
        tables.append(table)
        walked.append(each)
    if not tables:
        raise InsufficientData(
            "no draw of the calibration is a curve at the loads of this robot's legs; calibrate at "
            "smaller and larger loads"
        )
    rng = np.random.default_rng(0)  # of spreads that are zero
    state = LegState.of_prior(len(tables), offset_sd=0.0, rng=rng)
    draws = walk_draws(walk.robot, walk.legs, tables, state, rng=rng)
    t = np.linspace(0.0, walk.duration, max(round(walk.duration / _SAMPLING), 1) + 1)
    paths = predict_paths(draws, t, state=state, error=_EXACT, rng=rng, executor=executor)
    return np.stack(walked), paths.states[:, -1]


def end_pose_target(
    name: str,
    walk: LoggedWalk,
    posterior: SlipPosterior,
    z: Array,
    *,
    n_draws: int,
    executor: Executor | None = None,
) -> Target:
    """Return the end pose of a walk as target, linear in the law's coordinates.

    Args:
        name: Name of the target.
        walk: The walk.
        posterior: Law and priors; coordinates are independent a priori.
        z: Draws of the coordinates, of which the first `WALKED` are walked, shape (w, d).
        n_draws: Number of draws around which the target is asked for.
        executor: Where draws are walked; None for here.

    Raises:
        InsufficientData: Too few draws can be walked.
        ModelError: A walk diverged.
    """
    walked, poses = end_poses(walk, posterior, z[:WALKED], executor=executor)
    own = {parameter.name for parameter in posterior.law.parameters}
    of_law = np.array([parameter.name in own for parameter in posterior.free])
    # Zero, so that the regression gives no weight to coordinates that no walk depends on: of noise.
    return regressed_target(
        name, np.where(of_law, walked, 0.0), poses, parts=PARTS, units=UNITS, n_draws=n_draws
    )
