# SPDX-License-Identifier: MIT
"""Whether the curve goes through the points: mean residuals by load and slip."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from model.arrays import Array
from model.bayes.averaging.load_levels import load_levels, nearest_level
from model.bayes.checks.linear import Linearised, whiten

BINS: Final = 4
"""Groups of slip at each load and sign, of as many blocks each."""
MOST_NAMED: Final = 2


@dataclass(frozen=True)
class GroupResiduals:
    """Mean residuals of m groups of blocks, each of one load, sign and range of slip.

    Attributes:
        load: Load level, shape (m,) [N].
        slip: Mean slip ratio, shape (m,) [-].
        mean: Mean of measured minus predicted traction, less what the fit absorbs, (m,) [N].
        sd: Its standard deviation by the fitted model, shape (m,) [N].
        share: Root mean square of what the means are beyond chance, over the largest force at
            their load [-].
        p: Probability of means as large together by chance, at the scatter of the runs [-].
        gain: Twice the log likelihood that they explain, less their number [-].
    """

    load: Array
    slip: Array
    mean: Array
    sd: Array
    share: float
    p: float
    gain: float

    def worst(self) -> str:
        """Format the groups whose means are most standard deviations from zero as text."""
        order = np.argsort(-np.abs(self.mean / self.sd))[:MOST_NAMED]
        return " and ".join(
            f"{self.mean[i]:+.2g} ± {self.sd[i]:.2g} N at slip {self.slip[i]:.2g} and "
            f"{self.load[i]:.3g} N"
            for i in order
        )


def group_residuals(fit: Linearised) -> GroupResiduals | None:
    r"""Compute mean residuals by load and slip, and how likely they are by chance.

    With columns of W that average a group's blocks, the means are W'(y - f) and their covariance
    is :math:`W' L (1 - Q Q') L' W`, with the Cholesky factor L of the blocks' covariance and the
    basis Q of what the fit absorbs, taken out of the means too. The chi-square is divided by that
    of the means of runs, where these scatter by more than the model says.

    Args:
        fit: The linearised fit.

    Returns:
        The groups; None where the fit absorbs all of them.
    """
    blocks = fit.blocks
    group = _groups(fit)
    names = np.unique(group)
    weights = (group[:, None] == names) * blocks.count[:, None].astype(float)
    weights /= weights.sum(axis=0)
    parts = np.split(weights, blocks.run_starts()[1:-1])
    spread = np.concatenate([L.T @ part for L, part in zip(fit.factors, parts, strict=True)])
    spread = np.vstack([spread, np.zeros((len(fit.rest) - len(blocks), len(names)))])
    spread -= fit.basis @ (fit.basis.T @ spread)
    covariance, mean = spread.T @ spread, spread.T @ fit.rest
    sd = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    size, vectors = np.linalg.eigh(covariance / np.outer(sd, sd))
    kept = size > 1e-3
    if not kept.any():
        return None
    square = float(np.sum((vectors.T @ (mean / sd))[kept] ** 2 / size[kept]))
    over, freedom = _dispersion(fit, group)
    levels = load_levels(blocks)
    level = nearest_level(np.maximum(blocks.normal_force, 1e-9), levels)
    force = np.abs(fit.predicted.force)
    highest = np.array([force[level == i].max(initial=1e-300) for i in range(len(levels))])
    of_group = np.array([level[group == name][0] for name in names])
    beyond = np.maximum(mean**2 - over * sd**2, 0.0) / highest[of_group] ** 2
    return GroupResiduals(
        levels[of_group], weights.T @ blocks.slip, mean, sd * np.sqrt(over),
        float(np.sqrt(np.mean(beyond))),
        float(fdtrc(int(kept.sum()), freedom, square / over / int(kept.sum()))),
        square - 2 * int(kept.sum()),
    )  # fmt: skip


def _groups(fit: Linearised) -> NDArray[np.intp]:
    """Return a number of each block's group: load level, sign of slip, and one of `BINS`."""
    blocks = fit.blocks
    level = nearest_level(np.maximum(blocks.normal_force, 1e-9), load_levels(blocks))
    side = 2 * level + (blocks.slip > 0)
    within = np.zeros(len(blocks), dtype=np.intp)
    for name in np.unique(side):
        mine = side == name
        edges = np.quantile(blocks.slip[mine], np.linspace(0, 1, BINS + 1)[1:-1])
        within[mine] = np.searchsorted(edges, blocks.slip[mine])
    return BINS * side + within


def _dispersion(fit: Linearised, group: NDArray[np.intp]) -> tuple[float, float]:
    """Return the variance of run means within groups over the model's, and its degrees of freedom.

    It is at least 1, and 1 where fewer than four runs repeat a group.
    """
    blocks = fit.blocks
    starts = blocks.run_starts()[:-1]
    one = whiten(blocks, np.ones((len(blocks), 1)), fit.factors)[:, 0]
    told = np.add.reduceat(one * fit.rest[: len(one)], starts)
    score = told / np.sqrt(np.maximum(np.add.reduceat(one**2, starts), 1e-300))
    middle = group[starts + np.diff(blocks.run_starts()) // 2]
    _, of_run = np.unique(middle, return_inverse=True)
    away = score - (np.bincount(of_run, score) / np.bincount(of_run))[of_run]
    freedom = len(score) - int(of_run.max()) - 1
    if freedom < 4:
        return 1.0, float(max(len(blocks) - len(np.unique(group)), 1))
    return max(1.0, float(away @ away) / freedom), float(freedom)
