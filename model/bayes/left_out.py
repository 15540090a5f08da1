# SPDX-License-Identifier: MIT
"""Predictive density of left-out runs, or of all runs at a load, by weighted draws (PSIS-LOO)."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from model.arrays import Array
from model.bayes.cross_validation import MAX_SINGLE_FOLDS, N_GROUPED_FOLDS
from model.bayes.drawing.convergence import MAX_PARETO_K
from model.bayes.drawing.importance import (
    Effort,
    WeightedDraws,
    draws_at_modes,
    pareto_smoothed,
)
from model.bayes.drawing.laplace import Laplace, find_modes
from model.bayes.posterior import SlipPosterior
from model.tasks import compute_tasks

EFFORT = Effort(draws=2_000, wanted=200.0)  # of a posterior, also without a group
_NEGLIGIBLE = 1e-12  # weight of a draw that is left out


@dataclass(frozen=True)
class LeftOut:
    """Log predictive density of each run given the other groups of runs.

    Attributes:
        group: Group that each run was left out with, shape (n_runs,).
        log_density: Log density of each run's blocks given the runs of the other groups, posterior
            draws averaged, shape (n_runs,) [-].
        pareto_k: Tail index of the weights that stand for the posterior without each group, shape
            (n_groups,) [-].
        refitted: Whether the posterior without a group was computed anew, (n_groups,).
    """

    group: NDArray[np.intp]
    log_density: Array
    pareto_k: Array
    refitted: NDArray[np.bool_]

    @property
    def unreliable(self) -> int:
        """Number of groups whose weights are not reliable, though computed anew."""
        return int(np.sum(~(self.pareto_k < MAX_PARETO_K)))


@dataclass(frozen=True)
class Refit:
    """A fit to the runs of all groups but some: an independent task.

    Attributes:
        posterior: The posterior of all runs.
        left_out: Whether each run is left out, shape (n_runs,).
        starts: Coordinates at which searches for modes start, shape (n, d).
        rng: Source of randomness of its own.
    """

    posterior: SlipPosterior
    left_out: NDArray[np.bool_]
    starts: Array
    rng: np.random.Generator


@dataclass(frozen=True)
class Refitted:
    """Result of a `Refit`.

    Attributes:
        log_density: Log density of each run that was left out, shape (runs left out,) [-].
        pareto_k: Tail index of the weights of the draws that it averages [-].
    """

    log_density: Array
    pareto_k: float


@dataclass(frozen=True)
class ByWeights:
    """Predictions of left-out groups by weights alone, and the fits that those need that are bad.

    Attributes:
        by_weights: The predictions, as far as weights tell them.
        folds: Indices of the groups that each refit leaves out.
        refits: The refits, one for each fold.
    """

    by_weights: LeftOut
    folds: tuple[NDArray[np.intp], ...]
    refits: tuple[Refit, ...]

    def with_refits(self, found: Sequence[Refitted]) -> LeftOut:
        """Return the predictions with those of the refits in place of the bad ones.

        Args:
            found: Results of `refits`, in their order.
        """
        group = self.by_weights.group
        log_density, pareto_k = self.by_weights.log_density.copy(), self.by_weights.pareto_k.copy()
        for fold, each in zip(self.folds, found, strict=True):
            log_density[np.isin(group, fold)], pareto_k[fold] = each.log_density, each.pareto_k
        return LeftOut(group, log_density, pareto_k, self.by_weights.refitted)


def leave_out(
    posterior: SlipPosterior,
    draws: WeightedDraws,
    group: NDArray[np.intp],
    *,
    modes: Sequence[Laplace],
    rng: np.random.Generator,
    executor: Executor | None = None,
) -> LeftOut:
    """Compute the density of each run's blocks given the runs of the other groups.

    Args:
        posterior: The posterior of all runs.
        draws: Weighted draws of it.
        group: Group of each run, from 0, shape (n_runs,). At least two groups.
        modes: Its Laplace approximations; searches for modes start at theirs.
        rng: Source of randomness of draws that are made anew.
        executor: Where fits without a group are computed; None for here.

    Raises:
        FitError: Without a group's runs all modes lie outside the posterior's support.
    """
    weighed = by_weights(posterior, draws, group, modes=modes, rng=rng)
    refits = weighed.refits
    found = compute_tasks(executor, refit_without, refits)
    return weighed.with_refits(list(found))


def by_weights(
    posterior: SlipPosterior,
    draws: WeightedDraws,
    group: NDArray[np.intp],
    *,
    modes: Sequence[Laplace],
    rng: np.random.Generator,
) -> ByWeights:
    r"""Weight draws for each left-out group, and tell which groups need a fit without them.

    .. math::
        \log p(y_i | y_{-G}) = \log \frac{\sum_s w_s p(y_i|\theta_s)}{\sum_s w_s}, \qquad
        w_s \propto \frac{p(\theta_s|y)}{q(\theta_s)\, p(y_G|\theta_s)},

    with run i in the group G, and Pareto-smoothed weights of draws from q (Vehtari, Gelman and
    Gabry 2017). Where their tail index exceeds `MAX_PARETO_K`, the posterior without the group is
    approximated and drawn from anew, without each such group alone, or if they are more than 20
    in 10 interleaved folds of them. Draws at which the law is not valid at one of the loads of all
    data count as impossible, unless all are.

    Args:
        posterior: The posterior of all runs.
        draws: Weighted draws of it.
        group: Group of each run, from 0, shape (n_runs,). At least two groups.
        modes: Its Laplace approximations; searches for modes start at theirs.
        rng: Source of randomness, of which each refit has its own.
    """
    kept = draws.weights > _NEGLIGIBLE
    z, weights = draws.z[kept], draws.weights[kept]
    density = posterior.run_log_likelihood(z)
    n_groups = int(group.max()) + 1
    log_density, pareto_k = np.empty(len(group)), np.empty(n_groups)
    for index in range(n_groups):
        mine = group == index
        own = density[:, mine]
        smoothed, pareto_k[index] = pareto_smoothed(np.log(weights) - own.sum(axis=1))
        log_density[mine] = logsumexp(smoothed[:, None] + own, axis=0)
    refitted = ~(pareto_k < MAX_PARETO_K)
    starts = np.stack([laplace.mode for laplace in modes])
    folds = _folds(np.flatnonzero(refitted))
    refits = tuple(
        Refit(posterior, np.isin(group, fold), starts, own)
        for fold, own in zip(folds, rng.spawn(len(folds)), strict=True)
    )
    return ByWeights(LeftOut(group, log_density, pareto_k, refitted), tuple(folds), refits)


def _folds(groups: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Return groups one by one, or if they are many in interleaved folds, as `cross_validate`."""
    n_folds = len(groups) if len(groups) <= MAX_SINGLE_FOLDS else N_GROUPED_FOLDS
    return [groups[index::n_folds] for index in range(n_folds)]


def refit_without(task: Refit) -> Refitted:
    """Compute log densities of left-out runs by draws of the posterior without them.

    Draws at which the law is not valid at one of the loads of all data are left out, unless all are
    such.

    Args:
        task: The refit.

    Raises:
        FitError: Without these runs all modes lie outside the posterior's support.
    """
    posterior, left_out = task.posterior, task.left_out
    without = posterior.without_runs(left_out)
    modes = find_modes(without.log_density, task.starts)
    draws = draws_at_modes(modes, without.log_density, effort=EFFORT, rng=task.rng)
    likely = draws.weights > _NEGLIGIBLE
    valid = likely & np.isfinite(posterior.log_prior(draws.z))
    used = valid if valid.any() else likely
    density = posterior.without_runs(~left_out).run_log_likelihood(draws.z[used])
    weights = np.log(draws.weights[used] / draws.weights[used].sum())
    log_density = np.asarray(logsumexp(weights[:, None] + density, axis=0))
    return Refitted(log_density, draws.pareto_k)
