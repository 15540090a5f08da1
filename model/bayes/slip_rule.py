# SPDX-License-Identifier: MIT
r"""Points of slip that stand for all slips within a block: Gauss-Hermite quadrature.

The mean of a curve f over a Gaussian of mean :math:`\kappa` and standard deviation :math:`\omega`
is :math:`f(\kappa)` plus a weighted sum of second differences
:math:`f(\kappa + a) - 2f(\kappa) + f(\kappa - a)`, and its slope across the Gaussian a weighted sum
of the differences :math:`f(\kappa + a) - f(\kappa - a)`.

A slip curve bends over distances as small as its peak's slip where it is near zero, and as large as
the slip itself far from zero. So three points are enough for blocks far from zero, and those near
it have five: at the light loads of a leg, whose curve rises within a few standard deviations, three
points are wrong by one hundredth of the peak, and five by less than two thousandths.
"""

from dataclasses import dataclass

import numpy as np

from model.slip.law import Array

FAR = 8.0  # standard deviations of slip from zero, beyond which three points are enough
GAUSS_THREE = (np.sqrt(3.0), 0.0), (1 / 6, 0.0)
GAUSS_FIVE = (
    (np.sqrt(5 - np.sqrt(10)), np.sqrt(5 + np.sqrt(10))),
    ((7 + 2 * np.sqrt(10)) / 60, (7 - 2 * np.sqrt(10)) / 60),
)
SINE_FIVE = (np.sqrt(2) * np.cos(np.pi * np.array([0.3, 0.1])), (0.2, 0.2))
"""Distances of the inner and the outer pair in standard deviations, and the weights of each point:
those of a Gaussian, and of the values of a sine wave (Gauss-Chebyshev)."""


@dataclass(frozen=True)
class SlipRule:
    """Distances and weights of two pairs of points around the slip of each block; shape (n,) each.

    Attributes:
        inner: Distance of the inner pair from the block's slip [-].
        outer: Distance of the outer pair [-].
        inner_weight: Weight of the second difference of the inner pair [-].
        outer_weight: That of the outer pair, 0 where there are three points [-].
        inner_slope: Weight of the difference of the inner pair in the slope [-].
        outer_slope: That of the outer pair [-].
    """

    inner: Array
    outer: Array
    inner_weight: Array
    outer_weight: Array
    inner_slope: Array
    outer_slope: Array


def slip_rule(slip: Array, variance: Array, *, sine: bool = False) -> SlipRule:
    """Choose the points for blocks.

    Args:
        slip: Mean slip of each block, shape (n,) [-].
        variance: Variance of slip around it, positive, shape (n,) [-].
        sine: Whether slip within blocks near zero is distributed as a sine wave is, instead of as
            a Gaussian.
    """
    sd = np.sqrt(variance)
    near = np.abs(slip) < FAR * sd
    (a, b), (v, w) = SINE_FIVE if sine else GAUSS_FIVE
    (far_a, far_b), (far_v, far_w) = GAUSS_THREE
    inner, outer = np.where(near, a, far_a), np.where(near, b, far_b)
    inner_weight, outer_weight = np.where(near, v, far_v), np.where(near, w, far_w)
    return SlipRule(
        inner * sd, outer * sd, inner_weight, outer_weight,
        inner_weight * inner / sd, outer_weight * outer / sd,
    )  # fmt: skip
