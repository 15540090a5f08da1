# SPDX-License-Identifier: MIT
"""The calibration's posterior in JAX, sampled by NumPyro's NUTS: the peer with gradients.

Raises ImportError where NumPyro is missing: `make bench` installs it.
"""
# The group `bench` need not be installed:
# pyright: reportMissingImports=false

import time
from collections.abc import Callable
from typing import Any, cast

import arviz as az
import numpy as np
import xarray as xr

from model.bayes.fit import PreparedFit
from model.bayes.load_rule import load_rule
from model.bayes.posterior import SlipPosterior
from model.bayes.priors import HalfNormal, LogNormal, Normal, Prior, Uniform

NUTS_CHAINS, NUTS_WARM_UP, NUTS_DRAWS = 2, 200, 400


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

    Runs must have the same number of blocks, and the law must be `THESIS_LAW`.
    """
    import jax.numpy as jnp
    from jax.scipy.linalg import solve_triangular

    blocks = posterior.blocks
    shape = (blocks.n_runs, -1)
    rule = load_rule(blocks)
    variance = np.maximum(blocks.slip_variance(), 1e-12)
    apart = np.maximum(variance - rule.slip_per_load**2 * rule.variance, 1e-12)
    slip, load, traction, slip_error, half = (
        jnp.asarray(x.reshape(shape))
        for x in (
            blocks.slip,
            blocks.normal_force,
            blocks.traction_force,
            blocks.slip_error,
            np.sqrt(3 * apart),
        )
    )
    light, heavy, share, slip_per_load, follow, along = (
        jnp.asarray(x.reshape(shape))
        for x in (
            rule.light, rule.heavy, rule.heavy_share, rule.slip_per_load,
            variance / rule.followed, rule.variance / apart,
        )
    )  # fmt: skip
    lag = np.abs(np.subtract.outer(np.arange(slip.shape[1]), np.arange(slip.shape[1])))
    run_slip_error = jnp.asarray(blocks.run_slip_error)[:, None, None]
    priors = [posterior.priors[parameter.name] for parameter in posterior.free]
    check_loads = np.quantile(blocks.normal_force, [0.0, 0.25, 0.5, 0.75, 1.0])

    def curvature(B: Any, C: Any, x_m: Any) -> Any:
        return (B * x_m - jnp.tan(jnp.pi / (2 * C))) / (B * x_m - jnp.arctan(B * x_m))

    def log_density(z: Any) -> Any:
        K, C, mu, x, g_t, g_n, b_n, c, epsilon, c_r, q, scatter, s_0, s_1, rho, tau = (
            jax_value(prior, z[i]) for i, prior in enumerate(priors)
        )
        B = K / (C * mu)

        def force(kappa: Any, measured_load: Any) -> Any:
            true_load = jnp.maximum((1 + g_n) * measured_load - b_n, 1e-9)
            E = curvature(B, C, x * true_load)
            Bk = B * (kappa - epsilon * (1 - slip))
            f = mu * true_load * jnp.sin(C * jnp.arctan(Bk - E * (Bk - jnp.arctan(Bk))))
            return (1 + g_t) * (f - c_r * true_load)

        above, centre, below = (force(slip + s * half, load) for s in (1, 0, -1))
        slope = (above - below) / (2 * half)
        per_load = slip_per_load + c * slope * follow
        at_light, at_heavy = (force(slip + per_load * (x - load), x) for x in (light, heavy))
        at_one_load = jnp.maximum(1 - (per_load**2 - slip_per_load**2) * along, 0.0)
        mean = at_light + share * (at_heavy - at_light)
        mean = mean + at_one_load * (above - 2 * centre + below) / 6
        slope_in_load = (force(slip, heavy) - centre) / (heavy - load)
        mean = mean + slope_in_load / (1 + g_n) * c * mean
        noise = s_0 + s_1 * jnp.abs(mean)
        dense = (
            noise[:, :, None] * noise[:, None, :] * rho**lag
            + (slope**2 * (q**2 * slip_error + scatter**2))[:, :, None] * jnp.eye(slip.shape[1])
            + slope[:, :, None] * slope[:, None, :] * q**2 * run_slip_error
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


def nuts(fit: PreparedFit, *, seed: int) -> tuple[float, float, float, float]:
    """Run NumPyro's NUTS from the same start; return ESS, seconds, R-hat, the densities' gap."""
    import jax
    from numpyro.infer import MCMC, NUTS

    jax.config.update("jax_enable_x64", True)
    log_density = jax_log_density(fit.posterior)
    rng = np.random.default_rng(seed)
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
    walk.run(jax.random.PRNGKey(seed), init_params=jax.numpy.asarray(start))
    z = np.asarray(walk.get_samples(group_by_chain=True))
    seconds = time.perf_counter() - began
    drawn = az.convert_to_dataset(z)
    ess, r_hat = (cast("xr.Dataset", f(drawn)) for f in (az.ess, az.rhat))
    return float(ess["x"].min()), seconds, float(r_hat["x"].max()), apart
