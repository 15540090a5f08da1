# SPDX-License-Identifier: MIT
"""Bootstrap of means over several walks: whole walks are resampled, never samples."""

from typing import NamedTuple

import numpy as np

from model.arrays import Array
from model.errors import InsufficientData

LEVEL = 0.9  # probability of the central interval


class Interval(NamedTuple):
    """A mean over runs with its central 90 % bootstrap interval, in the unit of the values.

    Attributes:
        mean: Mean over runs.
        low: 5 % quantile of the resampled means.
        high: 95 % quantile of the resampled means.
    """

    mean: float
    low: float
    high: float


def bootstrap_mean(values: Array, *, rng: np.random.Generator, draws: int = 4000) -> Interval:
    """Compute the mean over runs and its bootstrap 90 % interval, resampling whole runs.

    Poses of one walk share its errors, so they are never separated. With three walks there are
    ten different resamples: the interval is then rough, and too narrow.

    Args:
        values: One value a run, shape (runs,); with a NaN among them all results are NaN.
        rng: Source of randomness.
        draws: Number of resamples.

    Raises:
        InsufficientData: There are fewer than two runs.
    """
    if len(values) < 2:
        raise InsufficientData(f"found {len(values)} run; the spread over runs needs two or more")
    chosen = rng.integers(len(values), size=(draws, len(values)))
    low, high = np.quantile(values[chosen].mean(axis=1), [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return Interval(float(values.mean()), float(low), float(high))
