# SPDX-License-Identifier: MIT
r"""Points of slip that stand for all slips within a block: Gauss-Hermite quadrature.

The mean of a curve f over a Gaussian of mean :math:`\kappa` and standard deviation :math:`\omega`
is :math:`f(\kappa)` plus a sum over pairs of points of weights times second differences
:math:`f(\kappa + a\omega) - 2f(\kappa) + f(\kappa - a\omega)`; its slope across the Gaussian is the
sum of weights times :math:`a\,(f(\kappa + a\omega) - f(\kappa - a\omega))/\omega`.

A slip curve bends over distances as small as its peak's slip where it is near zero, and as large as
the slip itself far from zero. So one pair is enough for blocks far from zero, and those near it
have five: at a leg's light load, whose curve rises and falls within two standard deviations of a
slip that wanders by 0.01, one pair is wrong by 12 % of the peak, two by 9 % and five by 1 %.
"""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array

FAR: Final = 8.0  # standard deviations of slip from zero, beyond which one pair is enough
NEAR_PAIRS: Final = 5


def _pairs(points: Array, weights: Array) -> tuple[Array, Array]:
    """Return the positive points of a symmetric rule and their shares of the weights."""
    positive = points > 1e-9
    return points[positive], weights[positive] / weights.sum()


_NODES = 2 * NEAR_PAIRS + 1
_ONE = _pairs(*np.polynomial.hermite_e.hermegauss(3))
_GAUSS = _pairs(*np.polynomial.hermite_e.hermegauss(_NODES))
_SINE = _pairs(
    np.sqrt(2) * np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES), np.ones(_NODES)
)  # Gauss-Chebyshev: the values of a sine wave

POINTS: Final = np.concatenate([_ONE[0], _GAUSS[0], _SINE[0]])
"""Distances of pairs of points in standard deviations: one pair, five, and five of a sine wave."""
WEIGHTS: Final = np.concatenate([_ONE[1], _GAUSS[1], _SINE[1]])
"""Weight of each point of these pairs."""


class SlipRule(NamedTuple):
    """The pairs of points of each block; shape (n,) each.

    Attributes:
        sd: Standard deviation of slip within the block [-].
        first: Index into `POINTS` of the block's first pair.
        last: Index behind that of its last pair.
    """

    sd: Array
    first: NDArray[np.intp]
    last: NDArray[np.intp]


def slip_rule(slip: Array, variance: Array, *, sine: bool = False) -> SlipRule:
    """Choose the points for blocks: five pairs where slip is within `FAR` sd of zero, else one.

    Args:
        slip: Mean slip of each block, shape (n,) [-].
        variance: Variance of slip around it, positive, shape (n,) [-].
        sine: Whether slip within blocks near zero is distributed as a sine wave is, instead of as
            a Gaussian.
    """
    sd = np.sqrt(variance)
    near = np.abs(slip) < FAR * sd
    first = np.where(near, 1 + NEAR_PAIRS * sine, 0)
    return SlipRule(sd, first, first + np.where(near, NEAR_PAIRS, 1))
