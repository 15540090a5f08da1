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

import math
from dataclasses import dataclass, fields

import numpy as np
from scipy.linalg import toeplitz

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.block_forces import block_table, fill_forces
from model.compiled import compiled
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
LOG_2PI = math.log(2 * math.pi)


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
    """Compute expected traction, its slopes and the standard deviation of noise of each block.

    Args:
        blocks: The block means, n of them.
        law: The slip law, of k parameters.
        values: Law and measurement parameters, shape (w, k + 11).
        sine: Whether slip within blocks near zero slip is distributed as a sine wave is.
    """
    table, forces = block_table(blocks, sine=sine), np.empty((len(values), 3, len(blocks)))
    for vector, of_vector in zip(values, forces, strict=True):
        fill_forces(law, vector, table, of_vector)
    force, slope, load_slope = forces.swapaxes(0, 1)
    return PredictedForces(force, slope, load_slope, values[:, -3, None] * blocks.noise_size)


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
    table, forces = block_table(blocks), np.empty((3, len(blocks)))
    runs = blocks.run_starts(), np.array(blocks.run_slip_error)
    found = np.empty((len(values), blocks.n_runs))
    for vector, densities in zip(values, found, strict=True):
        fill_forces(law, vector, table, forces)
        _fill_densities(tuple(vector[-5:].tolist()), table, forces, *runs, densities)
    return found


@compiled
def _fill_densities(noise, table, forces, starts, run_slip_error, densities):
    """Compute the log density of each run by a Kalman filter; see `run_log_likelihood`.

    State of the filter: the standardised noise z, AR(1) with unit variance; observation noise: the
    block's own errors of slip and load times the squared slopes. The filter is linear, so it
    whitens the residual and the three directions that a run shares (1 for the zero of traction, the
    slope for its slip error, the slope in load for the zero of load) together. Of their Gram matrix
    the directions are eliminated one by one (Sherman-Morrison and the determinant lemma), each
    with its variance: what is left of the residual is the quadratic form of the run's covariance.

    Args:
        noise: q, sigma_kappa, s_0, rho and tau.
        table: What `block_table` returns of the blocks.
        forces: Expected traction, slope in slip and in load, shape (3, n).
        starts: Index of each run's first block, then the number of blocks, shape (n_runs + 1,).
        run_slip_error: Variance of the error of slip that a run's blocks share, shape (n_runs,).
        densities: Filled with the log densities, shape (n_runs,).
    """
    q, scatter, s_0, rho, tau = noise
    gram, mean, error = np.empty((4, 4)), np.empty(4), np.empty(4)
    for i in range(len(densities)):
        for a in range(4):
            mean[a] = 0.0
            for b in range(4):
                gram[a, b] = 0.0
        variance, log_determinant = 1.0, 0.0
        for j in range(starts[i], starts[i + 1]):
            g, h = forces[1, j], forces[2, j]
            s = s_0 * table.noise_size[j]
            own = q * q * table.slip_error[j] + scatter * scatter
            total = s * s * variance + g * g * own + h * h * table.load_error[j]
            weight = 1.0 / total
            gain = s * variance * weight
            error[0], error[1] = table.traction[j] - forces[0, j], 1.0
            error[2], error[3] = g, h
            for a in range(4):
                error[a] -= s * mean[a]
                mean[a] = rho * (mean[a] + gain * error[a])
            for a in range(4):
                for b in range(4):
                    gram[a, b] += weight * error[a] * error[b]
            log_determinant += math.log(total)
            variance = rho * rho * variance * (1.0 - gain * s) + (1.0 - rho * rho)
        least = 1e-14 * gram[0, 0]
        of_zero, shared = tau * tau, q * q * run_slip_error[i]
        for k, prior in ((1, of_zero), (2, shared), (3, of_zero)):
            pivot = 1.0 + prior * gram[k, k]  # by rounding negative where numbers are absurd: NaN
            log_determinant += math.log(pivot)
            for a in range(4):
                error[a] = gram[a, k]
            for a in range(4):
                for b in range(4):
                    gram[a, b] -= prior / pivot * error[a] * error[b]
        # Where noise is far below everything else, what is left is rounding errors of either sign.
        quadratic = least if gram[0, 0] < least else gram[0, 0]
        size = (starts[i + 1] - starts[i]) * LOG_2PI
        densities[i] = -0.5 * (quadratic + log_determinant + size)


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
