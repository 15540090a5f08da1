# SPDX-License-Identifier: MIT
"""The calibration's posterior in JAX, sampled by NumPyro's NUTS: the peer with gradients.

Raises ImportError where NumPyro is missing: `make bench` installs it.
"""
# The group `bench` need not be installed:
# pyright: reportMissingImports=false

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from arviz_stats.base import array_stats

from benchmarks.speed.sampled import Sampled
from model.arrays import Array
from model.bayes.averaging.load_rule import load_rule
from model.bayes.averaging.slip_rule import slip_rule
from model.bayes.drawing.shear import FAR, Shear
from model.bayes.fit import PreparedFit
from model.bayes.posterior import SlipPosterior
from model.bayes.priors import HalfNormal, LogNormal, Normal, Prior, Uniform
from model.slip.definition import slip_per_radius_error
from model.slip.thesis_curve import THESIS_LAW

NUTS_CHAINS, NUTS_WARM_UP, NUTS_DRAWS = 2, 200, 400
COMPARED = 50  # draws at which both densities are computed


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


def jax_sheared(shear: Shear, x: Any) -> Any:
    """Map straightened coordinates x, shape (d,), to z as `Shear.sheared` does."""
    import jax.numpy as jnp

    v = jnp.clip((x - shear.centre) @ shear.wide, -FAR, FAR)
    return x + jnp.stack([jnp.prod(v[np.array(term)]) for term in shear.terms]) @ shear.shift


def run_log_densities(
    residual: Any, noise: Any, slope: Any, own: Any, shared: Any, rho: Any, tau: Any
) -> Any:
    """Compute each run's log density in JAX, shape (n_runs,), by the filter of `filter_runs`.

    Its gradient takes a fraction of the time of that of a dense covariance a run.

    Args:
        residual: Measured less expected traction, shape (n_runs, blocks) [N].
        noise: Standard deviation of the correlated noise, in that shape [N].
        slope: Slope of the force in slip, in that shape [N].
        own: Variance of the force by a block's own slip error, in that shape [N^2].
        shared: Variance of the slip error that a run shares, shape (n_runs,) [-].
        rho: Correlation of the noise of successive blocks [-].
        tau: Standard deviation of the run's force offset [N].
    """
    import jax
    import jax.numpy as jnp

    runs, size = residual.shape
    first, second = jnp.triu_indices(3)  # of residual, 1 and slope, which are whitened together

    def step(state: Any, block: Any) -> Any:
        predicted, variance, gram, log_determinant = state
        seen, s, error = block
        total = s**2 * variance + error
        innovation = seen - s * predicted
        gram = gram + innovation[first] * innovation[second] / total
        gain = variance * s / total
        predicted = rho * (predicted + gain * innovation)
        variance = rho**2 * variance * (1 - gain * s) + 1 - rho**2
        return (predicted, variance, gram, log_determinant + jnp.log(total)), None

    seen = jnp.stack([residual, jnp.ones_like(residual), slope]).transpose(2, 0, 1)
    state = (jnp.zeros((3, runs)), jnp.ones(runs), jnp.zeros((6, runs)), jnp.zeros(runs))
    (_, _, gram, log_determinant), _ = jax.lax.scan(step, state, (seen, noise.T, own.T))
    rr, r1, rg, s11, s1g, sgg = gram
    a, b, c, d = 1 + tau**2 * s11, tau**2 * s1g, shared * s1g, 1 + shared * sgg
    determinant = a * d - b * c
    x_1 = (d * tau**2 * r1 - b * shared * rg) / determinant
    x_g = (a * shared * rg - c * tau**2 * r1) / determinant
    quadratic = rr - r1 * x_1 - rg * x_g
    return -0.5 * (quadratic + log_determinant + jnp.log(determinant) + size * jnp.log(2 * jnp.pi))


def jax_log_density(posterior: SlipPosterior) -> Callable[[Any], Any]:
    """Write the posterior in JAX: the same blocks and model, the same filter of each run.

    The law must be `THESIS_LAW`, runs must have the same number of blocks, and all parameters must
    be free; a ValueError else.
    """
    import jax.numpy as jnp

    blocks = posterior.blocks
    lengths = np.diff(blocks.run_starts())
    plain = posterior.correlation is None and not posterior.fixed
    if not plain or posterior.law != THESIS_LAW or np.ptp(lengths):
        raise ValueError("the density in JAX is that of the thesis's law, Gaussian and all free")
    shape = (blocks.n_runs, -1)
    rule = load_rule(blocks)
    variance = np.maximum(blocks.slip_variance(), 1e-12)
    apart = np.maximum(variance - rule.slip_per_load**2 * rule.variance, 1e-12)
    slip, load, traction, slip_error = (
        jnp.asarray(x.reshape(shape))
        for x in (
            blocks.slip, blocks.normal_force, blocks.traction_force, blocks.slip_error,
        )
    )  # fmt: skip
    points = slip_rule(blocks.slip, apart)
    away, weight = (jnp.asarray(x.reshape(-1, *slip.shape)) for x in points.pairs())
    per_slip = weight * away / jnp.asarray(points.sd.reshape(shape)) ** 2
    light, heavy, share, slip_per_load, follow, along = (
        jnp.asarray(x.reshape(shape))
        for x in (
            rule.light, rule.heavy, rule.heavy_share, rule.slip_per_load,
            variance / rule.followed, rule.variance / apart,
        )
    )  # fmt: skip
    shared = jnp.asarray(blocks.run_slip_error)
    per_radius_error = jnp.asarray(
        slip_per_radius_error(blocks.slip, blocks.definition).reshape(shape)
    )
    priors = [posterior.priors[parameter.name] for parameter in posterior.free]
    check_loads = np.quantile(blocks.normal_force, [0.0, 0.25, 0.5, 0.75, 1.0])

    def curvature(B: Any, C: Any, x_m: Any) -> Any:
        return (B * x_m - jnp.tan(jnp.pi / (2 * C))) / (B * x_m - jnp.arctan(B * x_m))

    def log_density(z: Any) -> Any:
        z = z if posterior.shear is None else jax_sheared(posterior.shear, z)
        K, C, mu, x, g_t, g_n, b_n, c, epsilon, c_r, q, scatter, s_0, s_1, rho, tau = (
            jax_value(prior, z[i]) for i, prior in enumerate(priors)
        )
        B = K / (C * mu)

        def force(kappa: Any, measured_load: Any) -> Any:
            true_load = jnp.maximum((1 + g_n) * measured_load - b_n, 1e-9)
            E = curvature(B, C, x * true_load)
            Bk = B * (kappa - epsilon * per_radius_error)
            f = mu * true_load * jnp.sin(C * jnp.arctan(Bk - E * (Bk - jnp.arctan(Bk))))
            return (1 + g_t) * (f - c_r * true_load)

        centre = force(slip, load)
        above, below = force(slip + away, load), force(slip - away, load)
        slope = (per_slip * (above - below)).sum(axis=0)
        bend = (weight * (above - 2 * centre + below)).sum(axis=0)
        per_load = slip_per_load + c * slope * follow
        at_light, at_heavy = (force(slip + per_load * (x - load), x) for x in (light, heavy))
        at_one_load = jnp.maximum(1 - (per_load**2 - slip_per_load**2) * along, 0.0)
        mean = at_light + share * (at_heavy - at_light)
        mean = mean + at_one_load * bend
        slope_in_load = (force(slip, heavy) - centre) / (heavy - load)
        mean = mean + slope_in_load / (1 + g_n) * c * mean
        noise = s_0 + s_1 * jnp.abs(mean)
        own = slope**2 * (q**2 * slip_error + scatter**2)
        density = run_log_densities(traction - mean, noise, slope, own, q**2 * shared, rho, tau)
        prior = -0.5 * (z**2 + jnp.log(2 * jnp.pi)).sum()
        inside = (curvature(B, C, x * check_loads) <= 1).all()
        return jnp.where(inside, density.sum() + prior, -jnp.inf)

    return log_density


def largest_difference(posterior: SlipPosterior, z: Array) -> float:
    """Compute the largest difference of both log densities at coordinates z, shape (w, d)."""
    import jax

    theirs = np.asarray(jax.jit(jax.vmap(jax_log_density(posterior)))(z))
    return float(np.max(np.abs(theirs - posterior.log_density(z))))


def nuts(fit: PreparedFit, *, seed: int) -> tuple[Sampled, float, float]:
    """Run NumPyro's NUTS from the same start, with the Laplace approximation as its metric.

    Returns:
        What it drew; the seconds of its draws alone, after warm-up and compilation; and the
        largest difference of the densities at `COMPARED` draws of the approximation.
    """
    import jax
    from numpyro.infer import MCMC, NUTS

    jax.config.update("jax_enable_x64", True)
    log_density = jax_log_density(fit.posterior)
    rng = np.random.default_rng(seed)
    mode, covariance = fit.laplace.mode, fit.laplace.covariance
    start = rng.multivariate_normal(mode, covariance, size=NUTS_CHAINS)
    apart = largest_difference(
        fit.posterior, rng.multivariate_normal(mode, covariance, size=COMPARED)
    )
    kernel = NUTS(
        potential_fn=lambda z: -log_density(z),
        dense_mass=True,
        inverse_mass_matrix=jax.numpy.asarray(covariance),
    )
    walk = MCMC(
        kernel, num_warmup=NUTS_WARM_UP, num_samples=NUTS_DRAWS, num_chains=NUTS_CHAINS,
        chain_method="sequential", progress_bar=False,
    )  # fmt: skip
    began = time.perf_counter()
    walk.warmup(jax.random.PRNGKey(seed), init_params=jax.numpy.asarray(start))
    jax.block_until_ready(walk.post_warmup_state)
    warm = time.perf_counter()
    walk.run(walk.post_warmup_state.rng_key)
    z = np.asarray(walk.get_samples(group_by_chain=True))
    ended = time.perf_counter()
    ess, r_hat = (
        np.asarray(f(z, chain_axis=0, draw_axis=1)) for f in (array_stats.ess, array_stats.rhat)
    )
    found = Sampled(float(ess.min()), ended - began, f"{float(r_hat.max()):.3f}")
    return found, ended - warm, apart
