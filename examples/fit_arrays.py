# SPDX-License-Identifier: MIT
"""Fit a slip law to arrays, without files and without emcee: mode, Laplace, importance sampling.

The arrays are SIMULATED here. Usage: .venv/bin/python examples/fit_arrays.py
"""

import numpy as np

from model.bayes.estimate import estimate
from model.bayes.fit import prepare_fit
from model.bayes.laplace import importance_draws
from model.bayes.posterior import LoadCell
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.sweep import SweepPlan, simulate_sweep
from rig.slip_rig.sweep import draw_imperfections as draw_rig

rng = np.random.default_rng(7)
plan = SweepPlan(slips=tuple(np.linspace(0.0, 1.0, 21)), loads=(2.13, 6.63, 12.75), duration=0.5)
sweep = simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=draw_rig(rng), rng=rng)
samples = sweep.samples  # yours: SlipSamples(slip, normal_force, traction_force, run, ...)

load_cell = LoadCell(zero_stability=0.1)
fit = prepare_fit(samples, THESIS_LAW, load_cell=load_cell, rng=rng, validate=False)
print(f"{len(fit.posterior.blocks)} block means, length set by {fit.block_choice.reason}")

density = fit.posterior.log_density
weighted = importance_draws(density, fit.approximation, n=2000, rng=rng)
print(f"Pareto k {weighted.pareto_k:.2f} (above 0.7 the weights are not to be trusted)")

values = fit.posterior.values(weighted.resample(2000, rng=rng))
for i, (parameter, truth) in enumerate(zip(THESIS_LAW.parameters, THESIS_VALUES, strict=True)):
    e = estimate(parameter, values[:, i])
    print(f"{parameter.name:<20} {e.median:8.4g}  ({e.low:.4g} … {e.high:.4g})  truth {truth:.4g}")
