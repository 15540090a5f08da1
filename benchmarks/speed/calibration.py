# SPDX-License-Identifier: MIT
"""Time the calibration beside its peers, in one run: `make bench`.

Prints the tables of docs/benchmarks.md. All data are simulated: the bundled sweep's plan, 248 runs
of one second at 250 Hz, and for reading the same sweep with four seconds at 1 kHz a run.
"""

import tempfile
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from emcee.moves import DEMove, StretchMove
from scipy.stats import multivariate_normal, norm

from benchmarks.machine import describe_machine
from benchmarks.speed.calibration_nuts import NUTS_CHAINS, nuts
from benchmarks.tables import print_table
from model.bayes import sampler
from model.bayes.convergence import assess
from model.bayes.fit import PreparedFit, prepare_fit
from model.bayes.likelihood import log_likelihood, predict_blocks, slip_errors
from model.bayes.posterior import LoadCell, SlipPosterior
from model.bayes.samples import SlipSamples
from model.bayes.weighted import importance_draws
from model.slip.law import Array
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.sweep import SimulatedSweep, SweepPlan, draw_imperfections, simulate_sweep
from zebro_lab.calibration.rig_data import read_rig_data

SEED = 2020
SWEEP, READ = SweepPlan(), SweepPlan(duration=4.0, rate=1000.0)
LOAD_CELL = LoadCell(zero_stability=0.1, gain_sd=0.005, bias_sd=0.05, crosstalk_sd=0.005)
BATCH = 36  # parameter vectors: the walkers of an ensemble of 12 dimensions
ENSEMBLES, KEPT_STEPS, THIN = 4, 150, 5
IMPORTANCE_DRAWS = 10_000
READS = 3
COLUMNS = """source = "sim:bench"
[constants]
radius_leg = "35 mm"
radius_ground = "120 mm"
[runs]
by = ["run"]
"""


def simulate(plan: SweepPlan) -> SimulatedSweep:
    """Simulate a sweep of the rig with errors of its own."""
    rng = np.random.default_rng(SEED)
    errors = draw_imperfections(rng)
    return simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=errors, rng=rng)


def rate(evaluate: Callable[[], Any], *, each: int, seconds: float = 3.0) -> float:
    """Return how many parameter vectors a second a function of `each` vectors gets through."""
    evaluate()  # compiles, and warms the caches
    began, calls = time.perf_counter(), 0
    while (passed := time.perf_counter() - began) < seconds:
        evaluate()
        calls += 1
    return calls * each / passed


def dense_log_likelihood(posterior: SlipPosterior, values: Array) -> float:
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
        lag = np.abs(np.subtract.outer(np.arange(len(noise)), np.arange(len(noise))))
        covariance = (
            np.outer(noise, noise) * rho**lag
            + np.diag(slope**2 * own[part])
            + np.outer(slope, slope) * shared[i]
            + tau**2
        )
        residual = blocks.traction_force[part] - predicted.force[0, part]
        total += float(multivariate_normal.logpdf(residual, cov=covariance))
    return total


def independent_log_likelihood(samples: SlipSamples, values: Array) -> float:
    """Compute the likelihood that takes every sample for independent, as a first script would."""
    force = THESIS_LAW.force(samples.slip, samples.normal_force, values[:4])
    noise = values[-4] + values[-3] * np.abs(force)
    return float(norm.logpdf(samples.traction_force, force, noise).sum())


def time_likelihoods(posterior: SlipPosterior, samples: SlipSamples, z: Array) -> None:
    """Print evaluations a second of the likelihood, beside scipy's."""
    values = posterior.values(z)
    blocks, law = posterior.blocks, posterior.law
    of_blocks, of_samples = f"{len(blocks):,} blocks", f"{len(samples):,} samples"

    def ours(some: Array) -> Array:
        return log_likelihood(blocks, law, some)

    dense = [dense_log_likelihood(posterior, row) for row in values[:5]]
    apart = np.max(np.abs(ours(values[:5]) - dense))
    rates = [
        (f"ours, {BATCH} vectors at once", of_blocks, rate(lambda: ours(values), each=BATCH)),
        ("ours, one vector at a time", of_blocks, rate(lambda: ours(values[:1]), each=1)),
        (
            "scipy multivariate_normal, a run at a time", of_blocks,
            rate(lambda: dense_log_likelihood(posterior, values[0]), each=1),
        ),
        (
            "scipy norm, every sample independent (another model)", of_samples,
            rate(lambda: independent_log_likelihood(samples, values[0]), each=1),
        ),
    ]  # fmt: skip
    print_table(
        ("likelihood, one thread", "data", "evaluations a second", "of ours"),
        *((name, data, f"{x:,.0f}", f"{x / rates[0][2]:.2f}") for name, data, x in rates),
    )
    print(
        f"Ours and scipy's dense one differ by {apart:.1e} at most, of {abs(dense[0]):,.0f}, at "
        "five posterior draws.\n"
    )


def ensembles(fit: PreparedFit, move: type, *, jumps: bool) -> tuple[float, float, float]:
    """Walk emcee ensembles with one kind of move, with or without jumps; ESS, seconds, R-hat."""
    ours, sampler.MOVES = sampler.MOVES, ((move, 1.0),)
    try:
        density, rng = fit.posterior.log_density, np.random.default_rng(SEED)
        began = time.perf_counter()
        approximation = fit.approximation
        chains = sampler.start_chains(
            density, approximation, ensembles=ENSEMBLES, thin=THIN, rng=rng
        )
        chains = sampler.advance(
            density, chains, steps=KEPT_STEPS, approximation=approximation if jumps else None
        )
        seconds = time.perf_counter() - began
    finally:
        sampler.MOVES = ours
    convergence = assess(chains)
    return float(convergence.ess_bulk.min()), seconds, float(convergence.r_hat.max())


def importance(fit: PreparedFit) -> tuple[float, float, float]:
    """Weight draws of the Laplace approximation; return Kish's ESS, seconds, Pareto's k."""
    began = time.perf_counter()
    weighted = importance_draws(
        fit.posterior.log_density,
        fit.approximation,
        n=IMPORTANCE_DRAWS,
        rng=np.random.default_rng(SEED),
    )
    seconds = time.perf_counter() - began
    return 1 / float(np.sum(weighted.weights**2)), seconds, weighted.pareto_k


def time_samplers(fit: PreparedFit) -> None:
    """Print effective samples a second by kind of sampler."""
    importance_ess, importance_seconds, pareto_k = importance(fit)
    figures: list[tuple[str, *tuple[float, ...]]] = [
        (
            f"emcee {move.__name__}{' and jumps' * jumps}, {ENSEMBLES} ensembles, 2 threads",
            *ensembles(fit, move, jumps=jumps),
        )
        for move, jumps in ((DEMove, True), (DEMove, False), (StretchMove, False))
    ]
    note = ""
    try:
        *found, apart = nuts(fit, seed=SEED)
        figures.append((f"NumPyro NUTS, {NUTS_CHAINS} chains, JAX with gradients", *found))
        note = f" The density written in JAX differs from ours by {apart:.1e} at most."
    except ImportError as error:
        note = f" No row for NumPyro's NUTS: {error}."
    print_table(
        ("engine", "effective samples", "seconds", "effective samples a second", "R-hat"),
        *((name, f"{n:,.0f}", f"{s:.0f}", f"{n / s:.1f}", f"{r:.3f}") for name, n, s, r in figures),
        (
            "Laplace + PSIS, 1 thread", f"{importance_ess:,.0f}", f"{importance_seconds:.0f}",
            f"{importance_ess / importance_seconds:.1f}", f"Pareto k {pareto_k:.2f}",
        ),
    )  # fmt: skip
    print(
        f"The posterior of {len(fit.laplace.mode)} parameters and {len(fit.posterior.blocks):,} "
        "blocks. Effective samples are the bulk's of the worst parameter, Kish's for PSIS. All "
        "start from the Laplace approximation; seconds count everything from there on, also "
        f"burn-in, NUTS's warm-up and its compilation.{note}\n"
    )


def time_reading(folder: Path, plan: SweepPlan) -> None:
    """Print the time to read a sweep from CSV, beside pandas alone."""
    sweep = simulate(plan)
    file = folder / "sweep.csv"
    pd.DataFrame(sweep.table).to_csv(file, index=False)
    (folder / "columns.toml").write_text(COLUMNS)
    rows = len(sweep.samples)
    readers: dict[str, Callable[[], object]] = {
        "pandas.read_csv alone": lambda: pd.read_csv(file),
        "read_rig_data: read, check, map, separate runs, slip": lambda: read_rig_data([file]),
    }
    timed: dict[str, float] = {}
    for name, read in readers.items():
        seconds = []
        for _ in range(READS):
            began = time.perf_counter()
            read()
            seconds.append(time.perf_counter() - began)
        timed[name] = min(seconds)
    print_table(
        (f"CSV, {rows:,} rows, {file.stat().st_size / 1e6:.0f} MB", "seconds", "rows a second"),
        *((name, f"{s:.2f}", f"{rows / s:,.0f}") for name, s in timed.items()),
    )
    print(f"Best of {READS}.\n")


def main(plan: SweepPlan = SWEEP, read: SweepPlan = READ) -> None:
    """Print the tables: of a sweep that is fitted, and one that is read."""
    began = time.perf_counter()
    print(f"Machine: {describe_machine()}.\n")
    samples = simulate(plan).samples
    rng = np.random.default_rng(SEED)
    fit = prepare_fit(samples, THESIS_LAW, load_cell=LOAD_CELL, rng=rng, validate=False)
    z = rng.multivariate_normal(fit.laplace.mode, fit.laplace.covariance, size=BATCH)
    print("## Likelihood\n")
    time_likelihoods(fit.posterior, samples, z)
    print("## Sampling\n")
    time_samplers(fit)
    print("## Reading\n")
    with tempfile.TemporaryDirectory() as folder:
        time_reading(Path(folder), read)
    print(f"The whole benchmark took {time.perf_counter() - began:.0f} s.")


if __name__ == "__main__":
    main()
