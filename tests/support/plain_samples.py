# SPDX-License-Identifier: MIT
"""Samples of a known curve in the two forms that a plain fit tells apart, and their fit."""

import numpy as np

from model.bayes.averaging.blocks import block_means
from model.bayes.plain.fit import PlainFit, plain_fit
from model.bayes.plain.rows import PlainRows
from model.bayes.plain.search import Search
from model.bayes.posterior import LoadCell, default_priors
from model.slip import MagicFormula, SlipDefinition
from model.slip.samples import SlipSamples

LAW, TRUTH = MagicFormula("constant"), np.array([20.0, 1.5, 0.4, -0.1])


def drawn(slip, load, *, noise=0.01, seed=0, zero=0.0, offset=0.0, a_run=0.0):
    """Return samples of runs with slips and loads of shape (runs, samples)."""
    rng = np.random.default_rng(seed)
    force = LAW.force(slip - zero * (1 - slip), load, TRUTH) + offset
    force = force + a_run * rng.standard_normal((len(slip), 1))
    return SlipSamples(
        slip.ravel(), load.ravel(), (force + noise * rng.standard_normal(slip.shape)).ravel(),
        np.repeat(np.arange(len(slip)), slip.shape[1]), tuple(map(str, range(len(slip)))),
        SlipDefinition.MATERIAL,
    )  # fmt: skip


def set_points(n=24, samples=20, **more):
    slip = np.repeat(np.append(-np.geomspace(0.005, 0.5, n // 2), np.geomspace(0.005, 0.5, n // 2)),
                     samples).reshape(n, samples)  # fmt: skip
    load = np.where(np.arange(n) % 3, 4.0, 10.0)[:, None] + 0 * slip
    return drawn(slip, load, **more)


def sweeps(runs=6, samples=300, **more):
    slip = np.tile(np.linspace(-0.3, 0.3, samples), (runs, 1))
    return drawn(slip, np.repeat([[4.0], [10.0]], runs // 2, axis=0) + 0 * slip, **more)


def fitted_plainly(samples, *, seed=1):
    priors = default_priors(LAW, block_means(samples, 10), LoadCell())
    return plain_fit(
        samples, LAW, priors=priors, zero_sd=0.01, rng=np.random.default_rng(seed)
    )  # fmt: skip


def fit_blocks(blocks, law, *, priors, zero_sd, rng):
    """Fit a slip law plainly to block means, as `plain_fit` does to samples."""
    rows = PlainRows(
        blocks.slip, blocks.normal_force, blocks.traction_force, blocks.run, blocks.definition
    )
    problem = Search(law, [priors[p.name] for p in law.parameters], zero_sd, rows)
    problem, x = problem.refined(problem.best_of_starts(rng))
    zero = float(x[-1] * zero_sd)
    return PlainFit(law, problem.values(x), zero, problem.offset(x), problem.rows, problem, x, 0)
