# SPDX-License-Identifier: MIT
r"""Likelihood of block means: one slip law measured by a load cell and two speed sensors.

For block j of run i

.. math::
    F_{ij} = (1+g_t)\bigl[\bar f(\kappa_{ij} - \varepsilon\,\partial\kappa, N_{ij})
             - c_r N_{ij}\bigr] + b_i + e_{ij}, \qquad N_{ij} = (1+g_n) F_n - b_n + c\,F_{ij},

with the law averaged over the spread of the true slip, which a wrong ratio of the radii shifts by
its relative error :math:`\varepsilon` times :math:`\partial\kappa`, `slip_per_radius_error`; a
rolling resistance of :math:`c_r` times the load, which acts against the driving direction whatever
the slip (Pacejka's vertical shift); a run offset
:math:`b_i \sim N(0, \tau^2)`, noise e of marginal standard deviation :math:`s_0 + s_1 |f|` that is
AR(1) after standardising, and the slip errors of `SlipBlocks` entering through the law's slope.
Their size is an estimate itself, and the speeds do not show all of them (discs run out of true):
the variance of a block's slip error is :math:`q^2` times the estimate plus
:math:`\sigma_\kappa^2`. If both were taken as known, the scatter of forces where the curve is steep
would determine its slope, and bias it.
Offset, shared slip error and noise are integrated out exactly by a Kalman filter of each run.
"""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_rule import load_rule
from model.bayes.averaging.slip_rule import slip_rule
from model.bayes.lane_likelihood import lane_log_likelihood
from model.compiled import compiled
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
              "noise of a block mean at zero force"),
    Parameter("noise_slope", "s_1", "dimensionless", 0.0, np.inf,
              "growth of that noise with force"),
    Parameter("noise_correlation", "rho", "dimensionless", -1.0, 1.0,
              "correlation of the noise of successive blocks"),
    Parameter("offset_spread", "tau", "newton", 0.0, np.inf,
              "standard deviation of the force offset between runs"),
)  # fmt: skip
"""The 12 parameters of the measurement, in their order behind the law's in parameter vectors."""


@dataclass(frozen=True)
class PredictedForces:
    """Predictions for n blocks by w parameter vectors, arrays of shape (w, n).

    Attributes:
        force: Expected measured block mean of traction, without run offset [N].
        slope: Slope of `force` over slip, across the spread of slip in the block [N].
        noise: Marginal standard deviation of the correlated noise, s_0 + s_1 |force| [N].
    """

    force: Array
    slope: Array
    noise: Array


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
        values: Law and measurement parameters, shape (w, k + 12).
        sine: Whether slip within blocks near zero slip is distributed as a sine wave is.
    """
    k = len(law.parameters)
    law_values = values[:, :k].T[:, :, None]
    g_t, g_n, b_n, c, epsilon, c_r = values[:, k : k + 6].T[:, :, None]
    s_0, s_1 = values[:, -4:-2].T[:, :, None]
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
    force = mean + slope_in_load / (1 + g_n) * c * mean
    return PredictedForces(force, slope, s_0 + s_1 * np.abs(force))


def run_log_likelihood(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Compute the log density of each run's measured block means of traction.

    Run offset, shared slip error and noise are integrated out.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 12).

    Returns:
        Log density of each run, shape (w, n_runs).
    """
    k = len(law.parameters)
    known = lane_law(law, values[:, :k])
    if known is not None:
        return lane_log_likelihood(blocks, known, values[:, k:])
    predicted = predict_blocks(blocks, law, values)
    scale, scatter, rho, tau = values[:, -6], values[:, -5], values[:, -2], values[:, -1]
    return filter_runs(
        blocks.traction_force - predicted.force, predicted.noise, predicted.slope,
        blocks.slip_error, blocks.run_slip_error, blocks.run_starts(), scale, scatter, rho, tau,
    )  # fmt: skip


def slip_errors(blocks: SlipBlocks, values: Array) -> tuple[Array, Array]:
    """Compute the variance of each block's own slip error and of that which its run shares [-].

    Args:
        blocks: The block means, n of them.
        values: Law and measurement parameters, shape (k + 12,).

    Returns:
        Variances of blocks, shape (n,), and of runs, shape (n_runs,).
    """
    scale, scatter = values[-6:-4]
    return scale**2 * blocks.slip_error + scatter**2, scale**2 * blocks.run_slip_error


def log_likelihood(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Compute the log likelihood of all block means; see `run_log_likelihood`.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 12).

    Returns:
        Log likelihood of each parameter vector, shape (w,).
    """
    return run_log_likelihood(blocks, law, values).sum(axis=1)


@compiled
def filter_runs(
    residual, noise, slope, slip_error, run_slip_error, starts, scale, scatter, rho, tau
):
    """Compute each run's log density by a Kalman filter, offset and shared slip error integrated.

    State: the standardised noise z, AR(1) with unit variance; observation noise: the block's own
    slip error times the squared slope. The filter is linear, so it whitens the residual and the
    two shared directions (1 and slope) together; their Gram matrix then gives the quadratic form
    and determinant of the run's covariance by the Woodbury identity.

    `residual`, `noise` and `slope` are (w, n), `slip_error` (n,), `run_slip_error` (n_runs,),
    `starts` (n_runs + 1,), `scale`, `scatter`, `rho` and `tau` (w,); the result is (w, n_runs).
    """
    n_walkers, n_runs = residual.shape[0], len(starts) - 1
    result = np.empty((n_walkers, n_runs))
    for w in range(n_walkers):
        q, own = scale[w] ** 2, scatter[w] ** 2
        for i in range(n_runs):
            m_r = m_1 = m_g = 0.0
            variance = 1.0
            rr = r1 = rg = s11 = s1g = sgg = 0.0
            log_determinant = 0.0
            for j in range(starts[i], starts[i + 1]):
                s, g = noise[w, j], slope[w, j]
                total = s * s * variance + g * g * (q * slip_error[j] + own)
                e_r, e_1, e_g = residual[w, j] - s * m_r, 1.0 - s * m_1, g - s * m_g
                gain = variance * s / total
                rr += e_r * e_r / total
                r1 += e_r * e_1 / total
                rg += e_r * e_g / total
                s11 += e_1 * e_1 / total
                s1g += e_1 * e_g / total
                sgg += e_g * e_g / total
                log_determinant += np.log(total)
                m_r = rho[w] * (m_r + gain * e_r)
                m_1 = rho[w] * (m_1 + gain * e_1)
                m_g = rho[w] * (m_g + gain * e_g)
                variance = rho[w] ** 2 * variance * (1 - gain * s) + 1 - rho[w] ** 2
            d_1, d_g = tau[w] ** 2, q * run_slip_error[i]
            a, b = 1 + d_1 * s11, d_1 * s1g
            c, d = d_g * s1g, 1 + d_g * sgg
            determinant = a * d - b * c
            x_1 = (d * d_1 * r1 - b * d_g * rg) / determinant
            x_g = (a * d_g * rg - c * d_1 * r1) / determinant
            # Where noise is far below everything else, the difference cancels to rounding
            # errors of either sign; these are its lower bound.
            quadratic = max(rr - r1 * x_1 - rg * x_g, 1e-14 * rr)
            size = starts[i + 1] - starts[i]
            log_determinant += np.log(determinant)
            result[w, i] = -0.5 * (quadratic + log_determinant + size * np.log(2 * np.pi))
    return result
