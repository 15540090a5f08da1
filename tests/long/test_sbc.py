# SPDX-License-Identifier: MIT
"""Ranks of true values are uniform for the full data model, and not for one that forgets noise.

Simulation-based calibration, Talts et al. (2018), "Validating Bayesian inference algorithms with
simulation-based calibration": where parameters are drawn from the prior and data from the model,
the rank of each true value among independent posterior draws is uniform.

The layout is a sweep of 10 slip ratios of both signs at three loads, 30 runs of 0.4 s. Parameters
of law, load cell, radii, rolling resistance, noise and offsets are drawn from the default priors,
whose scales are fixed by the layout: those of each replicate's own data would not be the priors
that its truth was drawn from.
"""

import os
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache, partial
from multiprocessing import get_context

import numpy as np
import pytest
from scipy.stats import chisquare, kstest

from model.bayes.approximation import starting_points, straightened
from model.bayes.averaging.blocks import block_means
from model.bayes.drawing.tails import approximate
from model.bayes.drawing.weighted import weighted_draws
from model.bayes.fit import not_identified
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.errors import FitError
from model.slip.rig_errors import USUAL
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.plain_samples import fit_blocks
from support.simulated_blocks import simulate_blocks
from support.simulated_sweep import simulate_sweep

pytestmark = [pytest.mark.long, pytest.mark.timeout(5400)]

REPLICATES = 200
PLAN = SweepPlan(
    slips=tuple(np.linspace(-0.3, 1.0, 10).tolist()), loads=(3.0, 8.0, 13.0), duration=0.4
)
BLOCK = 20  # samples
LOAD_CELL = LoadCell(zero_stability=0.1, gain_sd=0.005, bias_sd=0.05, crosstalk_sd=0.005)
FORGETFUL = {"noise_correlation": 0.0, "offset_spread": 0.0}
RANKED = 99  # draws that a true value is ranked among
BINS = 20  # of ranks, ten in each on average
DRAWS, ENOUGH, LEAST = 4000, 2000.0, 400.0  # of the fit; effective ones aimed at, and needed
STARTS = 5  # of searches for modes


@cache
def posterior(**fixed: float) -> SlipPosterior:
    rng = np.random.default_rng(0)
    sweep = simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=PLAN, imperfections=TYPICAL_RIG, rng=rng)
    blocks = block_means(sweep.samples, BLOCK)
    priors = default_priors(THESIS_LAW, blocks, LOAD_CELL, USUAL)
    return SlipPosterior(blocks, THESIS_LAW, priors, {**not_identified(blocks), **fixed})


def drawn(prior: SlipPosterior, rng: np.random.Generator) -> np.ndarray:
    """Draw all parameters from the prior, where these are a curve of the law."""
    while True:
        z = rng.standard_normal((1, len(prior.free)))
        if np.isfinite(prior.log_prior(z)[0]):
            return prior.values(z)[0]


def ranks(index: int, fixed: dict[str, float]) -> dict[str, int] | None:
    """Return the rank of each true value; None where the fit cannot be weighed, by the data."""
    rng = np.random.default_rng([1, index])
    truth = drawn(posterior(), rng)
    blocks = simulate_blocks(posterior().blocks, THESIS_LAW, truth, rng=rng)
    fitted = replace(posterior(**fixed), blocks=blocks)
    try:
        plain = fit_blocks(blocks, THESIS_LAW, priors=fitted.priors, zero_sd=0.01, rng=rng)
        starts = starting_points(fitted, plain, rng)[:STARTS]
        fitted, modes = straightened(fitted, approximate(fitted.log_density, starts), rng)
        found = weighted_draws(fitted.log_density, modes, n=DRAWS, wanted=ENOUGH, rng=rng)
    except (FitError, np.linalg.LinAlgError, ArithmeticError):
        return None
    if not found.reliable or found.effective_size < LEAST:
        return None
    below = np.sum(fitted.values(found.resample(RANKED, rng=rng)) < truth, axis=0)
    names = [p.name for p in fitted.parameters]
    return {name: int(n) for name, n in zip(names, below, strict=True) if name not in fitted.fixed}


def p_values(fixed: dict[str, float]) -> dict[str, tuple[float, float]]:
    """Return p of chi-square and Kolmogorov-Smirnov of the ranks of each parameter, and print."""
    with ProcessPoolExecutor(os.cpu_count(), get_context("spawn")) as pool:
        found = [each for each in pool.map(partial(ranks, fixed=fixed), range(REPLICATES)) if each]
    say(f"\n\n{len(found)} of {REPLICATES} fits ranked; p of chi-square and Kolmogorov-Smirnov\n")
    assert len(found) >= 0.9 * REPLICATES
    rng, tested = np.random.default_rng(0), {}
    for name in found[0]:
        column = np.array([each[name] for each in found])
        counts = np.bincount(column * BINS // (RANKED + 1), minlength=BINS)
        within = (column + rng.random(len(column))) / (RANKED + 1)
        tested[name] = float(chisquare(counts).pvalue), float(kstest(within, "uniform").pvalue)
        say(f"| {name} | {tested[name][0]:.2g} | {tested[name][1]:.2g} |")
    return tested


def say(line: str) -> None:
    print(line, flush=True)  # noqa: T201 the table is what `make test-long` is run for


def test_ranks_of_the_full_data_model_are_uniform():
    found = p_values({})
    limit = 0.01 / (2 * len(found))  # 1 % for all tests together
    assert {name: p for name, p in found.items() if min(p) < limit} == {}


def test_a_model_without_memory_and_offsets_is_found_out():
    found = p_values(FORGETFUL)
    assert min(chi_square for chi_square, _ in found.values()) < 1e-6
    assert min(uniform for _, uniform in found.values()) < 1e-6
