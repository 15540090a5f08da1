# SPDX-License-Identifier: MIT
"""Summaries of posterior draws: parameters, curve coefficients, agreement of two samplers."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.drawing.convergence import MAX_PARETO_K, Convergence
from model.bayes.drawing.sampler import Chains
from model.bayes.drawing.importance import WeightedDraws
from model.bayes.posterior import SlipPosterior
from model.slip.law import Parameter, SlipLaw
from model.slip.magic_formula import MagicFormula
from model.slip.sided import N_SIDES, SidedLaw, side_factors


@dataclass(frozen=True)
class Draws:
    """Draws of a posterior.

    Attributes:
        z: Standard normal coordinates of the free parameters, shape (ensembles, n, d).
        values: Values of the law's k and the measurement's 11 parameters, (ensembles, n, k + 11).
        log_density: Log posterior density up to a constant, shape (ensembles, n).
    """

    z: Array
    values: Array
    log_density: Array

    @property
    def flat(self) -> Array:
        """`values` with the ensembles joined, shape (ensembles · n, k + 11)."""
        return self.values.reshape(-1, self.values.shape[-1])


def thin_draws(
    posterior: SlipPosterior, chains: Chains, convergence: Convergence, *, n: int
) -> Draws:
    """Select evenly spaced draws of the chains after the burn-in.

    Args:
        posterior: The posterior that was sampled.
        chains: The chains.
        convergence: Diagnostics with the length of the burn-in.
        n: Largest number of draws of each ensemble, of all its walkers together.
    """
    kept = chains.z[:, convergence.burn_in :]
    ensembles, steps, walkers, d = kept.shape
    picked = np.linspace(0, steps * walkers - 1, min(n, steps * walkers)).round().astype(int)
    z = kept.reshape(ensembles, -1, d)[:, picked]
    density = chains.log_density[:, convergence.burn_in :].reshape(ensembles, -1)[:, picked]
    values = posterior.values(z.reshape(-1, d)).reshape(ensembles, len(picked), -1)
    return Draws(z, values, density)


@dataclass(frozen=True)
class Estimate:
    """Posterior of one quantity, in the unit of `parameter`.

    Attributes:
        parameter: Name, symbol, unit, bounds and meaning of the quantity.
        mean: Posterior mean.
        sd: Posterior standard deviation.
        low: Posterior 5 % quantile.
        median: Posterior median.
        high: Posterior 95 % quantile.
    """

    parameter: Parameter
    mean: float
    sd: float
    low: float
    median: float
    high: float


def estimate(parameter: Parameter, draws: Array) -> Estimate:
    """Compute mean, standard deviation and 5, 50 and 95 % quantiles of draws of one quantity.

    Draws may be infinite, for example the peak slip of a curve without a peak. The mean is then
    infinite too, the standard deviation is NaN, and a quantile is one of the draws.

    Args:
        parameter: The quantity: name, unit and meaning.
        draws: Posterior draws of the quantity, shape (n,).
    """
    # Order statistics without interpolation, which infinite draws do not allow.
    low, median, high = np.quantile(draws, [0.05, 0.5, 0.95], method="inverted_cdf")
    with np.errstate(invalid="ignore"):
        mean, sd = np.mean(draws), np.std(draws)
    return Estimate(parameter, *(float(x) for x in (mean, sd, low, median, high)))


def informed(contraction: float) -> float:
    """Return what is shown of a contraction: a posterior wider than the prior, by chance, is 0 [-].

    >>> informed(0.8), informed(-0.02)
    (0.8, 0.0)
    """
    return max(0.0, contraction)


def contraction(posterior: SlipPosterior, draws: Draws) -> dict[str, float]:
    """Compute the contraction of each parameter: 1 - posterior over prior variance.

    Both are of the parameter's own standard normal coordinate.

    Args:
        posterior: The posterior, with its free parameters in the order of the coordinates z.
        draws: Posterior draws.

    Returns:
        Contraction by the parameter's name [-].
    """
    variances = posterior.own_coordinates(draws.z.reshape(-1, draws.z.shape[-1])).var(axis=0)
    return {p.name: float(1 - v) for p, v in zip(posterior.free, variances, strict=True)}


def curve_estimates(
    law: SlipLaw, values: Array, *, load: float, slip_limit: float
) -> list[Estimate]:
    """Estimate features of the curve at one load from posterior draws.

    In order: B, C, D, E (of a Magic Formula only), peak slip (or infinity), largest traction within
    the tested slip (known even where data end before the peak, unlike D), slope at zero slip [N].
    Of a law with its sides apart these are of driving, and the last three follow for braking.

    Args:
        law: The slip law, of k parameters.
        values: Posterior draws of its parameters, shape (w, k).
        load: Normal force [N].
        slip_limit: Largest absolute slip ratio that was tested [-].
    """
    columns = values.T
    quantities: list[tuple[Parameter, Array]] = []
    if isinstance(law, MagicFormula):
        quantities += zip(_PLAIN, law.coefficients(load, columns), strict=True)
    elif isinstance(law, SidedLaw) and isinstance(law.law, MagicFormula):
        quantities += zip(_PLAIN, _driving_coefficients(law.law, load, columns), strict=True)
    peak = law.peak_slip(load, columns)
    largest = law.force(np.minimum(peak, slip_limit), load, columns)
    slope = law.slip_derivative(0.0, load, columns)
    quantities += zip(_FEATURES, (peak, largest, slope), strict=True)
    if isinstance(law, SidedLaw):
        peak = law.braking_peak_slip(load, columns)
        largest = -law.force(np.maximum(peak, -slip_limit), load, columns)
        slope = law.slip_derivative(-1e-12, load, columns)
        quantities += zip(BRAKING, (peak, largest, slope), strict=True)
    n = len(values)
    return [estimate(p, np.broadcast_to(np.asarray(x), n)) for p, x in quantities]


def _driving_coefficients(
    law: MagicFormula, load: float, columns: Array
) -> tuple[Array, Array, Array, Array]:
    """Compute B, C, D [N] and E of the driving side from values of a `SidedLaw` of `law`."""
    m, h = side_factors(1.0, *columns[-N_SIDES:])
    B, C, D, E = law.coefficients(load, columns[:-N_SIDES])
    return h * B, C, m * D, E


MAX_MEAN = 0.1  # difference of two computed means, in standard deviations
MAX_SPREAD = 0.05  # relative difference of two computed standard deviations
ERRORS = 4.0  # Monte Carlo errors that the largest of a dozen differences may reach by chance


@dataclass(frozen=True)
class Agreement:
    """Difference between sampler and importance sampling in the free parameters.

    Of means, and of spreads, it is that of the parameter that differs most for what it may differ
    by: the larger of `MAX_MEAN`, or `MAX_SPREAD`, and `ERRORS` Monte Carlo errors.

    Attributes:
        mean: Absolute difference of means of z over the sampler's standard deviation [-].
        spread: Absolute difference of standard deviations of z over the sampler's [-].
        pareto_k: Tail index of the importance weights; from 0.7 on they are not reliable [-].
        mean_error: Monte Carlo error of the difference of means, as `mean` [-].
        spread_error: Monte Carlo error of that of spreads, as `spread` [-].
    """

    mean: float
    spread: float
    pareto_k: float
    mean_error: float = 0.0
    spread_error: float = 0.0

    @property
    def comparable(self) -> bool:
        """Whether the importance weights are reliable: `pareto_k` is below `MAX_PARETO_K`."""
        return self.pareto_k < MAX_PARETO_K


def agreement(draws: Draws, weighted: WeightedDraws, convergence: Convergence) -> Agreement:
    """Compute differences between the sampler's and importance-weighted means and spreads of z.

    The Monte Carlo error of a weighted mean of h is the root of the sum of w² (h - E h)².

    Args:
        draws: Draws of the sampler.
        weighted: Draws of the Laplace approximations, in the same coordinates z, with importance
            weights.
        convergence: Convergence diagnostics of the sampler, with its effective sample sizes.
    """
    z = draws.z.reshape(-1, draws.z.shape[-1])
    centre, scale = z.mean(axis=0), z.std(axis=0)
    mean = weighted.weights @ weighted.z
    away = weighted.z - mean
    sd = np.sqrt(weighted.weights @ away**2)
    kurtosis = np.mean(((z - centre) / scale) ** 4, axis=0)
    independent = np.minimum(convergence.ess_bulk, len(z))
    square = weighted.weights**2
    mean_error = np.sqrt(1 / independent + square @ away**2 / scale**2)
    spread_error = 0.5 * np.sqrt(
        (kurtosis - 1) / independent + square @ ((away / sd) ** 2 - 1) ** 2
    )
    of_means, of_spreads = np.abs(centre - mean) / scale, np.abs(sd / scale - 1)
    i = np.argmax(of_means / np.maximum(MAX_MEAN, ERRORS * mean_error))
    j = np.argmax(of_spreads / np.maximum(MAX_SPREAD, ERRORS * spread_error))
    return Agreement(
        mean=float(of_means[i]),
        spread=float(of_spreads[j]),
        pareto_k=weighted.pareto_k,
        mean_error=float(mean_error[i]),
        spread_error=float(spread_error[j]),
    )


_PLAIN = (
    Parameter("stiffness_factor", "B", "dimensionless", 0.0, np.inf, "stiffness factor"),
    Parameter("shape_factor", "C", "dimensionless", 1.0, 2.0, "shape factor"),
    Parameter("peak_factor", "D", "newton", 0.0, np.inf, "peak force"),
    Parameter("curvature_factor", "E", "dimensionless", -np.inf, 1.0, "curvature factor"),
)
_FEATURES = (
    Parameter("peak_slip", "x_m", "dimensionless", 0.0, np.inf, "slip ratio of the peak"),
    Parameter(
        "largest_force",
        "F_max",
        "newton",
        0.0,
        np.inf,
        "largest traction force within the tested slip",
    ),
    Parameter("initial_slope", "BCD", "newton", 0.0, np.inf, "slope at zero slip"),
)
BRAKING = (
    Parameter("braking_peak_slip", "x_m-", "dimensionless", -np.inf, 0.0,
              "slip ratio of the braking peak"),
    Parameter("largest_braking_force", "F_max-", "newton", 0.0, np.inf,
              "largest braking force within the tested slip"),
    Parameter("initial_braking_slope", "BCD-", "newton", 0.0, np.inf,
              "slope of braking at zero slip"),
)  # fmt: skip
"""Features of the braking side of a law with its sides apart."""
