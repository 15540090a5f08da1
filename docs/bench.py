# SPDX-License-Identifier: MIT
"""Time the calibration beside its peers, in one run: `make bench`.

Prints the tables of docs/benchmarks.md. All data are simulated: the bundled sweep's plan, 248 runs
of one second at 250 Hz, and for reading the same sweep with four seconds at 1 kHz a run.
"""

import os
import platform
import tempfile
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import arviz as az
import numpy as np
import pandas as pd
from emcee.moves import DEMove, StretchMove
from scipy.stats import multivariate_normal, norm

from model.bayes import sampler
from model.bayes.convergence import assess
from model.bayes.fit import PreparedFit, prepare_fit
from model.bayes.laplace import importance_draws
from model.bayes.likelihood import load_rule, log_likelihood, predict_blocks
from model.bayes.posterior import LoadCell, SlipPosterior
from model.bayes.priors import HalfNormal, LogNormal, Normal, Prior, Uniform
from model.bayes.samples import SlipSamples
from model.slip.law import Array
from rig.slip_rig.sweep import (
    SOURCE_LAW,
    SOURCE_VALUES,
    SimulatedSweep,
    SweepPlan,
    draw_imperfections,
    simulate_sweep,
)
from zebro_lab.calibration.rig_data import read_rig_data

SEED = 2020
LOAD_CELL = LoadCell(zero_stability=0.1, gain_sd=0.005, bias_sd=0.05, crosstalk_sd=0.005)
BATCH = 36  # parameter vectors: the walkers of an ensemble of 12 dimensions
ENSEMBLES, KEPT_STEPS, THIN = 4, 150, 5
IMPORTANCE_DRAWS = 10_000
NUTS_CHAINS, NUTS_WARM_UP, NUTS_DRAWS = 2, 200, 400
READS = 3
COLUMNS = """source = "sim:bench"
[constants]
radius_leg = "35 mm"
radius_ground = "120 mm"
[runs]
by = ["run"]
"""


def simulate(plan: SweepPlan) -> SimulatedSweep:
    rng = np.random.default_rng(SEED)
    errors = draw_imperfections(rng)
    return simulate_sweep(SOURCE_LAW, SOURCE_VALUES, plan=plan, imperfections=errors, rng=rng)


def table(*rows: tuple[str, ...]) -> None:
    """Print a Markdown table, the first row its head; all columns but the first to the right."""
    head, *body = rows
    rule = ("---", *("---:" for _ in head[1:]))
    print("\n".join(f"| {' | '.join(row)} |" for row in (head, rule, *body)), end="\n\n")


def machine() -> str:
    """Describe the machine in a line."""
    described = {"cpu": platform.processor() or platform.machine(), "memory": "unknown"}
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
        described["cpu"] = names[0] if names else described["cpu"]
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        described["memory"] = f"{memory / 2**30:.0f} GiB"
    return (
        f"{os.cpu_count()} cores, {described['cpu']}, {described['memory']} of memory, "
        f"{platform.system()}, Python {platform.python_version()}, numpy {np.__version__}; load "
        f"average before the run {os.getloadavg()[0]:.1f}"
    )


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
    total = 0.0
    starts = blocks.run_starts()
    for i, (first, end) in enumerate(pairwise(starts)):
        part = slice(first, end)
        noise, slope = predicted.noise[0, part], predicted.slope[0, part]
        lag = np.abs(np.subtract.outer(np.arange(len(noise)), np.arange(len(noise))))
        covariance = (
            np.outer(noise, noise) * rho**lag
            + np.diag(slope**2 * blocks.slip_error[part])
            + np.outer(slope, slope) * blocks.run_slip_error[i]
            + tau**2
        )
        residual = blocks.traction_force[part] - predicted.force[0, part]
        total += float(multivariate_normal.logpdf(residual, cov=covariance))
    return total


def independent_log_likelihood(samples: SlipSamples, values: Array) -> float:
    """Compute the likelihood that takes every sample for independent, as a first script would."""
    force = SOURCE_LAW.force(samples.slip, samples.normal_force, values[:4])
    noise = values[8] + values[9] * np.abs(force)
    return float(norm.logpdf(samples.traction_force, force, noise).sum())


def time_likelihoods(posterior: SlipPosterior, samples: SlipSamples, z: Array) -> None:
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
    table(
        ("likelihood, one thread", "data", "evaluations a second", "of ours"),
        *((name, data, f"{x:,.0f}", f"{x / rates[0][2]:.2f}") for name, data, x in rates),
    )
    print(
        f"Ours and scipy's dense one differ by {apart:.1e} at most, of {abs(dense[0]):,.0f}, at "
        "five posterior draws.\n"
    )


def jax_value(prior: Prior, z: Any) -> Any:
    """Map a coordinate to a value as `Prior.value` does, differentiably."""
    import jax.numpy as jnp
    from jax.scipy.special import ndtr, ndtri

    match prior:
        case LogNormal():
            return prior.median * jnp.exp(prior.spread * z)
        case Normal():
            return prior.mean + prior.sd * z
        case Uniform():
            return prior.lower + (prior.upper - prior.lower) * ndtr(z)
        case HalfNormal():
            return -prior.scale * ndtri(ndtr(-z) / 2)
    raise TypeError(f"no JAX version of {prior.describe()}")


def jax_log_density(posterior: SlipPosterior) -> Callable[[Any], Any]:
    """Write the posterior in JAX: the same blocks and model, a dense covariance a run.

    Runs must have the same number of blocks, and the law must be `SOURCE_LAW`.
    """
    import jax.numpy as jnp
    from jax.scipy.linalg import solve_triangular

    blocks = posterior.blocks
    shape = (blocks.n_runs, -1)
    rule = load_rule(blocks)
    spread = np.sqrt(3 * np.maximum(blocks.slip_variance() - rule.slip_variance, 1e-12))
    slip, load, traction, slip_error, spread = (
        jnp.asarray(x.reshape(shape))
        for x in (
            blocks.slip,
            blocks.normal_force,
            blocks.traction_force,
            blocks.slip_error,
            spread,
        )
    )
    light, heavy, share, slip_light, slip_heavy, slip_per_load = (
        jnp.asarray(x.reshape(shape))
        for x in (
            rule.light, rule.heavy, rule.heavy_share,
            rule.slip_light, rule.slip_heavy, rule.slip_per_load,
        )
    )  # fmt: skip
    lag = np.abs(np.subtract.outer(np.arange(slip.shape[1]), np.arange(slip.shape[1])))
    run_slip_error = jnp.asarray(blocks.run_slip_error)[:, None, None]
    priors = [posterior.priors[parameter.name] for parameter in posterior.free]
    check_loads = np.quantile(blocks.normal_force, [0.0, 0.25, 0.5, 0.75, 1.0])

    def curvature(B: Any, C: Any, x_m: Any) -> Any:
        return (B * x_m - jnp.tan(jnp.pi / (2 * C))) / (B * x_m - jnp.arctan(B * x_m))

    def log_density(z: Any) -> Any:
        K, C, mu, x, g_t, g_n, b_n, c, s_0, s_1, rho, tau = (
            jax_value(prior, z[i]) for i, prior in enumerate(priors)
        )
        B = K / (C * mu)

        def force(kappa: Any, measured_load: Any) -> Any:
            true_load = jnp.maximum((1 + g_n) * measured_load - b_n, 1e-9)
            E = curvature(B, C, x * true_load)
            Bk = B * kappa
            f = mu * true_load * jnp.sin(C * jnp.arctan(Bk - E * (Bk - jnp.arctan(Bk))))
            return (1 + g_t) * f

        above, centre, below = (force(slip + s * spread, load) for s in (1, 0, -1))
        at_light, at_heavy = force(slip_light, light), force(slip_heavy, heavy)
        slope = (above - below) / (2 * spread)
        mean = at_light + share * (at_heavy - at_light) + (above - 2 * centre + below) / 6
        slope_in_load = (at_heavy - at_light) / (heavy - light) - slope * slip_per_load
        mean = mean + slope_in_load / (1 + g_n) * c * mean
        noise = s_0 + s_1 * jnp.abs(mean)
        dense = (
            noise[:, :, None] * noise[:, None, :] * rho**lag
            + (slope**2 * slip_error)[:, :, None] * jnp.eye(slip.shape[1])
            + slope[:, :, None] * slope[:, None, :] * run_slip_error
            + tau**2
        )
        factor = jnp.linalg.cholesky(dense)
        white = solve_triangular(factor, (traction - mean)[:, :, None], lower=True)
        log_determinant = 2 * jnp.log(jnp.diagonal(factor, axis1=1, axis2=2)).sum()
        size = slip.size
        likelihood = -0.5 * ((white**2).sum() + log_determinant + size * jnp.log(2 * jnp.pi))
        prior = -0.5 * (z**2 + jnp.log(2 * jnp.pi)).sum()
        inside = (curvature(B, C, x * check_loads) <= 1).all()
        return jnp.where(inside, likelihood + prior, -jnp.inf)

    return log_density


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


def nuts(fit: PreparedFit) -> tuple[float, float, float, float]:
    """Run NumPyro's NUTS from the same start; return ESS, seconds, R-hat, the densities' gap."""
    import jax
    from numpyro.infer import MCMC, NUTS

    jax.config.update("jax_enable_x64", True)
    log_density = jax_log_density(fit.posterior)
    rng = np.random.default_rng(SEED)
    start = rng.multivariate_normal(fit.laplace.mode, fit.laplace.covariance, size=NUTS_CHAINS)
    theirs = np.array([float(log_density(z)) for z in start])
    apart = float(np.max(np.abs(theirs - fit.posterior.log_density(start))))
    kernel = NUTS(
        potential_fn=lambda z: -log_density(z),
        dense_mass=True,
        inverse_mass_matrix=jax.numpy.asarray(fit.laplace.covariance),
    )
    walk = MCMC(
        kernel, num_warmup=NUTS_WARM_UP, num_samples=NUTS_DRAWS, num_chains=NUTS_CHAINS,
        chain_method="sequential", progress_bar=False,
    )  # fmt: skip
    began = time.perf_counter()
    walk.run(jax.random.PRNGKey(SEED), init_params=jax.numpy.asarray(start))
    z = np.asarray(walk.get_samples(group_by_chain=True))
    seconds = time.perf_counter() - began
    ess, r_hat = (f(az.convert_to_dataset(z)) for f in (az.ess, az.rhat))
    return float(ess["x"].min()), seconds, float(r_hat["x"].max()), apart


def time_samplers(fit: PreparedFit) -> None:
    importance_ess, importance_seconds, pareto_k = importance(fit)
    figures = [
        (
            f"emcee {move.__name__}{' and jumps' * jumps}, {ENSEMBLES} ensembles, 2 threads",
            *ensembles(fit, move, jumps=jumps),
        )
        for move, jumps in ((DEMove, True), (DEMove, False), (StretchMove, False))
    ]
    note = ""
    try:
        *found, apart = nuts(fit)
        figures.append((f"NumPyro NUTS, {NUTS_CHAINS} chains, JAX with gradients", *found))
        note = f" The density written in JAX differs from ours by {apart:.1e} at most."
    except ImportError as error:
        note = f" No row for NumPyro's NUTS: {error}."
    table(
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


def time_reading(folder: Path) -> None:
    sweep = simulate(SweepPlan(duration=4.0, rate=1000.0))
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
    table(
        (f"CSV, {rows:,} rows, {file.stat().st_size / 1e6:.0f} MB", "seconds", "rows a second"),
        *((name, f"{s:.2f}", f"{rows / s:,.0f}") for name, s in timed.items()),
    )
    print(f"Best of {READS}.\n")


def main() -> None:
    began = time.perf_counter()
    print(f"Machine: {machine()}.\n")
    samples = simulate(SweepPlan()).samples
    rng = np.random.default_rng(SEED)
    fit = prepare_fit(samples, SOURCE_LAW, load_cell=LOAD_CELL, rng=rng, validate=False)
    z = rng.multivariate_normal(fit.laplace.mode, fit.laplace.covariance, size=BATCH)
    print("## Likelihood\n")
    time_likelihoods(fit.posterior, samples, z)
    print("## Sampling\n")
    time_samplers(fit)
    print("## Reading\n")
    with tempfile.TemporaryDirectory() as folder:
        time_reading(Path(folder))
    print(f"The whole benchmark took {time.perf_counter() - began:.0f} s.")


if __name__ == "__main__":
    main()
