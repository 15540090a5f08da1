# SPDX-License-Identifier: MIT
"""Spread of the edges of markers in the picture: its prior, and what is known of it."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array

EDGE_SCALE = 0.1
"""Scale of the half-Cauchy prior of the edges' spread [px]."""

EDGE_SPREADS = np.geomspace(5e-3, 0.4, 10)
"""Spreads of edges that are compared [px]."""


@dataclass(frozen=True)
class EdgeSpread:
    """What is known of the spread of edges.

    Attributes:
        log_weights: Log posterior of each of `EDGE_SPREADS`, up to a constant, shape (m,).
    """

    log_weights: Array

    @property
    def weights(self) -> Array:
        """Posterior probability of each of `EDGE_SPREADS`, shape (m,)."""
        weights = np.exp(self.log_weights - self.log_weights.max())
        return weights / weights.sum()

    @property
    def sd(self) -> float:
        """Root of the posterior mean of the variance [px]."""
        return float(np.sqrt(self.weights @ EDGE_SPREADS**2))
