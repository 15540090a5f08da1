# SPDX-License-Identifier: MIT
r"""Likelihood of block means: one slip law measured by a load cell and two speed sensors.

For block j of run i

.. math::
    F_{ij} = (1+g_t)\bigl[\bar f(\kappa_{ij} - \varepsilon\,\partial\kappa, N_{ij})
             - c_r N_{ij}\bigr] + b_i + e_{ij}, \qquad
    N_{ij} = (1+g_n) F_n - b_n + c\,F_{ij} + z_i,

with the law averaged over the spread of the true slip, which a wrong ratio of the radii shifts by
its relative error :math:`\varepsilon` times :math:`\partial\kappa`, `slip_per_radius_error`; a
rolling resistance of :math:`c_r` times the load, which acts against the driving direction whatever
the slip (Pacejka's vertical shift); zeros of traction and load that a run has of its own,
:math:`b_i, z_i \sim N(0, \tau^2)`; noise e of standard deviation :math:`s_0 m_i` that is AR(1),
with a size :math:`m_i` of each run (`SlipBlocks.noise_size`). The noise's size is never a function
of the curve: a curve could explain scatter by bending. Errors of slip and load of `SlipBlocks`
enter through the law's slopes. The size of the slip errors is an estimate itself, and the speeds do
not show all of them (discs run out of true): the variance of a block's slip error is :math:`q^2`
times the estimate plus :math:`\sigma_\kappa^2`. If both were taken as known, the scatter of
forces where the curve is steep would determine its slope, and bias it. Zeros, shared slip error and
noise are integrated out exactly by a Kalman filter of each run.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from scipy.linalg import cho_solve, solve_triangular, toeplitz

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_rule import load_rule
from model.bayes.averaging.slip_rule import slip_rule
from model.bayes.lane_likelihood import lane_log_likelihood
from model.slip.definition import slip_per_radius_error
from model.slip.lane_force import lane_law
from model.slip.law import Parameter, SlipLaw

NUISANCE = (
    Parameter("gain_traction", "g_t", "dimensionless", -1.0, np.inf,
              "relative gain error of the traction channel"),
    Parameter("gain_normal", "g_n", "dimensionless", -1.0, np.inf,
              "relative gain error of the normal-force channel"),
    Parameter("bias_normal", "b_n", "newton", -np.inf, np.inf,
              "zero error of the normal-force channel"),
    Parameter("crosstalk", "c", "dimensionless", -1.0, 1.0,
              "normal force missed for each newton of traction"),
    Parameter("radius_error", "epsilon", "dimensionless", -1.0, np.inf,
              "relative error of the ratio of radii, ground disc over leg"),
    Parameter("rolling_resistance", "c_r", "dimensionless", -np.inf, np.inf,
              "force against driving at any slip, for each newton of load"),
    Parameter("slip_error_scale", "q", "dimensionless", 0.0, np.inf,
              "true over estimated size of the errors of measured slip"),
    Parameter("slip_scatter", "sigma_kappa", "dimensionless", 0.0, np.inf,
              "standard deviation of a block's slip that the speeds do not show"),
    Parameter("noise_floor", "s_0", "newton", 0.0, np.inf,
              "noise of a block mean, of a run of usual noise"),
    Parameter("noise_correlation", "rho", "dimensionless", -1.0, 1.0,
              "correlation of the noise of successive blocks"),
    Parameter("offset_spread", "tau", "newton", 0.0, np.inf,
              "standard deviation of the force offset between runs"),
)  # fmt: skip
"""The 11 parameters of the measurement, in their order behind the law's in parameter vectors."""


@dataclass(frozen=True)
class PredictedForces:
    """Predictions for n blocks by w parameter vectors, arrays of shape (w, n).

    Attributes:
        force: Expected measured block mean of traction, without run offset [N].
        slope: Slope of `force` over slip, across the spread of slip in the block [N].
        load_slope: Slope of `force` over the true load [-].
        noise: Marginal standard deviation of the correlated noise [N].
    """

    force: Array
    slope: Array
    load_slope: Array
    noise: Array

    def of_vector(self, index: int) -> "PredictedForces":
        """Return the predictions by one parameter vector, arrays of shape (n,)."""
        return PredictedForces(*(getattr(self, each.name)[index] for each in fields(self)))

    def mean(self) -> "PredictedForces":
        """Average the predictions over the parameter vectors, arrays of shape (n,)."""
        return PredictedForces(*(getattr(self, each.name).mean(axis=0) for each in fields(self)))


def predict_blocks(
    blocks: SlipBlocks, law: SlipLaw, values: Array, *, sine: bool = False
) -> PredictedForces:
    r"""Compute expected traction, its slope in slip and the standard deviation of noise by block.

    The mean of the law over a block is that over its loads, slip following load by regression, plus
    what the spread of slip at one load adds to it, by the points of `slip_rule` for the variance of
    the slip that does not follow the measured load; the sum is scaled to that which does not follow
    the true one. The load's rule has two points and the mean, variance and skewness of the block's
    loads: a bump on a disc makes the loads skewed, and because peak slip depends on load the force
    is curved in load.

    Crosstalk puts the expected traction into the load, by the slope of force in load. With the
    measured traction there, the density of the traction would have a Jacobian, and an error in that
    is multiplied by the number of blocks. The two differ by :math:`c\,f_n`, crosstalk times the
    slope in load, a five-hundredth, of the noise. Where slip varies, crosstalk makes the measured
    load fall as traction rises though the true load stays: slip follows the true load by
    :math:`c\,f_\kappa\,\omega^2` over the variance of load more than it follows the measured one.
    True loads below 1e-9 N count as 1e-9 N.

    Args:
        blocks: The block means, n of them.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 11).
        sine: Whether slip within blocks near zero slip is distributed as a sine wave is.
    """
    k = len(law.parameters)
    law_values = values[:, :k].T[:, :, None]
    g_t, g_n, b_n, c, epsilon, c_r = values[:, k : k + 6].T[:, :, None]
    rule = load_rule(blocks)
    shift = epsilon * slip_per_radius_error(blocks.slip, blocks.definition)

    def force_at(slip: Array, load: Array) -> Array:
        # A load cell bias can push the lightest loads through zero; no law is defined there.
        true_load = np.maximum((1 + g_n) * load - b_n, 1e-9)
        force = law.force(slip - shift, true_load, law_values)
        return (1 + g_t) * (force - c_r * true_load)

    variance = np.maximum(blocks.slip_variance(), 1e-12)
    apart = np.maximum(variance - rule.slip_per_load**2 * rule.variance, 1e-12)
    points = slip_rule(blocks.slip, apart, sine=sine)
    away, weight = points.pairs()
    offsets = np.concatenate([np.zeros((1, len(blocks))), away, -away])
    # One call: what depends on load alone is computed once.
    centre, *pairs = force_at(blocks.slip + offsets[:, None], blocks.normal_force)
    above, below = np.split(np.array(pairs), 2)
    slope = np.einsum("pn,pwn->wn", weight * away / points.sd**2, above - below)
    bend = np.einsum("pn,pwn->wn", weight, above - 2 * centre + below)
    per_load = rule.slip_per_load + c * slope * variance / rule.followed
    at_one_load = np.maximum(variance - per_load**2 * rule.variance, 0.0) / apart
    up, down = rule.heavy - blocks.normal_force, rule.light - blocks.normal_force
    light = force_at(blocks.slip + per_load * down, rule.light)
    heavy = force_at(blocks.slip + per_load * up, rule.heavy)
    mean = light + rule.heavy_share * (heavy - light)
    mean = mean + at_one_load * bend
    slope_in_load = (force_at(blocks.slip, rule.heavy) - centre) / up
    load_slope = slope_in_load / (1 + g_n)
    noise = values[:, -3, None] * blocks.noise_size
    return PredictedForces(mean + load_slope * c * mean, slope, load_slope, noise)


def run_log_likelihood(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Compute the log density of each run's measured block means of traction.

    Run offset, shared slip error and noise are integrated out.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 11).

    Returns:
        Log density of each run, shape (w, n_runs).
    """
    k = len(law.parameters)
    known = lane_law(law, values[:, :k])
    if known is not None:
        return lane_log_likelihood(blocks, known, values[:, k:])
    predicted = predict_blocks(blocks, law, values)
    found = np.empty((len(values), blocks.n_runs))
    for index, vector in enumerate(values):
        one = predicted.of_vector(index)
        try:
            factors = covariance_factors(blocks, one, vector)
        except np.linalg.LinAlgError:  # numbers beyond what rounding leaves of them
            found[index] = np.nan
            continue
        residual = np.split(blocks.traction_force - one.force, blocks.run_starts()[1:-1])
        for run, (L, rest) in enumerate(zip(factors, residual, strict=True)):
            white = solve_triangular(L, rest, lower=True)
            size = np.log(2 * np.pi) * len(rest) + 2 * np.log(np.diag(L)).sum()
            found[index, run] = -0.5 * (white @ white + size)
    return found


def slip_errors(blocks: SlipBlocks, values: Array) -> tuple[Array, Array]:
    """Compute the variance of each block's own slip error and of that which its run shares [-].

    Args:
        blocks: The block means, n of them.
        values: Law and measurement parameters, shape (k + 11,).

    Returns:
        Variances of blocks, shape (n,), and of runs, shape (n_runs,).
    """
    scale, scatter = values[-5:-3]
    return scale**2 * blocks.slip_error + scatter**2, scale**2 * blocks.run_slip_error


def covariance_factors(
    blocks: SlipBlocks, predicted: PredictedForces, values: Array
) -> list[Array]:
    """Return the lower Cholesky factor of each run's covariance, shape (blocks, blocks) [N].

    It is the covariance of noise, run's zeros, slip and load errors; `LinAlgError` is raised if one
    is singular.

    The matrix is built densely from its definition and not by the likelihood's filter, as a check
    of the filter.

    Args:
        blocks: The block means, n of them.
        predicted: Predictions by one parameter vector, arrays of shape (n,).
        values: Law and measurement parameters, of which slip errors, the noise's correlation and
            the zeros' standard deviation are used, shape (k + 11,).
    """
    rho, tau = values[-2:]
    own, shared = slip_errors(blocks, values)
    starts = blocks.run_starts()
    factors = []
    for index in range(blocks.n_runs):
        part = slice(starts[index], starts[index + 1])
        s, g, h = (each[part] for each in (predicted.noise, predicted.slope, predicted.load_slope))
        covariance = np.outer(s, s) * toeplitz(rho ** np.arange(len(s))) + tau**2
        covariance += np.outer(g, g) * shared[index] + np.outer(h, h) * tau**2
        covariance += np.diag(g**2 * own[part] + h**2 * blocks.load_error[part])
        factors.append(np.linalg.cholesky(covariance))
    return factors


def log_likelihood(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Compute the log likelihood of all block means; see `run_log_likelihood`.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 11).

    Returns:
        Log likelihood of each parameter vector, shape (w,).
    """
    return run_log_likelihood(blocks, law, values).sum(axis=1)


def corrected_blocks(blocks: SlipBlocks, law: SlipLaw, values: Array, *, zeros: bool) -> SlipBlocks:
    r"""Correct block means for load cell, radii, rolling resistance and the zeros of their run.

    The likelihood's model of the data (`model.bayes.likelihood`), solved for the law:

    .. math::
        \kappa' = \kappa - \varepsilon\,\partial\kappa, \qquad
        N' = (1+g_n) F_n - b_n + c\,\hat F + \hat z_i, \qquad
        F' = f(\kappa', N') + \frac{F - \hat F - \hat b_i - f_n \hat z_i}{1+g_t},

    with the predicted traction :math:`\hat F` and its slope in load :math:`f_n`. Where slip and
    load are constant within blocks that is :math:`(F - \hat b_i)/(1+g_t) + c_r N'`; where they are
    not, F' is the traction that slip and load of the mean would have given. Noise stays as it is,
    over :math:`1+g_t`.

    A run at one slip cannot tell its zeros from a misfit of the law there: corrected for them, such
    runs lie on any curve.

    Args:
        blocks: The block means, n of them.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, such as the posterior mean, shape (k + 11,).
        zeros: Whether to correct for the run's own zeros; they count as 0 else.

    Returns:
        The blocks with corrected slip, load and traction; all else as it was.

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    k = len(law.parameters)
    g_t, g_n, b_n, c, epsilon = values[k : k + 5]
    predicted = predict_blocks(blocks, law, values[None]).of_vector(0)
    of_runs = run_zeros(blocks, predicted, values) if zeros else np.zeros((2, blocks.n_runs))
    force_zero, load_zero = of_runs[:, blocks.run]
    slip = blocks.slip - epsilon * slip_per_radius_error(blocks.slip, blocks.definition)
    load = (1 + g_n) * blocks.normal_force - b_n + c * predicted.force + load_zero
    load = np.maximum(load, 1e-9)  # as the likelihood has it
    zero = force_zero + predicted.load_slope * load_zero
    force = law.force(slip, load, values[:k])
    force = force + (blocks.traction_force - predicted.force - zero) / (1 + g_t)
    return replace(blocks, slip=slip, normal_force=load, traction_force=force)


def at_load(blocks: SlipBlocks, law: SlipLaw, values: Array, load: float) -> Array:
    """Compute the traction that corrected blocks would have at another load, shape (n,) [N].

    Args:
        blocks: Corrected block means, n of them.
        law: The slip law, of k parameters, by which traction changes with load.
        values: Its parameters, shape (k,).
        load: The load [N].
    """
    own = law.force(blocks.slip, blocks.normal_force, values)
    return blocks.traction_force + law.force(blocks.slip, load, values) - own


def run_zeros(blocks: SlipBlocks, predicted: PredictedForces, values: Array) -> Array:
    r"""Compute the expected zeros of traction and load of each run, given its measured traction.

    .. math::
        \hat b = \tau^2\, 1^T \Sigma^{-1} (F - \hat F), \qquad
        \hat z = \tau^2 f_n^T \Sigma^{-1} (F - \hat F)

    with the covariance :math:`\Sigma` of the run's blocks, as `covariance_factors` has it.

    Args:
        blocks: The block means, n of them.
        predicted: Predictions by one parameter vector, arrays of shape (n,).
        values: Law and measurement parameters, shape (k + 11,).

    Returns:
        Zeros of traction, then of load, shape (2, n_runs) [N].

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    edges = blocks.run_starts()[1:-1]
    residual = np.split(blocks.traction_force - predicted.force, edges)
    factors = covariance_factors(blocks, predicted, values)
    weighted = [cho_solve((L, True), rest) for L, rest in zip(factors, residual, strict=True)]
    slopes = np.split(predicted.load_slope, edges)
    load = [h @ each for h, each in zip(slopes, weighted, strict=True)]
    return values[-1] ** 2 * np.array([[each.sum() for each in weighted], load])
