# SPDX-License-Identifier: MIT
"""Compute the band of a predicted path: draws of the slip law, of legs and of the floor."""

from concurrent.futures import Executor
from dataclasses import asdict, replace

import numpy as np

from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference
from model.leg_state import ANISOTROPY, LegState
from model.path_draws import bent_walk, middle_bend
from model.poses import Poses
from model.predict import ModelSpread, predict_paths, walk_draws
from model.robot import GRAVITY
from model.tasks import Watcher
from zebro_lab.calibration.posterior_file import slip_tables
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.folder import INFORMED_MODEL
from zebro_lab.walk.informed_legs import InformedLegs
from zebro_lab.walk.request import BandRequest
from zebro_lab.walk.walking import Walked

SAMPLING = 0.1  # s between the poses kept of each draw
ASSUMED_OFFSET_DEG = 0.3  # of legs whose zero was set by hand


def band_settings(request: BandRequest, informed: InformedLegs | None) -> dict[str, object]:
    """Return the options of a band and the model's spread for the manifest, JSON-serialisable.

    Where the draws were walked is left out: it changes nothing.

    Args:
        request: Settings of the band.
        informed: Posterior of fitted walks, which has lateral traction as well: `anisotropy` is
            then None, or 1 if the walks were fitted with traction alike in all directions.
    """
    factor: float | None = ANISOTROPY
    if informed is not None:
        factor = 1.0 if informed.posterior.prior.lateral_sd == 0 else None
    options = asdict(request)
    del options["scheduler"]
    return {**options, "anisotropy": factor, "spread": asdict(ModelSpread())}


def predict_band(
    request: BandRequest,
    walked: Walked,
    legs: LegReference | InexactLog,
    *,
    duration: float,
    watcher: Watcher,
    executor: Executor | None = None,
) -> Poses:
    """Compute paths of a walk with slip law, legs and floor drawn at random.

    Args:
        request: Settings of the band.
        walked: The finished single walk, with robot, slip law and posterior of legs and floor.
        legs: Leg angles of the walk from time zero on.
        duration: Duration of the walk [s].
        watcher: Receives progress.
        executor: Where draws are walked; None for here.

    Returns:
        `request.draws` paths from time zero to `duration`, sampled about every 0.1 s.

    Raises:
        SettingsError: The model is not "dynamics", or a standard deviation of leg offsets is given
            although fitted walks determine them.
        DataError: The posterior draws of the slip law cannot be read.
        ModelError: A walk diverged, or no slip law is valid at the robot's loads.
    """
    if walked.model != INFORMED_MODEL or walked.slip is None:
        raise SettingsError(
            f"a band is predicted by the model 'dynamics' only, not by '{walked.model}'",
            key="--draws",
        )
    rng = np.random.default_rng(request.seed)
    robot = walked.described.robot
    state = _leg_state(request, legs, walked.informed, rng)
    tables = slip_tables(walked.slip, request.draws, weight=robot.mass * GRAVITY, rng=rng)
    watcher.step("predicting the band", 0.0)
    draws = walk_draws(robot, legs, tables, state, rng=rng, ground=walked.heights)
    t = np.linspace(0.0, duration, max(round(duration / SAMPLING), 1) + 1)
    return predict_paths(
        draws, t, state=state, error=ModelSpread(), rng=rng, executor=executor,
        progress=lambda done: watcher.step("predicting the band", done),
    )  # fmt: skip


def in_the_middle(walked: Walked, band: Poses) -> Walked:
    """Return a walk with its band, the single path moved to the middle of it by `middle_bend`.

    Args:
        walked: The single walk.
        band: Its band, of m draws.
    """
    bend = middle_bend(walked.path.poses.draws(), band)
    return replace(walked, band=band, path=bent_walk(walked.path, bend, walked.heights))


def _leg_state(
    request: BandRequest,
    legs: LegReference | InexactLog,
    informed: InformedLegs | None,
    rng: np.random.Generator,
) -> LegState:
    """Draw states of legs and floor from the posterior of fitted walks, else from the prior.

    Raises:
        SettingsError: A standard deviation of leg offsets is requested beside fitted walks.
    """
    if informed is None:
        offset_sd = np.radians(offset_sd_deg(request, legs))
        return LegState.of_prior(request.draws, offset_sd=offset_sd, anisotropy=ANISOTROPY, rng=rng)
    if request.offset_sd_deg is not None:
        raise SettingsError(
            f"the fit of walks in {informed.folder} gives the spread of the legs' offsets; leave "
            "the option out, or choose a slip.toml with no walks/ in its folder",
            key="--offset-sd-deg",
        )
    return informed.draw(request.draws, rng=rng)


def offset_sd_deg(request: BandRequest, legs: LegReference | InexactLog) -> float:
    """Return the standard deviation of the legs' offsets [deg].

    As requested; else that of rounding to encoder counts, step / sqrt(12), at least
    `ASSUMED_OFFSET_DEG`, which also holds for angles that are not counted.
    """
    if request.offset_sd_deg is not None:
        return request.offset_sd_deg
    if isinstance(legs, InexactLog):
        return max(float(np.degrees(legs.step) / np.sqrt(12.0)), ASSUMED_OFFSET_DEG)
    return ASSUMED_OFFSET_DEG
