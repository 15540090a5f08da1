# SPDX-License-Identifier: MIT
r"""Likelihood of block means with Student-t noise, which a few far blocks hardly move.

Each block's density given the blocks before it in its run is a Student-t of :math:`\nu` degrees of
freedom about what a Kalman filter expects,

.. math::
    F_j | F_1 \ldots F_{j-1} \sim t_\nu(\hat F_j, S_j), \qquad
    a_j = a_{j|j-1} + \lambda_j P H S_j^{-1} (F_j - \hat F_j), \qquad
    \lambda_j = \min\Bigl(1, \frac{\nu + 1}{\nu + (F_j - \hat F_j)^2 / S_j}\Bigr),

with the state a of noise, run offset and shared slip error, H their weights in the force, P their
covariance, and S the squared scale that the filter of `model.bayes.likelihood` has as variance. The
score of the t moves the state (Harvey 2013, Dynamic Models for Volatility and Heavy Tails, 3), in
full within one scale of what was expected: a far block moves neither the offset of its run nor what
the next block is expected to be. The product of these densities is one of the whole run, and that
of Gaussian noise where :math:`\nu` tends to infinity.
"""

import math

import numpy as np
from scipy.special import ndtri, stdtr

from model.arrays import Array
from model.bayes.blocks import SlipBlocks
from model.bayes.likelihood import PredictedForces
from model.compiled import compiled

TAILS = (3.0, 5.0, 10.0, 30.0)
"""Degrees of freedom that a fit chooses from [-]."""


def student_log_likelihood(
    blocks: SlipBlocks, predicted: PredictedForces, values: Array, tail: float
) -> Array:
    """Compute the log density of each run's measured block means of traction.

    Args:
        blocks: The block means.
        predicted: Predictions by the w parameter vectors; their noise is the scale of the t.
        values: Law and measurement parameters, of which the last six are used, shape (w, k + 12).
        tail: Degrees of freedom [-].

    Returns:
        Log density of each run, shape (w, n_runs).
    """
    return _filtered(blocks, predicted, values, tail)[0]


def normal_scores(
    blocks: SlipBlocks, predicted: PredictedForces, values: Array, tail: float
) -> Array:
    """Compute what each block is away from expectation, as quantiles of a standard normal.

    Args:
        blocks: The block means, n of them.
        predicted: Predictions by the w parameter vectors.
        values: Law and measurement parameters, shape (w, k + 12).
        tail: Degrees of freedom [-].

    Returns:
        Scores, white N(0, 1) if the model holds, shape (w, n) [-].
    """
    standard = _filtered(blocks, predicted, values, tail)[1]
    size = np.minimum(np.abs(standard), 1e6)
    return -np.sign(standard) * ndtri(stdtr(tail, -size))


def _filtered(
    blocks: SlipBlocks, predicted: PredictedForces, values: Array, tail: float
) -> tuple[Array, Array]:
    """Return the log density of each run (w, n_runs), and the scaled innovations (w, n)."""
    return filter_student_runs(
        blocks.traction_force - predicted.force, predicted.noise, predicted.slope,
        blocks.slip_error, blocks.run_slip_error, blocks.run_starts(), values[:, -6],
        values[:, -5], values[:, -2], values[:, -1], tail,
    )  # fmt: skip


@compiled
def filter_student_runs(
    residual, noise, slope, slip_error, run_slip_error, starts, size, scatter, rho, tau, tail
):
    """Compute each run's log density and scaled innovations by the filter of this module.

    `residual`, `noise` and `slope` are (w, n), `slip_error` (n,), `run_slip_error` (n_runs,),
    `starts` (n_runs + 1,), `size` (of slip errors over their estimates), `scatter`, `rho` and `tau`
    (w,), `tail` a number; the results are (w, n_runs) and (w, n). State: standardised noise z,
    offset b and shared slip error e.
    """
    n_walkers, n_runs = residual.shape[0], len(starts) - 1
    result = np.empty((n_walkers, n_runs))
    standard = np.empty(residual.shape)
    constant = (
        math.lgamma(0.5 * (tail + 1)) - math.lgamma(0.5 * tail) - 0.5 * math.log(tail * math.pi)
    )
    for w in range(n_walkers):
        r2, q, own = rho[w] ** 2, size[w] ** 2, scatter[w] ** 2
        for i in range(n_runs):
            z = b = e = 0.0
            zz, bb, ee = 1.0, tau[w] ** 2, q * run_slip_error[i]
            zb = ze = be = 0.0
            total = 0.0
            for j in range(starts[i], starts[i + 1]):
                s, g = noise[w, j], slope[w, j]
                hz, hb, he = s * zz + zb + g * ze, s * zb + bb + g * be, s * ze + be + g * ee
                scale = s * hz + hb + g * he + g * g * (q * slip_error[j] + own)
                away = residual[w, j] - s * z - b - g * e
                distance = away * away / scale
                total += (
                    constant - 0.5 * math.log(scale)
                    - 0.5 * (tail + 1) * math.log1p(distance / tail)
                )  # fmt: skip
                standard[w, j] = away / math.sqrt(scale)
                weight = min(1.0, (tail + 1) / (tail + distance)) / scale
                z, b, e = (
                    rho[w] * (z + weight * hz * away), b + weight * hb * away,
                    e + weight * he * away,
                )  # fmt: skip
                zz = r2 * (zz - weight * hz * hz) + 1 - r2
                zb = rho[w] * (zb - weight * hz * hb)
                ze = rho[w] * (ze - weight * hz * he)
                bb -= weight * hb * hb
                be -= weight * hb * he
                ee -= weight * he * he
            result[w, i] = total
    return result, standard
