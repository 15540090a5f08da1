# SPDX-License-Identifier: MIT
"""Difference of two quantities that are given by draws."""

from dataclasses import dataclass

import numpy as np

from model.errors import InsufficientData
from model.slip.law import Array

DRAWS = 4000  # of the difference


@dataclass(frozen=True)
class Difference:
    """Difference of two independently estimated quantities: the second minus the first.

    Attributes:
        median: Its median.
        low: Its 5 % quantile.
        high: Its 95 % quantile.
        probability: Probability that the second is the larger one [-].
    """

    median: float
    low: float
    high: float
    probability: float

    @property
    def clear(self) -> bool:
        """Whether zero lies outside the 90 % interval of the difference."""
        return self.low > 0 or self.high < 0


def difference(first: Array, second: Array, *, rng: np.random.Generator) -> Difference:
    r"""Compute the difference of two quantities from their draws.

    .. math::
        P(b > a) = \frac{1}{n m} \sum_{i, j} \left( [b_j > a_i] + \tfrac12 [b_j = a_i] \right)

    over all pairs; quantiles are of differences of pairs drawn at random.

    Args:
        first: Draws of the first, shape (n,).
        second: Draws of the second, shape (m,).
        rng: Source of randomness.

    Raises:
        InsufficientData: One has no draws, or draws that are not finite.
    """
    if not (len(first) and len(second)):
        raise InsufficientData("a quantity without draws has no difference")
    if not (np.isfinite(first).all() and np.isfinite(second).all()):
        raise InsufficientData("draws that are no finite numbers have no difference")
    order = np.sort(first)
    below = np.searchsorted(order, second, side="left")
    not_above = np.searchsorted(order, second, side="right")
    probability = float((below + not_above).mean() / (2 * len(first)))
    apart = rng.choice(second, DRAWS) - rng.choice(first, DRAWS)
    low, median, high = np.quantile(apart, [0.05, 0.5, 0.95])
    return Difference(float(median), float(low), float(high), probability)
