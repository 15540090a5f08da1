# SPDX-License-Identifier: MIT
"""Print the evidence that the decision records quote.

Usage: python -m benchmarks.accuracy.decision_evidence {snooker,pooling,crosstalk,bump} [SEEDS]

`pooling`, `crosstalk` and `bump` fit simulated sweeps by the Laplace approximation, with one idea
of the likelihood changed at a time, and compare with the truth. Everything is simulated.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any

import emcee
import numpy as np
from emcee.moves import DEMove, DESnookerMove, StretchMove
from scipy.stats import chi2

from model.bayes import blocks as block_module
from model.bayes import likelihood as likelihood_module
from model.bayes import slip_noise
from model.bayes.blocks import SlipBlocks
from model.bayes.laplace import find_mode
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.slip.law import Array, SlipLaw
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG, lag_one_correlation
from rig.slip_rig.sweep import RigImperfections, SweepPlan, draw_imperfections, simulate_sweep

BLOCK_LENGTH = 21  # samples; `calibrate-slip datasets/rig-sim` chooses as much
JUDGED = (*(p.name for p in THESIS_LAW.parameters),
          "gain_traction", "gain_normal", "bias_normal", "crosstalk")  # fmt: skip


def snooker(seeds: int) -> None:
    """Sample a 12-dimensional standard Gaussian, whose spread is 1."""
    print(f"emcee {emcee.__version__}, 12 dimensions, 36 walkers, 20000 steps, {seeds} seeds")
    kinds = {
        "DEMove 0.8 + DESnookerMove 0.2": [(DEMove(), 0.8), (DESnookerMove(), 0.2)],
        "DEMove": [(DEMove(), 1.0)],
        "StretchMove": [(StretchMove(), 1.0)],
    }
    for name, moves in kinds.items():
        spreads, times = zip(*(_sample_gaussian(moves, s) for s in range(seeds)), strict=True)
        print(
            f"{name:<32} standard deviation {np.mean(spreads):.3f}, "
            f"autocorrelation time {np.mean(times):.0f} steps"
        )


def _sample_gaussian(moves: list[Any], seed: int) -> tuple[float, float]:
    np.random.seed(seed)  # noqa: NPY002 (emcee reads the legacy state)
    sampler = emcee.EnsembleSampler(
        36, 12, lambda z: -0.5 * np.sum(z**2, axis=1), moves=moves, vectorize=True
    )
    sampler.run_mcmc(np.random.standard_normal((36, 12)), 20_000)  # noqa: NPY002
    time = float(np.mean(sampler.get_autocorr_time(quiet=True)))
    return float(np.std(np.asarray(sampler.get_chain(discard=1000, flat=True)))), time


def pooling(seeds: int) -> None:
    """Judge the calibration of slips, with the noise of the force at its true values."""
    fit = partial(_scores, true_noise=True)
    _print_scores("slip noise pooled between runs", seeds, fit)
    with _no_pooling():
        _print_scores("not pooled", seeds, fit)
    _print_scores("true slip given", seeds, partial(fit, true_slip=True))


def crosstalk(seeds: int) -> None:
    """Judge which traction crosstalk puts into the load, everything free."""
    _print_scores("expected traction", seeds, _scores)
    with _measured_traction():
        _print_scores("measured traction", seeds, _scores)


def bump(seeds: int) -> None:
    """Judge blocks that hold a bump of the load, at 1 kHz, the load cell perfect and known so."""
    plan = SweepPlan(duration=4.0, rate=1000.0)
    truth = replace(TYPICAL_RIG, offset_sd=0.1, noise_correlation_time=-0.001 / np.log(0.98))
    known = dict.fromkeys(JUDGED[4:], 0.0)
    for length in (333, 160, 80):
        scores = []
        for seed in range(seeds):
            rng = np.random.default_rng(seed)
            sweep = simulate_sweep(
                THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=truth, rng=rng
            )
            blocks = block_module.block_means(sweep.samples, length)
            priors = default_priors(THESIS_LAW, blocks, LoadCell())
            posterior = SlipPosterior(blocks, THESIS_LAW, priors, known)
            values = dict(zip(JUDGED, THESIS_VALUES, strict=False))
            start = posterior.coordinates({**values, "noise_floor": 0.01, "offset_spread": 0.1})
            laplace = find_mode(posterior.log_density, start[None])
            spread = np.sqrt(np.diag(laplace.covariance))
            scores.append(((laplace.mode - start) / spread)[:4])
        means = " ".join(f"{z:+.2f}" for z in np.mean(scores, axis=0))
        print(f"{length:>4} samples a block: mean z of K, C, mu, x_m/Fn {means} ({seeds} sweeps)")


def _print_scores(name: str, seeds: int, fit: Callable[[int], tuple[float, float, float]]) -> None:
    z, crosstalk, joint = (np.array(x) for x in zip(*map(fit, range(seeds)), strict=True))
    p = chi2.sf(joint.sum(), seeds * len(JUDGED))
    print(
        f"{name:<32} z of slip stiffness: mean {z.mean():+.2f}, sd {z.std():.2f}; crosstalk's mode "
        f"{crosstalk.mean():+.4f}; joint chi-square p = {p:.1e} ({seeds} sweeps)"
    )


def _scores(
    seed: int, *, true_slip: bool = False, true_noise: bool = False
) -> tuple[float, float, float]:
    """Return the z-score of slip stiffness, crosstalk's posterior mode and the joint chi-square."""
    rng = np.random.default_rng(seed)
    truth = draw_imperfections(rng)
    sweep = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=SweepPlan(), imperfections=truth, rng=rng
    )
    slip = sweep.slip_true if true_slip else sweep.samples.slip
    blocks = block_module.block_means(replace(sweep.samples, slip=slip), BLOCK_LENGTH)
    priors = default_priors(THESIS_LAW, blocks, LoadCell(zero_stability=0.1))
    noise = _block_noise(truth)
    posterior = SlipPosterior(blocks, THESIS_LAW, priors, noise if true_noise else {})
    true_values = dict(zip(JUDGED, THESIS_VALUES, strict=False))
    true_values |= {name: getattr(truth, name) for name in JUDGED[4:]}
    start = posterior.coordinates({**true_values, **noise})
    laplace = find_mode(posterior.log_density, start[None])
    judged = [i for i, p in enumerate(posterior.free) if p.name in JUDGED]
    error = laplace.mode[judged] - start[judged]
    covariance = laplace.covariance[np.ix_(judged, judged)]
    return (
        float(error[0] / np.sqrt(covariance[0, 0])),
        float(priors["crosstalk"].value(laplace.mode[judged[-1]])),
        float(error @ np.linalg.solve(covariance, error)),
    )


def _block_noise(truth: RigImperfections) -> dict[str, float]:
    """Return what the noise of the samples is for means of blocks."""
    rho = lag_one_correlation(1 / SweepPlan().rate, truth.noise_correlation_time)
    n = np.arange(BLOCK_LENGTH)
    within = np.sum(rho ** np.abs(n[:, None] - n))
    across = np.sum(rho ** (BLOCK_LENGTH + n[:, None] - n))
    shrunk = np.sqrt(within) / BLOCK_LENGTH
    return {
        "noise_floor": truth.noise_sd0 * shrunk,
        "noise_slope": truth.noise_sd1 * shrunk,
        "noise_correlation": float(across / within),
        "offset_spread": truth.offset_sd,
    }


@contextmanager
def _no_pooling() -> Iterator[None]:
    """Let every run keep its own estimate of slip noise and wander."""
    pooled = slip_noise.own_share
    slip_noise.own_share = lambda estimates, sampling_variance, typical: np.ones_like(estimates)
    try:
        yield
    finally:
        slip_noise.own_share = pooled


@contextmanager
def _measured_traction() -> Iterator[None]:
    """Put the measured traction into the load, with no Jacobian."""
    whole = likelihood_module.predict_blocks

    def changed(
        blocks: SlipBlocks, law: SlipLaw, values: Array
    ) -> likelihood_module.PredictedForces:
        k = len(law.parameters)
        gain, crosstalk = 1 + values[:, k + 1, None], values[:, k + 3, None]
        load = blocks.normal_force + crosstalk * blocks.traction_force / gain
        without = values.copy()
        without[:, k + 3] = 0.0
        return whole(replace(blocks, normal_force=load), law, without)

    likelihood_module.predict_blocks = changed
    try:
        yield
    finally:
        likelihood_module.predict_blocks = whole


if __name__ == "__main__":
    _, what, *rest = sys.argv
    commands = {"snooker": snooker, "pooling": pooling, "crosstalk": crosstalk, "bump": bump}
    commands[what](int(rest[0]) if rest else 20)
