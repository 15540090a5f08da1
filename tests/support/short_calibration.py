# SPDX-License-Identifier: MIT
"""A finished fit of few samples and steps, made once, and its folder."""

import json
from dataclasses import asdict
from functools import cache
from pathlib import Path

import numpy as np

from model.bayes.calibration import Calibration, conclude
from model.bayes.drawing.convergence import assess
from model.bayes.drawing.sampler import Jumps, advance, start_chains
from model.bayes.drawing.weighted import importance_draws
from model.bayes.estimate import thin_draws
from model.bayes.fit import prepare_fit
from model.bayes.posterior import LoadCell
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.quick_fits import few_starts
from support.simulated_sweep import simulate_sweep
from zebro_lab.calibration.folder import write_tables


@cache
@few_starts()
def short_calibration() -> Calibration:
    """Fit a simulated sweep at two loads with 40 steps; it is far from converged."""
    rng = np.random.default_rng(2)
    plan = SweepPlan(slips=tuple(np.linspace(0.005, 0.3, 8)), loads=(4.0, 12.0), rate=40.0)
    samples = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng
    ).samples
    fit = prepare_fit(samples, THESIS_LAW, load_cell=LoadCell(), rng=rng)
    density = fit.posterior.log_density
    chains = start_chains(density, fit.approximation, ensembles=2, thin=5, rng=rng)
    chains = advance(
        density, chains, steps=40, jumps=Jumps(fit.approximation.distribution, 0.3), threads=1
    )
    convergence = assess(chains)
    weighted = importance_draws(density, fit.approximation, n=2000, rng=rng)
    return conclude(
        fit, None, thin_draws(fit.posterior, chains, convergence, n=1000), convergence, samples,
        weighted=weighted, source="sim:test", seconds=1.5,
    )  # fmt: skip


def calibration_folder(folder: Path, **settings) -> Path:
    """Write a calibration of a short fit with what `rig suggest` reads of it."""
    folder.mkdir()
    calibration = short_calibration()
    write_tables(folder, calibration, inputs={})
    known = {"load_cell": asdict(calibration.fit.load_cell),
             "rig_errors": asdict(calibration.fit.rig_errors)}  # fmt: skip
    content = {"schema": 1, "kind": "calibration", "settings": {**known, **settings}}
    (folder / "manifest.json").write_text(json.dumps(content))
    return folder
