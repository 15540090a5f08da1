# SPDX-License-Identifier: MIT
"""Time the calibration beside its peers, in one run: `make bench`.

Prints the tables of docs/benchmarks.md. All data are simulated: the bundled sweep's plan, 248 runs
of one second at 250 Hz, and for reading the same sweep with four seconds at 1 kHz a run.
"""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from emcee.moves import DEMove, StretchMove
from scipy.stats import norm

from benchmarks.machine import describe_machine
from benchmarks.speed.calibration_emcee import (
    ENSEMBLES,
    IMPORTANCE_DRAWS,
    ensembles,
    naive,
    numpy_log_likelihood,
    scipy_log_likelihood,
)
from benchmarks.speed.sampled import Sampled
from benchmarks.tables import print_table
from model.arrays import Array
from model.bayes.drawing.weighted import importance_draws
from model.bayes.fit import PreparedFit, prepare_fit
from model.bayes.likelihood import log_likelihood
from model.bayes.posterior import LoadCell, SlipPosterior
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import draw_imperfections
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import SimulatedSweep, simulate_sweep
from zebro_lab.calibration.rig_data import read_rig_data

SEED = 2020
SWEEP, READ = SweepPlan(), SweepPlan(duration=4.0, rate=1000.0)
LOAD_CELL = LoadCell(zero_stability=0.1, gain_sd=0.005, bias_sd=0.05, crosstalk_sd=0.005)
BATCH = 48  # parameter vectors: the walkers of an ensemble of 16 dimensions
KEPT_STEPS = 150
LONGER = 4  # kept steps of the stretch move, over `KEPT_STEPS`: fewer tell too little of it
NAIVE_SECONDS = 30.0  # of each naive run
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

    plain = (scipy_log_likelihood, numpy_log_likelihood)
    dense = np.array([[each(posterior, row) for row in values[:5]] for each in plain])
    apart = np.max(np.abs(ours(values[:5]) - dense))
    rates = [
        (f"ours, {BATCH} vectors at once", of_blocks, rate(lambda: ours(values), each=BATCH)),
        ("ours, one vector at a time", of_blocks, rate(lambda: ours(values[:1]), each=1)),
        (
            "scipy multivariate_normal, a run at a time", of_blocks,
            rate(lambda: scipy_log_likelihood(posterior, values[0]), each=1),
        ),
        (
            "numpy, dense covariances of all runs in one call", of_blocks,
            rate(lambda: numpy_log_likelihood(posterior, values[0]), each=1),
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
        f"Ours and the dense ones of scipy and numpy differ by {apart:.1e} at most, of "
        f"{abs(dense[0, 0]):,.0f}, at five posterior draws.\n"
    )


def importance(fit: PreparedFit) -> Sampled:
    """Weight draws of the Laplace approximation; their effective sample size is Kish's."""
    began = time.perf_counter()
    weighted = importance_draws(
        fit.posterior.log_density,
        fit.approximation,
        n=IMPORTANCE_DRAWS,
        rng=np.random.default_rng(SEED),
    )
    seconds = time.perf_counter() - began
    return Sampled(weighted.effective_size, seconds, f"Pareto k {weighted.pareto_k:.2f}")


def time_samplers(fit: PreparedFit) -> None:
    """Print effective samples a second by kind of sampler, and our ratio to each peer."""
    weighted = importance(fit)
    walked = {
        f"emcee {move.__name__}{' and jumps' * jumps}, {ENSEMBLES} ensembles, 2 threads": ensembles(
            fit, move, jumps=jumps, steps=KEPT_STEPS * longer, seed=SEED
        )
        for move, jumps, longer in (
            (DEMove, True, 1), (DEMove, False, 1), (StretchMove, False, LONGER),
        )
    }  # fmt: skip
    figures = {name: found for name, (found, _) in walked.items()}
    ours, *_, stretch = figures
    per_evaluation = walked[stretch][1]
    peers = {"emcee's default move with our density": figures[stretch]}
    for library, likelihood in (("scipy", scipy_log_likelihood), ("numpy", numpy_log_likelihood)):
        found = naive(fit, likelihood, seconds=NAIVE_SECONDS, per_evaluation=per_evaluation)
        figures[f"naive emcee, {library}, 1 thread"] = found
        peers[f"naive emcee with {library}'s dense likelihood (100 are asked)"] = found
    figures["Laplace + PSIS, 1 thread"] = weighted
    print_table(
        ("engine", "effective samples", "seconds", "effective samples a second", "R-hat"),
        *(found.cells(name) for name, found in figures.items()),
    )
    print(
        f"The posterior of {len(fit.laplace.mode)} parameters and {len(fit.posterior.blocks):,} "
        "blocks. Effective samples are the bulk's of the worst parameter, Kish's for PSIS. All "
        "start from the Laplace approximation; seconds count everything from there on, also "
        "burn-in and the weighted draws that decide how many moves are jumps.\n"
    )
    print(
        "Naive emcee is emcee's default move from a ball around the optimum, one parameter vector "
        "a call, with a dense likelihood. In so short a time it does not forget its start: its "
        "effective samples are its evaluations in that time, each worth what it is in the row of "
        "StretchMove after the burn-in.\n"
    )
    print_table(
        ("effective samples a second of ours, the first row, over those of", "ratio"),
        *((name, f"{figures[ours].rate / peer.rate:,.0f}") for name, peer in peers.items()),
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
