# SPDX-License-Identifier: MIT
"""Compute a log density of many points in batches, on several threads at once."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from model.arrays import Array
from model.bayes.drawing.laplace import LogDensity

SMALL, LARGE = 16, 64  # points in a batch: of a search, and of many draws
MANY = 512  # points, from which batches are large


def in_batches(log_density: LogDensity, threads: int) -> LogDensity:
    """Return a log density that computes batches of its points on several threads.

    A batch has `SMALL` points, or `LARGE` from `MANY` points in all on. It depends on the number of
    points alone, and so do the results to the last bit.

    Args:
        log_density: Log density of coordinates (w, d); numpy and numba release the GIL in it.
        threads: Number of batches that are computed at once.
    """

    def spread(z: Array) -> Array:
        """Compute the log density (w,) of coordinates (w, d), one batch a call."""
        size = SMALL if len(z) < MANY else LARGE
        batches = [z[first : first + size] for first in range(0, len(z), size)]
        if threads == 1 or len(batches) == 1:
            return np.concatenate([log_density(batch) for batch in batches])
        with ThreadPoolExecutor(threads) as pool:
            return np.concatenate(list(pool.map(log_density, batches)))

    return spread
