# SPDX-License-Identifier: MIT
"""The band of a predicted path: compute draws, write and read draws, quantiles and picture."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import asdict
from pathlib import Path

import numpy as np

from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference
from model.lateral_spread import ANISOTROPY
from model.leg_state import LegState
from model.path_draws import LEVELS, STATES, anchored, quantiles
from model.poses import Poses
from model.predict import ModelSpread, on_terrain, predict_paths, walk_draws
from model.progress import Watcher
from model.robot import GRAVITY
from model.walk.terrain import LEVEL, Terrain
from model.walk.traction import ToeLaw
from zebro_lab.calibration.slip_draws import slip_tables
from zebro_lab.files.arrays import read_arrays
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.opening import parsing
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.walk.folder import BAND_CSV, BAND_PICTURE, DRAWS, INFORMED_MODEL
from zebro_lab.walk.informed_legs import InformedLegs
from zebro_lab.walk.output_request import BandRequest
from zebro_lab.walk.walking import Walked

SAMPLING = 0.1  # s between the poses kept of each draw
ASSUMED_OFFSET_DEG = 0.3  # of legs whose zero was set by hand
_STEPS_SHOWN = 50  # progress reports
_ADVICE = f"delete {DRAWS} if it is there, and run walk or predict again with --draws 500"


def band_settings(request: BandRequest, informed: InformedLegs | None) -> dict[str, object]:
    """Return the options of a band and the model's spread for the manifest, JSON-serialisable.

    Where the draws were walked is left out: it changes nothing.

    Args:
        request: Settings of the band.
        informed: Posterior of fitted walks, which has lateral traction as well: `anisotropy` is
            then None, or 1 if the walks were fitted with traction alike in all directions.
    """
    if informed is None:
        factor = _anisotropy(request)
    else:
        factor = 1.0 if informed.posterior.prior.lateral_sd == 0 else None
    options = asdict(request)
    del options["workers"]
    return {**options, "anisotropy": factor, "spread": asdict(ModelSpread())}


def predict_band(
    request: BandRequest,
    walked: Walked,
    legs: LegReference | InexactLog,
    *,
    duration: float,
    toe: ToeLaw,
    watcher: Watcher,
    executor: Executor | None = None,
) -> Poses:
    """Compute paths of a walk with slip law, legs, floor and start pose drawn at random.

    Args:
        request: Settings of the band.
        walked: The finished single walk, with robot, slip law and posterior of legs and floor.
        legs: Leg angles of the walk from time zero on.
        duration: Duration of the walk [s].
        toe: Traction law of a leg on its toe: "saturated", "peak" or "bristle".
        watcher: Receives progress.
        executor: Where draws are walked; None for here.

    Returns:
        `request.draws` paths from time zero to `duration`, sampled about every 0.1 s.

    Raises:
        SettingsError: The model is not "dynamics", or a standard deviation of leg offsets or of
            lateral traction is given although fitted walks determine them.
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
    weight = robot.mass * GRAVITY
    tables = slip_tables(walked.slip, request.draws, weight=weight, toe=toe, rng=rng)
    watcher.step("predicting the band", 0.0)
    draws = walk_draws(robot, legs, tables, state, rng=rng)
    x, y, yaw_deg = request.start_sd
    covariance = np.diag([x, y, np.radians(yaw_deg)]) ** 2
    terrain = walked.terrain
    if not terrain.is_alike_everywhere:  # there each draw is walked from where it begins
        starts = rng.multivariate_normal(np.zeros(3), covariance, size=len(draws), method="eigh")
        laws = [
            slip_tables(slip, request.draws, weight=weight, toe=toe, rng=rng)
            for slip in (() if walked.ground is None else walked.ground.slips)
        ]
        draws = on_terrain(draws, terrain, laws, starts)
    t = np.linspace(0.0, duration, max(round(duration / SAMPLING), 1) + 1)
    paths = predict_paths(
        draws, t, state=state, error=ModelSpread(), rng=rng, executor=executor,
        progress=_every(_STEPS_SHOWN, watcher),
    )  # fmt: skip
    if not terrain.is_alike_everywhere:
        return paths
    return anchored(paths, np.zeros(3), at=0.0, covariance=covariance, rng=rng)


def _every(steps: int, watcher: Watcher) -> Callable[[float], None]:
    """Return a function that passes the fraction done on to `watcher` at most `steps` times."""
    shown = 0

    def show(fraction: float) -> None:
        nonlocal shown
        if fraction * steps >= shown + 1:
            shown += 1
            watcher.step("predicting the band", fraction)

    return show


def _leg_state(
    request: BandRequest,
    legs: LegReference | InexactLog,
    informed: InformedLegs | None,
    rng: np.random.Generator,
) -> LegState:
    if informed is None:
        offset_sd = np.radians(offset_sd_deg(request, legs))
        return LegState.of_prior(
            request.draws, offset_sd=offset_sd, anisotropy=_anisotropy(request), rng=rng
        )
    for given, what, key in (
        (request.offset_sd_deg, "the legs' offsets", "--offset-sd-deg"),
        (request.anisotropy, "lateral grip and stiffness", "--anisotropy"),
    ):
        if given is not None:
            raise SettingsError(
                f"the fit of walks in {informed.folder} gives the spread of {what}; leave the "
                "option out, or choose a slip.toml with no walks/ in its folder",
                key=key,
            )
    return informed.draw(request.draws, rng=rng)


def _anisotropy(request: BandRequest) -> float:
    return ANISOTROPY if request.anisotropy is None else request.anisotropy


def offset_sd_deg(request: BandRequest, legs: LegReference | InexactLog) -> float:
    """Return the leg offsets' sd [deg]: as requested, else 0.3 or more, encoder step / sqrt(12)."""
    if request.offset_sd_deg is not None:
        return request.offset_sd_deg
    if isinstance(legs, InexactLog):
        return max(float(np.degrees(legs.step) / np.sqrt(12.0)), ASSUMED_OFFSET_DEG)
    return ASSUMED_OFFSET_DEG


def write_band(
    folder: Path,
    paths: Poses,
    *,
    title: str,
    form: PictureFormat = "png",
    terrain: Terrain = LEVEL,
) -> None:
    """Write `draws.npz`, the quantiles `band.csv` and the picture `band` into a walk folder.

    Args:
        folder: Folder to write into.
        paths: The paths, in the time base of the walk folder.
        title: Gait and model, for the title of the picture.
        form: Format of the picture.
        terrain: The ground, which is drawn below the paths.
    """
    import pandas as pd

    from zebro_lab.plots import path_band, save

    np.savez_compressed(folder / DRAWS, t=paths.t, poses=paths.states.astype(np.float32))
    band = quantiles(paths)
    columns = {"t": paths.t}
    for i, state in enumerate(STATES):
        for level, row in zip(LEVELS, band, strict=True):
            columns[f"{state}_q{1000 * level:03.0f}"] = row[:, i]
    pd.DataFrame(columns).to_csv(
        folder / BAND_CSV, index=False, float_format="%.8g", lineterminator="\n"
    )
    figure = path_band.path_band(paths, title=f"Predicted path: {title}", terrain=terrain)
    save(figure, folder / f"{BAND_PICTURE}.{form}")


def read_draws(folder: Path) -> Poses:
    """Read the paths of a walk folder's band from `draws.npz`.

    Raises:
        NotFound: The folder has no `draws.npz`.
        DataError: The file is damaged or too large, there are no poses, shapes do not match, or
            times do not increase.
    """
    file = folder / DRAWS
    arrays = read_arrays(file, ("t", "poses"), advice=_ADVICE)
    t, poses = arrays["t"], arrays["poses"]
    if t.ndim != 1 or poses.ndim != 3 or poses.shape[1:] != (len(t), 3) or 0 in poses.shape:
        raise DataError(
            f"holds poses of shape {poses.shape} at times of shape {t.shape}; {_ADVICE}",
            file=file,
        )
    with parsing(file, "cannot be read as poses", advice=_ADVICE):
        t, poses = t.astype(float), poses.astype(float)
    if not np.all(np.diff(t) > 0):
        raise DataError(f"holds times that do not increase; {_ADVICE}", file=file)
    return Poses.of_states(t, poses)
