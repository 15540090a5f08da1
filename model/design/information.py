# SPDX-License-Identifier: MIT
r"""Fisher information of runs of the rig in the prior's standard normal coordinates.

Around a draw z of the posterior the predicted block means are linear. With J their derivative by z
and S the covariance of a run's blocks,

.. math::
    I = J^T S^{-1} J, \qquad C = \Bigl(1 + \sum_{runs} I\Bigr)^{-1},

C is the covariance that is left of z after the runs, since z is standard normal a priori. What the
scatter of blocks says of the noise's own parameters is left out: they do not move the mean.

The blocks of a run that is planned are alike, each with the derivative j. So its information is of
rank one, :math:`w_n\,j j^T`, where :math:`w_n = 1^T S_n^{-1} 1` grows with the number n of blocks.
"""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.checks.linear import STEP, whiten
from model.bayes.likelihood import PredictedForces, covariance_factors, predict_blocks, slip_errors
from model.bayes.posterior import SlipPosterior
from model.errors import InsufficientData


@dataclass(frozen=True)
class Conditions:
    """Medians of a calibration's blocks, for runs that are to be measured alike.

    Attributes:
        length: Samples in a block.
        samples: Samples in a run.
        load_spread: Standard deviation of the load within a block over the load [-].
        load_skewness: Skewness of the load within a block [-].
        slip_wander: Variance of the true slip within a block [-].
        slip_error: Variance of the error of a block's slip [-].
        run_slip_error: Variance of the error of slip that the blocks of a run share [-].
        load_error: Standard deviation of the error of a block's load over the load [-].
    """

    length: float
    samples: float
    load_spread: float
    load_skewness: float
    slip_wander: float
    slip_error: float
    run_slip_error: float
    load_error: float


def conditions_of(blocks: SlipBlocks) -> Conditions:
    """Compute the medians over measured blocks, or over runs for what belongs to a run."""
    load = np.maximum(blocks.normal_force, 1e-9)
    return Conditions(
        length=float(np.median(blocks.count)),
        samples=float(np.median(np.bincount(blocks.run, blocks.count))),
        load_spread=float(np.median(np.sqrt(blocks.load_variance) / load)),
        load_skewness=float(np.median(blocks.load_skewness)),
        slip_wander=float(np.median(blocks.slip_wander)),
        slip_error=float(np.median(blocks.slip_error)),
        run_slip_error=float(np.median(blocks.run_slip_error)),
        load_error=float(np.median(np.sqrt(blocks.load_error) / load)),
    )


def planned_blocks(
    slip: Array, load: Array, conditions: Conditions, like: SlipBlocks
) -> SlipBlocks:
    """Return one block for each planned run, without traction.

    Args:
        slip: Slip ratio of each run, shape (n,) [-].
        load: Normal force of each run, shape (n,) [N].
        conditions: Moments of the blocks.
        like: Blocks that have been measured, for the slip definition.
    """
    n = len(slip)
    return SlipBlocks(
        slip=slip,
        normal_force=load,
        traction_force=np.zeros(n),
        count=np.full(n, max(1, round(conditions.length)), dtype=np.intp),
        run=np.arange(n),
        run_names=tuple(f"planned run {number}" for number in range(n)),
        definition=like.definition,
        slip_wander=np.full(n, conditions.slip_wander),
        slip_error=np.full(n, conditions.slip_error),
        load_variance=(conditions.load_spread * load) ** 2,
        load_skewness=np.full(n, conditions.load_skewness),
        slip_load_covariance=np.zeros(n),
        run_slip_error=np.full(n, conditions.run_slip_error),
        load_error=(conditions.load_error * load) ** 2,
        noise_size=np.ones(n),
    )


def usable_draws(posterior: SlipPosterior, z: Array, most: int) -> Array:
    """Return the first draws around which the law has its shape, shape (m, d), m up to `most`.

    Around a draw means at it and at a step to both sides along each coordinate: all of these must
    be finite and have a finite prior density, since derivatives are taken by these steps.

    Args:
        posterior: Law and priors, not straightened.
        z: Draws of its coordinates, shape (w, d).
        most: Number of draws wanted.

    Raises:
        InsufficientData: No draw can be used.
    """
    z = z[np.isfinite(z).all(axis=1)]
    inside = np.array([np.isfinite(posterior.log_prior(_around(each))).all() for each in z], bool)
    if not inside.any():
        raise InsufficientData(
            f"none of {len(z)} posterior draws is a curve of '{posterior.law.name}' within the "
            "priors; calibrate again"
        )
    return z[inside][:most]


def _around(z: Array) -> Array:
    """Return a point (d,), and a step to both sides of it along each coordinate, (1 + 2d, d)."""
    step = STEP * np.eye(len(z))
    return np.concatenate([z[None], z + step, z - step])


def _linear(
    posterior: SlipPosterior, blocks: SlipBlocks, z: Array
) -> tuple[PredictedForces, Array, Array]:
    """Linearise the predicted block means around a draw z (d,) by central differences.

    Returns:
        Predictions at z (n,), their derivative by the coordinates (n, d) [N], and the values of
        the k parameters of the law and 11 of the measurement at z (k + 11,).
    """
    d = len(z)
    values = posterior.values(_around(z))
    every = predict_blocks(blocks, posterior.law, values)
    derivative = (every.force[1 : d + 1] - every.force[d + 1 :]).T / (2 * STEP)
    return every.of_vector(0), derivative, values[0]


def measured_information(posterior: SlipPosterior, z: Array) -> Array:
    """Compute the information of the posterior's own blocks around each draw, shape (m, d, d).

    Args:
        posterior: Blocks, law and priors, not straightened.
        z: Draws of its coordinates, shape (m, d).

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    found = []
    for each in z:
        centre, derivative, values = _linear(posterior, posterior.blocks, each)
        factors = covariance_factors(posterior.blocks, centre, values)
        white = whiten(posterior.blocks, derivative, factors)
        found.append(white.T @ white)
    return np.stack(found)


def run_roots(
    posterior: SlipPosterior,
    blocks: SlipBlocks,
    z: Array,
    *,
    n_blocks: Array,
    shared: Array,
) -> Array:
    r"""Compute roots :math:`\sqrt{w_n}\,j` of the information of planned runs around each draw.

    Args:
        posterior: Law and priors, not straightened.
        blocks: One block for each of r planned runs.
        z: Draws of the coordinates, shape (m, d).
        n_blocks: Numbers of blocks in a run to compute roots for, above 0, not necessarily whole,
            shape (t,).
        shared: Factor on the variance of the slip error that all blocks of a run share, one for
            each of `n_blocks`, shape (t,).

    Returns:
        The roots, whose outer products are the information, shape (m, t, r, d) [-].
    """
    found = []
    for each in z:
        centre, derivative, values = _linear(posterior, blocks, each)
        own, common = slip_errors(blocks, values)
        rho, tau = float(values[-2]), float(values[-1])
        sizes = white_sizes(
            centre.noise, centre.slope**2 * own + centre.load_slope**2 * blocks.load_error,
            rho=rho, most=int(np.ceil(n_blocks.max())),
        )  # fmt: skip
        size = np.stack([_between(sizes, n) for n in n_blocks])
        zeros = tau**2 * (1 + centre.load_slope**2)
        size = size / (1 + size * (zeros + centre.slope**2 * common * shared[:, None]))
        found.append(np.sqrt(size)[..., None] * derivative)
    return np.stack(found)


def white_sizes(noise: Array, scatter: Array, *, rho: float, most: int) -> Array:
    r"""Compute :math:`1^T S_n^{-1} 1` of runs of 1 to `most` blocks, shape (most, r) [1/N^2].

    This is the information on a constant that moves all n blocks of a run alike. S is the
    covariance of AR(1) noise and independent scatter; the Kalman filter is that of
    `model.bayes.compiled_likelihood.filter_run`.

    Args:
        noise: Standard deviation of the AR(1) noise of each run's blocks, shape (r,) [N].
        scatter: Variance of what is independent between blocks, shape (r,) [N^2].
        rho: Correlation of the noise of successive blocks [-].
        most: Largest number of blocks.
    """
    mean, variance, size = np.zeros_like(noise), np.ones_like(noise), np.zeros_like(noise)
    sizes = []
    for _ in range(most):
        total = noise**2 * variance + scatter
        left = 1 - noise * mean
        size = size + left**2 / total
        gain = variance * noise / total
        mean = rho * (mean + gain * left)
        variance = rho**2 * variance * (1 - gain * noise) + 1 - rho**2
        sizes.append(size)
    return np.stack(sizes)


def _between(sizes: Array, n: float) -> Array:
    """Interpolate `white_sizes`, shape (most, r), linearly at a number n of blocks; 0 at n = 0."""
    below = int(np.floor(n))
    low = sizes[below - 1] if below else np.zeros_like(sizes[0])
    high = sizes[min(below, len(sizes) - 1)]
    return low + (n - below) * (high - low)
