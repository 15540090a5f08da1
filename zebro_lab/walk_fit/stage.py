# SPDX-License-Identifier: MIT
"""Stage of `calibrate-slip --walks`: fit legs and floor to tracked walks, write `walks/`."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.leg_state import ANISOTROPY, log_spread
from model.tasks import Watcher
from model.walk_fit.posterior import WalkPosterior
from model.walk_fit.prior import WalkPrior
from zebro_lab.calibration.folder import CALIBRATION, SLIP_TOML
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.slip_argument import THESIS, NamedSlip, parse_slip
from zebro_lab.calibration.walks_folder import FOLDER, WALKS, WalksToWrite, write_walks
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.files.source_names import is_simulated
from zebro_lab.validation.folder import metrics
from zebro_lab.validation.judged_run import JudgedRun
from zebro_lab.validation.shared_clock import LARGEST_OFFSET
from zebro_lab.walk_fit.clocks import checked_clock, estimated_clock_of
from zebro_lab.walk_fit.pictures import draw_walks
from zebro_lab.walk_fit.prediction import fit_walks_on_file, judge_left_out
from zebro_lab.walk_fit.request import WalksRequest
from zebro_lab.walk_fit.tracked_walks import WalkOnFile, read_walks


@dataclass(frozen=True)
class WalksCalibrated:
    """A finished fit of walks and where it was written.

    Attributes:
        posterior: The posterior of legs and floor.
        left_out: Each walk predicted from a fit of the others, with its errors; empty for a single
            walk.
        folder: The folder `walks/` that was written.
        source: Sources of rig data and walks, joined by commas.
        notes: Notes, one line each.
    """

    posterior: WalkPosterior
    left_out: tuple[JudgedRun, ...]
    folder: Path
    source: str
    notes: tuple[str, ...]


def require_walks(request: WalksRequest, calibration: CalibrationRequest, watcher: Watcher) -> None:
    """Check before a long fit of rig data that the walks can be fitted and written after it.

    Args:
        request: Run folders of the walks, and whether to estimate clock offsets.
        calibration: Options with the folder of the calibration to come.
        watcher: Receives progress.

    Raises:
        ZebroLabError: As in `calibrate_walks`, as far as it does not depend on the fitted slip law;
            of the clock check only offsets of over twice the limit are refused here.
    """
    require_replaceable(calibration.out, CALIBRATION, inputs=request.walks)
    require_replaceable(calibration.out / FOLDER, WALKS, inputs=request.walks)
    watcher.step("reading walks", None)
    rough = parse_slip(THESIS)  # instead of the law that is still to be fitted
    if request.estimate_offset:
        clock = estimated_clock_of(rough)
    else:
        clock = checked_clock(rough, largest=2 * LARGEST_OFFSET)
    read_walks(request.walks, clock=clock)


def calibrate_walks(
    request: WalksRequest,
    calibration: CalibrationRequest,
    watcher: Watcher,
    *,
    executor: Executor | None = None,
) -> WalksCalibrated:
    """Fit legs and floor to walks, predict each from the others, and write `walks/`.

    Args:
        request: Run folders of the walks, and whether to estimate clock offsets.
        calibration: Options with the folder of the finished calibration, into which `walks/` is
            written, and seed.
        watcher: Receives progress.
        executor: Where draws are walked; None for here.

    Raises:
        ZebroLabError: No walk is named; a walk or the calibration is missing or cannot be used; or
            `walks/` cannot be replaced. Nothing was written.
        ModelError: A walk diverged, or the slip law is invalid at its loads; nothing was written.
    """
    slip_toml = _slip_of(request, calibration.out)
    require_replaceable(calibration.out / FOLDER, WALKS, inputs=request.walks)
    slip = parse_slip(str(slip_toml), with_walks=False)
    watcher.step("reading walks", None)
    clock = estimated_clock_of(slip) if request.estimate_offset else checked_clock(slip)
    walks = read_walks(request.walks, clock=clock)
    prior = WalkPrior(lateral_sd=log_spread(ANISOTROPY))
    posterior, left_out = _fit(calibration, slip, walks, prior, watcher, executor)
    notes = (*slip.notes, *(f"{walk.name}: {note}" for walk in walks for note in walk.notes))
    source = ", ".join(sorted({slip.source, *(walk.source for walk in walks)}))
    watcher.step("drawing", None)
    folder = write_walks(
        calibration.out,
        WalksToWrite(
            posterior=posterior,
            left_out={run.name: {row.name: metrics(row) for row in run.rows} for run in left_out},
            robot=walks[0].robot,
            logs=tuple(walk.files[0] for walk in walks),
            inputs=(slip_toml, *(file for walk in walks for file in walk.files)),
            settings={
                "seed": calibration.seed,
                "estimate_offset": request.estimate_offset,
                "anisotropy": ANISOTROPY,
            },
            source=source,
            notes=notes,
        ),
        draw=lambda draft: draw_walks(
            draft, posterior, left_out, simulated=is_simulated(source), form=calibration.form
        ),
    )
    return WalksCalibrated(posterior, left_out, folder, source, notes)


def _fit(
    request: CalibrationRequest,
    slip: NamedSlip,
    walks: Sequence[WalkOnFile],
    prior: WalkPrior,
    watcher: Watcher,
    executor: Executor | None,
) -> tuple[WalkPosterior, tuple[JudgedRun, ...]]:
    """Fit all walks; return the posterior, and each walk predicted from a fit of the others."""
    rng = np.random.default_rng(request.seed)
    fit = fit_walks_on_file(
        walks, slip, prior=prior, rng=rng, executor=executor,
        progress=lambda done: watcher.step("fitting walks", 0.7 * done),
    )  # fmt: skip
    left_out = judge_left_out(
        fit, walks, slip, rng=rng, executor=executor,
        progress=lambda done: watcher.step("fitting walks", 0.7 + 0.3 * done),
    )  # fmt: skip
    return fit.posterior, left_out


def _slip_of(request: WalksRequest, calibration: Path) -> Path:
    """Return the path of the `slip.toml` of a finished calibration.

    Raises:
        SettingsError: The request names no walk.
        NotFound: The calibration has no `slip.toml`.
    """
    if not request.walks:
        raise SettingsError("missing: no walk was given to fit", key="--walks")
    slip_toml = recover(calibration) / SLIP_TOML
    if not slip_toml.is_file():
        raise NotFound(
            f"{slip_toml}: no such file; give rig data to calibrate from, or the --out of a "
            "finished calibration"
        )
    return slip_toml
