# SPDX-License-Identifier: MIT
r"""The likelihood of block means: one slip law seen through a load cell and two speed sensors.

For block j of run i

.. math::
    F_{ij} = (1+g_t)\,\bar f\bigl(\kappa_{ij}, (1+g_n) F_n - b_n + c (1+g_t) f\bigr) + b_i + e_{ij},

with the law averaged over the spread of the true slip, a run offset
:math:`b_i \sim N(0, \tau^2)`, noise e of marginal standard deviation :math:`s_0 + s_1 |f|` that is
AR(1) after standardising, and the slip errors of `SlipBlocks` entering through the law's slope.
Offset, shared slip error and noise are integrated out exactly by a Kalman filter of each run.
"""

from dataclasses import dataclass

import numba
import numpy as np

from model.bayes.blocks import SlipBlocks
from model.slip.law import Array, Parameter, SlipLaw

NUISANCE = (
    Parameter("gain_traction", "g_t", "dimensionless", -1.0, np.inf,
              "relative gain error of the traction channel"),
    Parameter("gain_normal", "g_n", "dimensionless", -1.0, np.inf,
              "relative gain error of the normal-force channel"),
    Parameter("bias_normal", "b_n", "newton", -np.inf, np.inf,
              "zero error of the normal-force channel"),
    Parameter("crosstalk", "c", "dimensionless", -1.0, 1.0,
              "normal force missed for each newton of traction"),
    Parameter("noise_floor", "s_0", "newton", 0.0, np.inf,
              "noise of a block mean at zero force"),
    Parameter("noise_slope", "s_1", "dimensionless", 0.0, np.inf,
              "growth of that noise with force"),
    Parameter("noise_correlation", "rho", "dimensionless", -1.0, 1.0,
              "correlation of the noise of successive blocks"),
    Parameter("offset_spread", "tau", "newton", 0.0, np.inf,
              "standard deviation of the force offset between runs"),
)  # fmt: skip
"""Parameters of the measurement, behind the law's own in every parameter vector."""


@dataclass(frozen=True)
class Prediction:
    """What parameter vectors say of the blocks, each of shape (w, n).

    Attributes:
        force: Expected measured traction, run offset apart [N].
        slope: Derivative of `force` with respect to slip [N].
        noise: Marginal standard deviation of the correlated noise [N].
    """

    force: Array
    slope: Array
    noise: Array


def predict_blocks(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Prediction:
    r"""Compute expected force, its slope in slip and the noise size of every block.

    The mean of the law over a block is a three-point Gauss-Hermite rule in slip at
    :math:`\kappa, \kappa \pm \sqrt{3}\,\omega` (exact to fifth order in the spread
    :math:`\omega` of the true slip around the block's), plus
    :math:`f_{\kappa n}\,\mathrm{cov}(\kappa, F_n)`, with :math:`f_{\kappa n} \approx
    f_\kappa / F_n`, the force being proportional to load to first order.

    Crosstalk takes the expected traction for the measured one. With the measured one in the load,
    the density of the traction would have a Jacobian, and whatever error was made in that,
    crosstalk would grow until it balanced: n blocks outweigh any prior. The two differ by
    c·f_n, a five-hundredth, of the noise.

    Args:
        blocks: The block means, n of them.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 8).
    """
    k = len(law.parameters)
    law_values = values[:, :k].T[:, :, None]
    g_t, g_n, b_n, c, s_0, s_1 = values[:, k : k + 6].T[:, :, None]
    # A load cell bias can push the lightest loads through zero; no law is defined there.
    load = np.maximum((1 + g_n) * blocks.normal_force - b_n, 1e-9)
    load = np.maximum(load + c * (1 + g_t) * law.force(blocks.slip, load, law_values), 1e-9)
    half_width = np.sqrt(3 * np.maximum(blocks.slip_variance(), 1e-12))
    above = law.force(blocks.slip + half_width, load, law_values)
    centre = law.force(blocks.slip, load, law_values)
    below = law.force(blocks.slip - half_width, load, law_values)
    slope = (above - below) / (2 * half_width)
    mean = (above + 4 * centre + below) / 6 + slope / load * blocks.slip_load_covariance
    force = (1 + g_t) * mean
    return Prediction(force, (1 + g_t) * slope, s_0 + s_1 * np.abs(force))


def run_log_likelihood(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Compute the log density of each run's block means.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 8).

    Returns:
        Log density of each run, shape (w, n_runs).
    """
    predicted = predict_blocks(blocks, law, values)
    rho, tau = values[:, -2], values[:, -1]
    return _filter_runs(
        blocks.traction_force - predicted.force, predicted.noise, predicted.slope,
        blocks.slip_error, blocks.run_slip_error, blocks.run_starts(), rho, tau,
    )  # fmt: skip


def log_likelihood(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Compute the log density of all block means, shape (w,); see `run_log_likelihood`."""
    return run_log_likelihood(blocks, law, values).sum(axis=1)


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _filter_runs(residual, noise, slope, slip_error, run_slip_error, starts, rho, tau):
    """Filter each run and integrate out its offset and shared slip error.

    State: the standardised noise z, AR(1) with unit variance; observation noise: the block's own
    slip error times the squared slope. The filter is linear, so it whitens the residual and the
    two shared directions (1 and slope) together; their Gram matrix then gives the quadratic form
    and determinant of the run's covariance by the Woodbury identity.
    """
    n_walkers, n_runs = residual.shape[0], len(starts) - 1
    result = np.empty((n_walkers, n_runs))
    for w in range(n_walkers):
        for i in range(n_runs):
            m_r = m_1 = m_g = 0.0
            variance = 1.0
            rr = r1 = rg = s11 = s1g = sgg = 0.0
            log_determinant = 0.0
            for j in range(starts[i], starts[i + 1]):
                s, g = noise[w, j], slope[w, j]
                total = s * s * variance + g * g * slip_error[j]
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
            d_1, d_g = tau[w] ** 2, run_slip_error[i]
            a, b = 1 + d_1 * s11, d_1 * s1g
            c, d = d_g * s1g, 1 + d_g * sgg
            determinant = a * d - b * c
            x_1 = (d * d_1 * r1 - b * d_g * rg) / determinant
            x_g = (a * d_g * rg - c * d_1 * r1) / determinant
            quadratic = rr - r1 * x_1 - rg * x_g
            size = starts[i + 1] - starts[i]
            log_determinant += np.log(determinant)
            result[w, i] = -0.5 * (quadratic + log_determinant + size * np.log(2 * np.pi))
    return result
