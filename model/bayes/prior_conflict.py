# SPDX-License-Identifier: MIT
"""Conflict of a stated prior with the data: how far the data move it, and how likely that is."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import chdtrc, chdtri

from model.arrays import Array
from model.bayes.posterior import SlipPosterior
from model.bayes.stated_priors import StatedPriors

CONFLICT_P: Final = 0.01
"""p-value below which prior and data conflict."""
_INFORMED = 0.05  # least share of the prior's variance that the data took away, to compare with
_ALONE = float(chdtri(1, CONFLICT_P))  # statistic of one direction that is a conflict by itself


@dataclass(frozen=True)
class PriorShift:
    """How a stated prior and the data agree.

    Attributes:
        names: The parameters: one, or all of an earlier posterior together.
        shift: Posterior mean less prior mean over the prior's standard deviation, of each (m,) [-].
        statistic: Squared shift over what it is expected to be, chi-squared where they agree [-].
        freedom: Its degrees of freedom: directions of which the data say something; 0 if none.
        p: Probability of a larger statistic where prior and data agree; NaN without freedom [-].
    """

    names: tuple[str, ...]
    shift: Array
    statistic: float
    freedom: int
    p: float

    @property
    def conflict(self) -> bool | None:
        """Whether prior and data conflict; None if the data say nothing of it."""
        return None if self.freedom == 0 else self.p < CONFLICT_P


def prior_shift(names: tuple[str, ...], z: Array, y: Array) -> PriorShift:
    r"""Compare the posterior of independent standard normal coordinates with their prior.

    If the data come from the prior, the mean of the posterior is spread about the prior's with the
    variance that the data took away, :math:`I - \operatorname{Cov}(z)`; where all is Gaussian, so
    that

    .. math::
        m^T (I - \operatorname{Cov}(z))^{-1} m \sim \chi^2_r

    over the r eigen-directions in which it took away 5 % or more. In the others the share is known
    too badly; they count, as if it were 5 %, which lowers the statistic, only where that alone is a
    conflict: a narrow prior far from what the data say.

    Args:
        names: The parameters.
        z: Posterior draws of their coordinates, standard normal and independent a priori, (n, m).
        y: Posterior draws of each one's own coordinate, standard normal a priori, shape (n, m).
    """
    mean, covariance = z.mean(axis=0), np.atleast_2d(np.cov(z.T))
    taken, directions = np.linalg.eigh(np.eye(len(names)) - covariance)
    parts = (mean @ directions) ** 2 / np.maximum(taken, _INFORMED)
    known = (taken > _INFORMED) | (parts > _ALONE)
    statistic = float(np.sum(parts[known]))
    freedom = int(known.sum())
    p = float(chdtrc(freedom, statistic)) if freedom else float("nan")
    return PriorShift(names, y.mean(axis=0), statistic, freedom, p)


def prior_shifts(
    posterior: SlipPosterior, stated: StatedPriors, z: Array
) -> tuple[PriorShift, ...]:
    """Compare each stated prior with the posterior: single parameters, then the earlier posterior.

    Args:
        posterior: The posterior.
        stated: The stated priors.
        z: Posterior draws of the coordinates of its d free parameters, shape (n, d).
    """
    free = [p.name for p in posterior.free]
    y = posterior.own_coordinates(z)
    shifts = [
        prior_shift((name,), y[:, [i]], y[:, [i]])
        for i, name in enumerate(free) if name in stated.single
    ]  # fmt: skip
    if posterior.correlation is not None:
        index = [free.index(name) for name in posterior.correlation.names]
        shifts.append(prior_shift(posterior.correlation.names, z[:, index], y[:, index]))
    return tuple(shifts)
