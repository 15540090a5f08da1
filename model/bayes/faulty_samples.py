# SPDX-License-Identifier: MIT
"""Faulty samples as they are counted: those that leap, and those at the end of a range."""

from dataclasses import dataclass

FEWEST_OUTLIERS = 3
OUTLIER_SHARE = 1e-4  # of the samples


@dataclass(frozen=True)
class Outliers:
    """Samples that leap from both neighbours.

    Attributes:
        count: Number of such samples.
        share: Their share of all samples [-].
        size: Median leap [N].
        run: Index of the run with the most of them; 0 if there are none.
    """

    count: int
    share: float
    size: float
    run: int

    @property
    def matter(self) -> bool:
        """Whether there are more than chance, or a single fault, makes."""
        return self.count >= FEWEST_OUTLIERS and self.share >= OUTLIER_SHARE


@dataclass(frozen=True)
class Clipped:
    """Samples of a force that lie at its extreme.

    Attributes:
        limit: The extreme [N].
        count: Number of samples exactly there.
    """

    limit: float
    count: int
