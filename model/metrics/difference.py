# SPDX-License-Identifier: MIT
"""Difference of two quantities that are given by draws."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.errors import InsufficientData

DRAWS = 4000  # number of pairs from which quantiles of the difference are computed


@dataclass(frozen=True)
class PathDifference:
    """Difference of two independently estimated quantities: the second minus the first.

    Attributes:
        median: Median of the difference, in the quantities' unit.
        low: 5 % quantile of the difference.
        high: 95 % quantile of the difference.
        probability: Probability that the second quantity is larger than the first, with half of
            the ties [-].
    """

    median: float
    low: float
    high: float
    probability: float

    @property
    def clear(self) -> bool:
        """Whether zero lies outside the 90 % interval of the difference."""
        return self.low > 0 or self.high < 0


def difference(first: Array, second: Array, *, rng: np.random.Generator) -> PathDifference:
    r"""Compute quantiles of b - a, and the probability that it is positive, from draws of a and b.

    .. math::
        P(b > a) = \frac{1}{n m} \sum_{i, j} \left( [b_j > a_i] + \tfrac12 [b_j = a_i] \right)

    over all pairs, [ ] being 1 where it holds and else 0; the 5, 50 and 95 % quantiles are of the
    differences of `DRAWS` pairs drawn at random.

    Args:
        first: Draws of a, shape (n,).
        second: Draws of b, shape (m,), in the same unit.
        rng: Source of randomness of the pairs.

    Raises:
        InsufficientData: A quantity has no draws, or a draw is not finite.
    """
    if not (len(first) and len(second)):
        raise InsufficientData("a quantity has no draws; a difference needs at least one of each")
    if not (np.isfinite(first).all() and np.isfinite(second).all()):
        raise InsufficientData("a quantity has draws that are not finite; expected finite numbers")
    order = np.sort(first)
    below = np.searchsorted(order, second, side="left")
    not_above = np.searchsorted(order, second, side="right")
    probability = float((below + not_above).mean() / (2 * len(first)))
    drawn = rng.choice(second, DRAWS) - rng.choice(first, DRAWS)
    low, median, high = np.quantile(drawn, [0.05, 0.5, 0.95])
    return PathDifference(float(median), float(low), float(high), probability)
