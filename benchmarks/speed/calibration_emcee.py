# SPDX-License-Identifier: MIT
"""The calibration's posterior sampled by emcee: as the product does it, and as a first script.

The first script, naive emcee, has the same data model and no special care: emcee's default move
from a ball around the optimum, one parameter vector a call, and a likelihood with a dense
covariance a run, by scipy or by numpy.
"""

import sys
import time
from collections.abc import Callable
from itertools import pairwise

import emcee
import numpy as np
from emcee.moves import StretchMove
from scipy.stats import multivariate_normal

from benchmarks.speed.sampled import Sampled
from model.arrays import Array
from model.bayes.calibrate import EFFECTIVE_DRAWS, THIN
from model.bayes.drawing import sampler
from model.bayes.drawing.convergence import assess
from model.bayes.drawing.jumps import choose_jumps
from model.bayes.drawing.sampler import Jumps, walker_count
from model.bayes.drawing.weighted import weighted_draws
from model.bayes.fit import PreparedFit
from model.bayes.likelihood import predict_blocks, slip_errors
from model.bayes.posterior import SlipPosterior

ENSEMBLES, THREADS = 4, 2
IMPORTANCE_DRAWS = 10_000
BALL = 0.01  # standard deviation of naive walkers' starts in each coordinate, 1 before the data

DenseLogLikelihood = Callable[[SlipPosterior, Array], float]


def chosen_jumps(fit: PreparedFit, rng: np.random.Generator) -> Jumps:
    """Return the jumps that `calibrate` chooses, by weighted draws."""
    weighted = weighted_draws(
        fit.posterior.log_density, fit.approximation, n=IMPORTANCE_DRAWS, wanted=EFFECTIVE_DRAWS,
        rng=rng, threads=THREADS,
    )  # fmt: skip
    return choose_jumps(
        fit.posterior.log_density, fit.approximation, weighted, rng=rng, threads=THREADS
    )


def ensembles(
    fit: PreparedFit, move: type, *, jumps: bool, steps: int, seed: int
) -> tuple[Sampled, float]:
    """Walk emcee ensembles with one kind of move, with or without jumps.

    With jumps the weighted draws that these are fitted to are part of the time.

    Args:
        fit: The fit.
        move: The move of emcee.
        jumps: Whether some moves jump to draws of a mixture that is fitted to the posterior.
        steps: Number of kept steps, of `THIN` moves each.
        seed: Seed of the random generators.

    Returns:
        What was drawn, and effective samples for each evaluation of the density after the burn-in.
    """
    ours, sampler.MOVES = sampler.MOVES, ((move, 1.0),)
    try:
        density, rng = fit.posterior.log_density, np.random.default_rng(seed)
        began = time.perf_counter()
        chosen = chosen_jumps(fit, rng) if jumps else None
        chains = sampler.start_chains(
            density, fit.approximation, ensembles=ENSEMBLES, thin=THIN, rng=rng
        )
        chains = sampler.advance(density, chains, steps=steps, jumps=chosen, threads=THREADS)
        seconds = time.perf_counter() - began
    finally:
        sampler.MOVES = ours
    convergence = assess(chains)
    effective = float(convergence.ess_bulk.min())
    walkers = chains.z.shape[2]
    evaluations = ENSEMBLES * walkers * THIN * convergence.length
    found = Sampled(effective, seconds, f"{convergence.r_hat.max():.3f}")
    return found, effective / evaluations


def scipy_log_likelihood(posterior: SlipPosterior, values: Array) -> float:
    """Compute our likelihood the plain way: one multivariate normal a run, its covariance dense."""
    blocks = posterior.blocks
    predicted = predict_blocks(blocks, posterior.law, values[None])
    rho, tau = values[-2:]
    own, shared = slip_errors(blocks, values)
    total = 0.0
    starts = blocks.run_starts()
    for i, (first, end) in enumerate(pairwise(starts)):
        part = slice(first, end)
        noise, slope = predicted.noise[0, part], predicted.slope[0, part]
        load_slope = predicted.load_slope[0, part]
        lag = np.abs(np.subtract.outer(np.arange(len(noise)), np.arange(len(noise))))
        covariance = (
            np.outer(noise, noise) * rho**lag
            + np.diag(slope**2 * own[part] + load_slope**2 * blocks.load_error[part])
            + np.outer(slope, slope) * shared[i]
            + tau**2 * (1 + np.outer(load_slope, load_slope))
        )
        residual = blocks.traction_force[part] - predicted.force[0, part]
        total += float(multivariate_normal.logpdf(residual, cov=covariance))
    return total


def numpy_log_likelihood(posterior: SlipPosterior, values: Array) -> float:
    """Compute the same with one call of numpy for the covariances of all runs, of equal length."""
    blocks = posterior.blocks
    predicted = predict_blocks(blocks, posterior.law, values[None])
    rho, tau = values[-2:]
    own, shared = slip_errors(blocks, values)
    own = predicted.slope**2 * own + predicted.load_slope**2 * blocks.load_error
    residual, noise, slope, load_slope, own = (
        each.reshape(blocks.n_runs, -1)
        for each in (
            blocks.traction_force - predicted.force, predicted.noise, predicted.slope,
            predicted.load_slope, own,
        )
    )  # fmt: skip
    size = residual.shape[1]
    lag = np.abs(np.subtract.outer(np.arange(size), np.arange(size)))
    covariance = (
        noise[:, :, None] * noise[:, None, :] * rho**lag
        + own[:, :, None] * np.eye(size)
        + slope[:, :, None] * slope[:, None, :] * shared[:, None, None]
        + tau**2 * (1 + load_slope[:, :, None] * load_slope[:, None, :])
    )
    _, log_determinant = np.linalg.slogdet(covariance)
    white = np.linalg.solve(covariance, residual[:, :, None])[:, :, 0]
    quadratic = np.sum(residual * white)
    return float(-0.5 * (quadratic + log_determinant.sum() + residual.size * np.log(2 * np.pi)))


def naive(
    fit: PreparedFit, likelihood: DenseLogLikelihood, *, seconds: float, per_evaluation: float
) -> Sampled:
    """Time emcee as a first script would call it; effective samples are those expected.

    The time is too short for a chain to forget its start. Its effective samples are evaluations
    times those that the same move gains by each in a long run, after a burn-in: the density is the
    same, and so is the chain but for its start. It has no burn-in to pay for.

    Args:
        fit: The fit.
        likelihood: Log likelihood of one vector of values.
        seconds: Time after which no further move is made, above zero [s].
        per_evaluation: Effective samples that `StretchMove` gains by an evaluation.
    """
    posterior = fit.posterior

    def log_density(z: Array) -> float:
        prior = float(posterior.log_prior(z[None])[0])
        if not np.isfinite(prior):
            return -np.inf
        return prior + likelihood(posterior, posterior.values(z[None])[0])

    d = len(fit.laplace.mode)
    walkers = walker_count(d)
    rng = np.random.default_rng(0)
    ball = fit.laplace.mode + BALL * rng.standard_normal((walkers, d))
    engine = emcee.EnsembleSampler(walkers, d, log_density, moves=StretchMove())
    moves = engine.sample(ball, iterations=sys.maxsize, store=False)
    began, passed = time.perf_counter(), 0.0
    evaluations = walkers  # of the starts
    while passed < seconds:
        next(moves)
        evaluations += walkers
        passed = time.perf_counter() - began
    return Sampled(evaluations * per_evaluation, passed, "")
