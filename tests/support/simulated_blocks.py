# SPDX-License-Identifier: MIT
r"""Simulate the block means of an experiment from values of all parameters.

The simulation follows the statement of the data in docs/theory.md, and shares no code with the
likelihood but the slip law itself. Where the likelihood expands or averages by few points, the
simulation solves or averages by many: slip and load of 81 points in each block have the block's
moments, the ratio of radii is corrected exactly, and the load that crosstalk hides is solved for.
"""

from dataclasses import replace

import numpy as np
from scipy.special import gammaincinv, ndtri

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.slip.definition import SlipDefinition, slip_ratio
from model.slip.law import SlipLaw

POINTS = 9  # in load, and in slip at one load
ROUNDS = 5  # of the fixed point of traction and load; each gains over two digits
_STRAIGHT = 1e-3  # skewness below which a load counts as Gaussian
_LEAST_LOAD = 1e-9  # N; a law is defined for positive loads


def simulate_blocks(
    layout: SlipBlocks, law: SlipLaw, values: Array, *, rng: np.random.Generator
) -> SlipBlocks:
    r"""Simulate the traction of blocks.

    .. math::
        F_{ij} = \overline{(1 + g_t)\,[f(\kappa, N) - c_r N]} + b_i + s_0 m_i\,u_{ij},
        \qquad N = (1 + g_n) F_n - b_n + c F + z_i + e_{ij} ,

    averaged over the samples of block j of run i; :math:`\kappa` is the slip of the true radii, at
    the block's slip plus errors: one of the block and one that the run shares, of q times the
    standard deviations that the blocks state, and one of the block of :math:`\sigma_\kappa`;
    :math:`b_i, z_i \sim N(0, \tau^2)`, e is the load's error, :math:`m_i` the size of the run's
    noise, and u is a stationary AR(1) process of unit variance and correlation :math:`\rho`, new in
    each run.

    Args:
        layout: The blocks; their traction is not used.
        law: The slip law, of k parameters.
        values: Values of the law's and the measurement's parameters, shape (k + 11,).
        rng: Source of randomness.

    Returns:
        The blocks with the simulated traction, all else as it was: what an experimenter knows.
    """
    k = len(law.parameters)
    size, scatter, s_0, rho, tau = values[k + 6 :]
    own = rng.normal(0.0, np.sqrt(size**2 * layout.slip_error + scatter**2))
    shared = rng.normal(0.0, size * np.sqrt(layout.run_slip_error))
    of_load = rng.normal(0.0, np.sqrt(layout.load_error))
    of_load += rng.normal(0.0, tau, layout.n_runs)[layout.run]
    pressed = replace(layout, normal_force=layout.normal_force + of_load / (1 + values[k + 1]))
    expected = _mean_traction(pressed, law, values, layout.slip + own + shared[layout.run])
    offset = rng.normal(0.0, tau, layout.n_runs)
    noise = s_0 * layout.noise_size * _correlated(layout, rho, rng)
    return replace(layout, traction_force=expected + offset[layout.run] + noise)


def _mean_traction(layout: SlipBlocks, law: SlipLaw, values: Array, slip: Array) -> Array:
    """Average the measured traction without offset and noise over each block, shape (n,) [N].

    Args:
        layout: The blocks.
        law: The slip law.
        values: Values of all parameters, shape (k + 11,).
        slip: True mean slip of each block by the stated radii, shape (n,) [-].
    """
    k = len(law.parameters)
    g_t, g_n, b_n, c, epsilon, c_r = values[k : k + 6]
    slips, loads = _within(layout, slip)
    true_slip = slip_of_true_radii(slips, epsilon, layout.definition)
    traction = np.zeros_like(loads)
    for _ in range(ROUNDS):
        load = np.maximum((1 + g_n) * loads - b_n + c * traction, _LEAST_LOAD)
        traction = (1 + g_t) * (law.force(true_slip, load, values[:k]) - c_r * load)
    return traction.mean(axis=(0, 1))


def _within(layout: SlipBlocks, slip: Array) -> tuple[Array, Array]:
    """Return slips [-] and measured loads [N] of equally likely points of each block, (p, p, n).

    Loads follow a Pearson type III distribution (a shifted gamma) of the block's mean, variance and
    skewness; slip is Gaussian about its regression on load.
    """
    spread = np.sqrt(layout.load_variance)
    loads = layout.normal_force + spread * _skewed(layout.load_skewness)
    follows = np.divide(
        layout.slip_load_covariance, layout.load_variance,
        out=np.zeros(len(layout)), where=layout.load_variance > 0,
    )  # fmt: skip
    rest = np.maximum(layout.slip_wander - follows**2 * layout.load_variance, 0.0)
    at_load = slip + follows * (loads - layout.normal_force)
    slips = at_load[:, None] + np.sqrt(rest) * _standard(ndtri(_middles()))[None, :, None]
    return slips, np.broadcast_to(loads[:, None], slips.shape)


def _middles() -> Array:
    """Return the probabilities in the middle of `POINTS` equal parts of 0 to 1, shape (p,)."""
    return (np.arange(POINTS) + 0.5) / POINTS


def _skewed(skewness: Array) -> Array:
    """Return standardised quantiles of distributions of a skewness (n,), shape (p, n) [-]."""
    size = np.maximum(np.abs(skewness), _STRAIGHT)
    shape = 4 / size**2
    probability = _middles()[:, None]
    gamma = (gammaincinv(shape, probability) - shape) / np.sqrt(shape)
    straight = np.broadcast_to(ndtri(probability), gamma.shape)
    upward = np.where(np.abs(skewness) > _STRAIGHT, gamma, straight)
    return _standard(np.where(skewness < 0, -upward, upward))


def _standard(points: Array) -> Array:
    """Shift and scale points (p, ...) to mean 0 and variance 1 along the first axis."""
    centred = points - points.mean(axis=0)
    return centred / centred.std(axis=0)


def slip_of_true_radii(slip: Array, error: float, definition: SlipDefinition) -> Array:
    """Compute the slip by the true radii from that by the stated ones.

    The ground's speed over the leg's is taken too small by the factor 1 + `error`.

    Args:
        slip: Slip ratio by the stated radii, in `definition` [-].
        error: Relative error of the ratio of radii, ground disc over leg disc, above -1 [-].
        definition: Slip definition.

    >>> slip_of_true_radii(np.array([0.0, 1.0]), 0.01, SlipDefinition.MATERIAL).round(4)
    array([-0.01,  1.  ])
    """
    one_minus = np.maximum(1 - slip, 0) if definition is SlipDefinition.LARGER else 1 - slip
    with np.errstate(divide="ignore"):
        over_leg = 1 / (1 + slip)  # ground's speed over the leg's, of slip over the ground's
    if definition is SlipDefinition.MATERIAL:
        ratio = one_minus
    elif definition is SlipDefinition.TRAVEL:
        ratio = over_leg
    elif definition is SlipDefinition.MEAN:
        ratio = (2 - slip) / (2 + slip)
    else:
        ratio = np.where(slip >= 0, one_minus, over_leg)
    return slip_ratio(1.0, ratio * (1 + error), definition)


def _correlated(layout: SlipBlocks, rho: float, rng: np.random.Generator) -> Array:
    """Draw a stationary AR(1) process of unit variance for each run's blocks, shape (n,) [-]."""
    shock = rng.standard_normal(len(layout))
    starts = set(layout.run_starts().tolist())
    path = np.empty(len(layout))
    for j, each in enumerate(shock):
        path[j] = each if j in starts else rho * path[j - 1] + np.sqrt(1 - rho**2) * each
    return path
