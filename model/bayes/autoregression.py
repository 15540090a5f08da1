# SPDX-License-Identifier: MIT
"""Autoregressive noise of runs, AR(p): its coefficients, and its variance in each run.

A run is a stretch of rows with the same value in `run`; it begins wherever that changes.
"""

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array


def centred(values: Array, run: NDArray[np.intp]) -> Array:
    """Subtract the mean of its run from each value or row, shape (n,) or (n, k)."""
    starts = np.flatnonzero(np.diff(run, prepend=-1))
    size = np.diff(np.append(starts, len(run)))
    mean = (np.add.reduceat(values, starts, axis=0).T / size).T
    return values - np.repeat(mean, size, axis=0)


def whitened(
    columns: Array, run: NDArray[np.intp], memory: Array
) -> tuple[Array, NDArray[np.intp]]:
    """Whiten rows: subtract what AR coefficients predict from the rows before, then the run's mean.

    Args:
        columns: Values in time order within each run, shape (n, k).
        run: Run of each row, shape (n,).
        memory: AR coefficients of the rows 1, 2, ... before, shape (p,).

    Returns:
        The rows but the first p of each run, shape (m, k), and their runs, shape (m,).
    """
    n = len(memory)
    white = columns[n:] - sum(
        each * columns[n - lag : len(columns) - lag] for lag, each in enumerate(memory, 1)
    )
    inside = run[n:] == run[:-n]
    return centred(white[inside], run[n:][inside]), run[n:][inside]


def run_variances(rest: Array, run: NDArray[np.intp], n_runs: int) -> Array:
    """Estimate the variance of the noise in each run, shape (n_runs,) [N^2].

    It is at least a thousandth of the median over runs of two rows or more, also for a run without
    rows; without such runs the median counts as 1.

    Args:
        rest: Residuals less the mean of their run, shape (n,) [N].
        run: Run of each residual, shape (n,).
        n_runs: Number of runs.
    """
    count = np.bincount(run, minlength=n_runs)
    own = np.bincount(run, rest**2, minlength=n_runs) / np.maximum(count - 1, 1)
    typical = float(np.median(own[count > 1])) if (count > 1).any() else 1.0
    return np.maximum(own, 1e-3 * typical + 1e-300)


def memory_of(rest: Array, run: NDArray[np.intp], weight: Array, *, order: int) -> Array:
    """Estimate AR coefficients by the Yule-Walker equations, shape (order,).

    Autocovariances are pooled over runs by their weight. Subtracting a run's mean lowers all of
    them by the variance of the mean, which is therefore estimated and added, in five iterations.
    All zero if the residuals do not vary.

    Args:
        rest: Residuals less the mean of their run, shape (n,).
        run: Run of each residual, shape (n,).
        weight: Weight of each run, shape (n_runs,).
        order: Number of coefficients.
    """
    lags = range(order + 1)
    pairs = [(np.flatnonzero(run[lag:] == run[: len(run) - lag]), lag) for lag in lags]
    raw = np.array([
        np.sum(weight[run[i]] * rest[i] * rest[i + lag]) / np.sum(weight[run[i]])
        for i, lag in pairs
    ])  # fmt: skip
    length = float(np.sum(weight[run]) / np.sum(weight[np.unique(run)]))
    memory, covariance = np.zeros(order), raw
    for _ in range(5):
        if covariance[0] <= 0:
            return np.zeros(order)
        matrix = covariance[np.abs(np.subtract.outer(lags[:-1], lags[:-1]))]
        ridge = 1e-9 * covariance[0] * np.eye(order)
        memory = np.linalg.solve(matrix + ridge, covariance[1:])
        fresh = covariance[0] - memory @ covariance[1:]
        of_mean = fresh / max(1 - memory.sum(), 0.1) ** 2 / length
        covariance = raw + max(float(of_mean), 0.0)
    return memory
