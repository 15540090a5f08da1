# SPDX-License-Identifier: MIT
r"""Choose the slips of further runs that leave the least uncertainty of targets.

The objective is the mean over targets, their parts and draws of the posterior of

.. math::
    \log\,\mathrm{sd}, \qquad \mathrm{sd}^2 = a^T C a, \qquad
    C = \Bigl(I_0 + \sum_i n_i \sum_l v_{il} v_{il}^T\Bigr)^{-1}

with the derivative a of a target, the information :math:`I_0` before, the number :math:`n_i` of
points at slip i, and the root :math:`v_{il}` of a point's information at load l.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.design.targets import Target

PASSES = 4  # most passes of exchanges; further ones have changed nothing
SKELETON = 7  # number of slips that are always measured


@dataclass(frozen=True)
class Design:
    """Numbers of points at candidate slips.

    Attributes:
        counts: Number of points at each candidate slip, the same at every load, shape (n,).
        objective: Mean log standard deviation of the targets after these points [-].
        covariance: Posterior covariance of the coordinates after these points, around each of m
            draws, shape (m, d, d) [-].
    """

    counts: NDArray[np.intp]
    objective: float
    covariance: Array


def objective(covariance: Array, targets: Sequence[Target]) -> float:
    """Compute the mean log standard deviation of targets, of covariances (m, d, d) [-]."""
    return float(np.mean([target.log_sd(covariance).mean() for target in targets]))


def spaced(low: float, high: float, count: int) -> Array:
    """Return increasing slip ratios over a range, spaced quadratically: closest near zero.

    Both ends of the range are among them. If it has both signs, so is zero, and each side has about
    half of them.

    Args:
        low: Smallest slip ratio [-].
        high: Largest slip ratio [-].
        count: Number of slip ratios, at least 3; with both signs an even one gives one more.

    >>> spaced(0.0, 1.0, 5).tolist()
    [0.0, 0.0625, 0.25, 0.5625, 1.0]
    >>> spaced(-0.4, 1.0, 5).tolist()
    [-0.4, -0.1, 0.0, 0.25, 1.0]
    """
    if low < 0 < high:
        half = np.linspace(0.0, 1.0, count // 2 + 1) ** 2
        return np.concatenate([low * half[:0:-1], high * half])
    share = np.linspace(0.0, 1.0, count) ** 2
    if high <= 0:
        return (high + (low - high) * share)[::-1]
    return low + (high - low) * share


def planned(
    before: Array, roots: Array, counts: NDArray[np.intp], targets: Sequence[Target]
) -> Design:
    """Compute the posterior covariance and the objective after given numbers of points.

    Args:
        before: Fisher information before these points, the prior's included, around each of m
            draws, shape (m, d, d).
        roots: Vectors v whose outer products v v^T are the information of one point at each slip
            and load, shape (m, n, l, d).
        counts: Number of points at each slip, shape (n,).
        targets: The targets.
    """
    added = np.einsum("n,mnli,mnlj->mij", counts.astype(float), roots, roots)
    covariance = np.asarray(np.linalg.inv(before + added), dtype=float)
    return Design(counts, objective(covariance, targets), covariance)


def choose_slips(
    before: Array,
    roots: Array,
    targets: Sequence[Target],
    *,
    count: int,
    kept: NDArray[np.intp],
) -> Design:
    """Choose slips greedily, then exchange them one by one while that lowers the objective.

    Args:
        before: Fisher information before these points, the prior's included, around each of m
            draws, shape (m, d, d).
        roots: Vectors v whose outer products v v^T are the information of one point at each slip
            and load, shape (m, n, l, d).
        targets: The targets.
        count: Number of points at each load, at least as many as are kept.
        kept: Indices of slips that are always measured.
    """
    n = roots.shape[1]
    fixed = np.bincount(kept, minlength=n)
    counts = fixed.copy()
    for _ in range(count - len(kept)):
        information = _information(before, roots, counts)
        counts[_best_addition(information, roots, targets)] += 1
    for _ in range(PASSES):
        if not _exchange(before, roots, targets, counts, fixed):
            break
    return planned(before, roots, counts, targets)


def _exchange(
    before: Array, roots: Array, targets: Sequence[Target], counts: NDArray[np.intp],
    fixed: NDArray[np.intp],
) -> bool:  # fmt: skip
    """Make one pass of exchanges: move each point to the best slip, unless it is fixed.

    `counts` (n,) is changed in place; `fixed` (n,) of them stay. Return whether a point was moved.
    """
    moved = False
    for index in np.flatnonzero(counts > fixed):
        for _ in range(counts[index] - fixed[index]):
            counts[index] -= 1
            information = _information(before, roots, counts)
            best = _best_addition(information, roots, targets, stay=int(index))
            counts[best] += 1
            if best == index:
                break
            moved = True
    return moved


def _information(before: Array, roots: Array, counts: NDArray[np.intp]) -> Array:
    """Compute the Fisher information (m, d, d) with `counts` (n,) points added to `before`."""
    some = np.flatnonzero(counts)
    chosen = roots[:, some] * np.sqrt(counts[some])[:, None, None]
    m, d = before.shape[:2]
    flat = chosen.reshape(m, -1, d)
    return before + np.swapaxes(flat, 1, 2) @ flat


def _best_addition(
    information: Array, roots: Array, targets: Sequence[Target], *, stay: int | None = None
) -> int:
    """Return the index of the slip at which one more point lowers the objective most.

    It is `stay`, if given, unless another slip is better by more than rounding. By Woodbury's
    identity a point at slip i with roots V (d, l) reduces a target's variance by b G^-1 b^T, with
    b = a C V and G = 1 + V^T C V.
    """
    covariance = np.asarray(np.linalg.inv(information), dtype=float)
    v = np.swapaxes(roots, 2, 3)  # (m, n, d, l)
    cv = covariance[:, None] @ v
    inner = np.linalg.inv(np.eye(v.shape[-1]) + np.swapaxes(v, 2, 3) @ cv)
    left = np.zeros(roots.shape[1])
    for target in targets:
        now = np.exp(2 * target.log_sd(covariance))[:, None]  # (m, 1, parts)
        b = target.rows[:, None] @ cv  # (m, n, parts, l)
        taken = ((b @ inner) * b).sum(axis=-1)
        left += 0.5 * np.log(np.maximum(1 - taken / now, 1e-12)).mean(axis=(0, 2))
    best = int(np.argmin(left))
    if stay is not None and left[best] > left[stay] - 1e-9 * len(targets):
        return stay
    return best
