# SPDX-License-Identifier: MIT
"""Rig data in, calibration folder out: read, prepare, sample, judge, write."""

import math
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from model.bayes.blocks import block_means
from model.bayes.convergence import Convergence, assess
from model.bayes.cross_validation import r_squared
from model.bayes.estimate import (
    agreement,
    contraction,
    curve_estimates,
    estimate,
    thin_draws,
)
from model.bayes.fit import (
    Comparison,
    PreparedFit,
    breakdown_told,
    compare,
    prepare_fit,
    require_forces,
    scaled_load_cell,
)
from model.bayes.laplace import importance_draws
from model.bayes.posterior import LoadCell
from model.bayes.preliminary import BlockChoice
from model.bayes.residuals import analyse_residuals, largest_slips, load_levels
from model.bayes.sampler import Chains, advance, start_chains
from model.bayes.samples import SlipSamples
from model.bayes.verdict import judge
from model.slip.law import SlipLaw
from model.slip.laws import slip_law
from model.slip.magic_formula import MagicFormula
from zebro_lab.calibration.checkpoint import FILE as CHECKPOINT
from zebro_lab.calibration.checkpoint import load_checkpoint, save_checkpoint
from zebro_lab.calibration.folder import CALIBRATION, Calibration, write_tables
from zebro_lab.calibration.pictures import draw_calibration
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.errors import SettingsError, ZebroLabError
from zebro_lab.files.provenance import file_hashes, fingerprint
from zebro_lab.files.result_folder import require_replaceable, result_folder
from zebro_lab.terminal.watcher import Watcher

THIN = 5  # sampler moves a kept step
CHUNK = 20  # kept steps between looks at the clock, the keyboard and the bar
FIRST_LOOK = 100  # kept steps before convergence is judged for the first time
CHECKPOINT_SECONDS = 5.0
DRAWS_PER_ENSEMBLE = 1000
IMPORTANCE_DRAWS = 10_000
FEW_BLOCKS = 500  # below, numpy's calls are so short that threads only wait for each other


class Stopped(ZebroLabError):
    """The fit was stopped on request.

    Attributes:
        checkpoint: Where the fit stands; None when sampling had not begun and nothing was written.
    """

    def __init__(self, checkpoint: Path | None) -> None:
        super().__init__(
            "stopped before sampling began; nothing was written"
            if checkpoint is None
            else f"stopped; {checkpoint} keeps the fit: the same command with --resume goes on"
        )
        self.checkpoint = checkpoint


@dataclass(frozen=True)
class CalibrationRequest:
    """What is asked of a fit.

    Attributes:
        data: Files and folders of rig data.
        out: Calibration folder to write.
        columns: A `columns.toml` for tables that have none beside them.
        slip_definition: Definition to fit in; that of the data when None.
        law: Name of the slip law.
        curvature: For the Magic Formula: "auto", "peak", "constant" or a fixed E.
        load_sensitivity: For the Magic Formula: let friction and stiffness vary with load.
        block_length: Samples in a block; chosen when None.
        load_cell: What is known of the load cell beyond `columns.toml`, by field of `LoadCell`.
        ensembles: Independent ensembles.
        max_steps: Sampler moves after which a fit that has not converged is written as such.
        seed: Seed of everything random.
        threads: Ensembles advanced at once.
        resume: Go on from the checkpoint in `out`.
    """

    data: tuple[Path, ...]
    out: Path
    columns: Path | None = None
    slip_definition: str | None = None
    law: str = MagicFormula.name
    curvature: str = "auto"
    load_sensitivity: bool = False
    block_length: int | None = None
    load_cell: Mapping[str, float] = field(default_factory=dict)
    ensembles: int = 4
    max_steps: int = 30_000
    seed: int = 1
    threads: int = 2
    resume: bool = False

    @property
    def inputs(self) -> tuple[Path, ...]:
        """What is read, as it was named."""
        return (*self.data, *((self.columns,) if self.columns is not None else ()))

    def decisive(self) -> dict[str, object]:
        """Return what decides the numbers, as JSON can hold it."""
        return {
            "slip_definition": self.slip_definition,
            "law": self.law,
            "curvature": self.curvature,
            "load_sensitivity": self.load_sensitivity,
            "block_length": self.block_length,
            "load_cell": dict(self.load_cell),
            "ensembles": self.ensembles,
            "seed": self.seed,
        }


def calibrate(request: CalibrationRequest, watcher: Watcher) -> tuple[Calibration, RigData]:
    """Fit a slip law to rig data and write the calibration folder.

    Args:
        request: What is asked.
        watcher: Hears of progress and may ask to stop.

    Returns:
        The finished fit and the data it was made from.

    Raises:
        ZebroLabError: The data or the request cannot be used; nothing was written.
        ModelError: The fit failed; nothing was written.
        Stopped: The watcher asked to stop; once sampling had begun a checkpoint was written.
    """
    require_replaceable(request.out, CALIBRATION, inputs=request.inputs)
    watcher.step("reading", None)
    data = read_rig_data(
        request.data, columns=request.columns, slip_definition=request.slip_definition
    )
    inputs = file_hashes(data.files)
    mark = fingerprint(inputs, request.decisive())
    earlier = load_checkpoint(request.out, fingerprint=mark) if request.resume else None
    rng = np.random.default_rng(request.seed)
    cell = scaled_load_cell(data.samples, {**data.load_cell, **request.load_cell})
    require_forces(data.samples, cell)
    fit, comparison = _choose_law(request, data.samples, cell, rng, watcher)
    began = time.monotonic()
    judging = rng.spawn(1)[0]  # its draws are the same whether or not the fit was resumed
    with breakdown_told(data.samples, fit.posterior.law):
        chains, convergence = _sample(request, fit, earlier, mark, rng, watcher)
        seconds = time.monotonic() - began
        watcher.step("judging", None)
        calibration = _conclude(fit, comparison, chains, convergence, data, seconds, judging)
    watcher.step("drawing", None)
    _write(request, calibration, inputs)
    if convergence.converged:
        (request.out / CHECKPOINT).unlink(missing_ok=True)
    else:
        save_checkpoint(request.out, chains, fingerprint=mark)
    return calibration, data


def _candidates(request: CalibrationRequest, samples: SlipSamples) -> dict[str, SlipLaw]:
    """Return the laws to compare, simplest first, by the name they are reported under."""
    if request.law != MagicFormula.name:
        if request.curvature != "auto" or request.load_sensitivity:
            raise SettingsError(
                f"--curvature and --load-sensitivity belong to the Magic Formula, not to "
                f"'{request.law}'; leave them out",
            )
        return {request.law: slip_law(request.law)}
    middle_load = float(np.median(samples.normal_force))

    def formula(curvature: Literal["peak", "constant"] | float) -> MagicFormula:
        return MagicFormula(curvature, request.load_sensitivity, middle_load)

    if request.curvature != "auto":
        return {request.law: formula(_curvature(request.curvature))}
    laws: dict[str, SlipLaw] = {"one curvature E at every load": formula("constant")}
    if len(load_levels(block_means(samples, 10))) > 1:  # at one load the two are the same
        laws["peak slip grows with load"] = formula("peak")
    return laws


def _curvature(text: str) -> Literal["peak", "constant"] | float:
    if text == "peak" or text == "constant":
        return text
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not -math.inf < number < 1:  # at 1 and above the curve has no peak, or changes its sign
        raise SettingsError(
            f"--curvature is '{text}'; expected auto, peak, constant or a number below 1"
        )
    return number


def _choose_law(
    request: CalibrationRequest,
    samples: SlipSamples,
    cell: LoadCell,
    rng: np.random.Generator,
    watcher: Watcher,
) -> tuple[PreparedFit, Comparison | None]:
    laws = _candidates(request, samples)
    fits: list[PreparedFit] = []
    asked = request.block_length
    choice = None if asked is None else BlockChoice(asked, None, "the length asked for")
    for name, law in laws.items():
        watcher.step(f"preparing: {name}", None)
        if watcher.stop_requested():
            raise Stopped(None)
        fit = prepare_fit(
            samples, law, load_cell=cell, rng=rng, block_choice=choice, threads=request.threads
        )
        choice = fit.block_choice  # laws are compared on the same blocks
        fits.append(fit)
    if len(fits) == 1:
        return fits[0], None
    comparison = compare(list(laws), fits)
    return fits[comparison.chosen], comparison


def _sample(
    request: CalibrationRequest,
    fit: PreparedFit,
    earlier: Chains | None,
    mark: str,
    rng: np.random.Generator,
    watcher: Watcher,
) -> tuple[Chains, Convergence]:
    """Walk until converged or out of steps, with a checkpoint every few seconds."""
    density = fit.posterior.log_density
    chains = earlier or start_chains(
        density, fit.approximation, ensembles=request.ensembles, thin=THIN, rng=rng
    )
    most = max(request.max_steps // chains.thin, FIRST_LOOK)
    threads = 1 if len(fit.posterior.blocks) < FEW_BLOCKS else request.threads
    look, saved = _look_from(chains.n_steps - CHUNK + 1), time.monotonic()
    watcher.step("sampling", 0.0)
    while True:
        if chains.n_steps >= min(look, most):
            convergence = assess(chains)
            if convergence.converged or chains.n_steps >= most:
                return chains, convergence
            fraction = max(convergence.fraction_done(), chains.n_steps / most)
            watcher.step("sampling", fraction)
            look = _look_from(chains.n_steps + 1)
        if watcher.stop_requested():
            raise Stopped(save_checkpoint(request.out, chains, fingerprint=mark))
        chains = advance(
            density, chains, steps=CHUNK, approximation=fit.approximation, threads=threads
        )
        if time.monotonic() - saved > CHECKPOINT_SECONDS:
            save_checkpoint(request.out, chains, fingerprint=mark)
            saved = time.monotonic()


def _look_from(n_steps: int) -> int:
    """Return the first of the fixed steps, each a fifth beyond the last, at which to judge.

    Fixed, so that a fit that was stopped and resumed ends where one that was not would have.
    """
    look = FIRST_LOOK
    while look < n_steps:
        look = int(look * 1.2)
    return look


def _conclude(
    fit: PreparedFit,
    comparison: Comparison | None,
    chains: Chains,
    convergence: Convergence,
    data: RigData,
    seconds: float,
    rng: np.random.Generator,
) -> Calibration:
    posterior, samples = fit.posterior, data.samples
    draws = thin_draws(posterior, chains, convergence, n=DRAWS_PER_ENSEMBLE)
    some = draws.flat[:: max(1, len(draws.flat) // 400)]
    residuals = analyse_residuals(posterior.blocks, posterior.law, some)
    weighted = importance_draws(
        posterior.log_density, fit.approximation, n=IMPORTANCE_DRAWS, rng=rng
    )
    narrowed = contraction(posterior, draws)
    levels = load_levels(posterior.blocks)
    k = len(posterior.law.parameters)
    validation = fit.cross_validation
    return Calibration(
        fit=fit,
        comparison=comparison,
        draws=draws,
        parameters=[
            estimate(parameter, draws.flat[:, i])
            for i, parameter in enumerate(posterior.parameters)
        ],
        levels=levels,
        curves=[
            curve_estimates(posterior.law, draws.flat[:, :k], load=load, slip_limit=float(limit))
            for load, limit in zip(levels, largest_slips(posterior.blocks), strict=True)
        ],
        convergence=convergence,
        residuals=residuals,
        agreement=agreement(draws, weighted),
        verdict=judge(
            blocks=posterior.blocks,
            law=posterior.law,
            values=some,
            contraction=narrowed,
            convergence=convergence,
            residuals=residuals,
            offset_scale=fit.load_cell.zero_stability,
        ),
        contraction=narrowed,
        r_squared=None
        if validation is None
        else r_squared(samples.traction_force, validation.predict(samples, posterior.law)),
        source=data.source,
        seconds=seconds,
    )


def _write(request: CalibrationRequest, calibration: Calibration, inputs: dict[str, str]) -> None:
    settings = {**request.decisive(), "load_cell": asdict(calibration.fit.load_cell)}
    content = {"source": calibration.source, "settings": settings, "inputs": inputs}
    with result_folder(request.out, CALIBRATION, content=content) as folder:
        write_tables(folder, calibration, inputs=inputs)
        draw_calibration(folder, calibration)
