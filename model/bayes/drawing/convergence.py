# SPDX-License-Identifier: MIT
"""Convergence diagnostics: R-hat between ensembles, effective sample sizes, chain length, error."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from model.arrays import Array
from model.bayes.drawing.sampler import Chains, autocorrelation_times

MAX_PARETO_K = 0.7  # tail index from which importance weights are not reliable
MAX_R_HAT = 1.01
MIN_ESS = 400.0
MIN_LENGTH = 50.0  # least length of the chains, in autocorrelation times
MAX_MCSE = 0.05  # largest Monte Carlo error, over the posterior standard deviation
TAILS = 0.05, 0.95  # quantiles whose effective sample size is that of the tails
BURN_IN = 5.0  # length in autocorrelation times; the starts are nearly posterior draws


@dataclass(frozen=True)
class Convergence:
    """Convergence diagnostics; arrays hold one value a sampled coordinate, shape (d,).

    Attributes:
        burn_in: Kept steps left out at the start.
        length: Kept steps after the burn-in.
        autocorrelation_time: Integrated autocorrelation time of the chains with the burn-in, the
            largest over the ensembles [kept steps].
        r_hat: Rank-normalised split R-hat between ensembles (never between walkers, which are
            not independent) [-].
        ess_bulk: Effective sample size of the bulk [-].
        ess_tail: Effective sample size of the 5 % and 95 % quantiles [-].
        mcse: Monte Carlo error of the mean over the posterior standard deviation [-].
        thin: Sampler moves of a kept step.
        pareto_k: Tail index of the weights, where the draws are weighted ones of an approximation
            and no chain; else None [-].
    """

    burn_in: int
    length: int
    autocorrelation_time: Array
    r_hat: Array
    ess_bulk: Array
    ess_tail: Array
    mcse: Array
    thin: int = 1
    pareto_k: float | None = None

    @property
    def weights_reliable(self) -> bool:
        """Whether there are no weights, or reliable ones: a tail index below `MAX_PARETO_K`."""
        return self.pareto_k is None or self.pareto_k < MAX_PARETO_K

    @property
    def moves(self) -> int:
        """Number of sampler moves so far."""
        return (self.burn_in + self.length) * self.thin

    def failures(self) -> list[str]:
        """List the unmet criteria as text, each with its worst value; empty when converged.

        Criteria: R-hat at most `MAX_R_HAT`, Monte Carlo error at most `MAX_MCSE`, bulk and tail ESS
        at least `MIN_ESS`, length at least `MIN_LENGTH` autocorrelation times, and of weighted
        draws a tail index below `MAX_PARETO_K`. NaN counts as unmet.
        """
        length = float((self.length / self.autocorrelation_time).min())
        at_most = [
            ("R-hat between ensembles", float(self.r_hat.max()), MAX_R_HAT),
            ("Monte Carlo error over posterior spread", float(self.mcse.max()), MAX_MCSE),
        ]
        at_least = [
            ("bulk effective sample size", float(self.ess_bulk.min()), MIN_ESS),
            ("tail effective sample size", float(self.ess_tail.min()), MIN_ESS),
            ("chain length in autocorrelation times", length, MIN_LENGTH),
        ]
        unreliable = [] if self.weights_reliable else [_unreliable(self.pareto_k)]
        return [
            *unreliable,
            *(f"{rule} is {x:.3f}, limit {m:g}" for rule, x, m in at_most if not x <= m),
            *(f"{rule} is {x:.0f}, at least {m:g} needed" for rule, x, m in at_least if not x >= m),
        ]

    def summary(self) -> str:
        """Format the worst value of each diagnostic as one line of text."""
        length = float((self.length / self.autocorrelation_time).min())
        kind = (
            f"{length:.0f} autocorrelation times"
            if self.pareto_k is None
            else f"Pareto k of the weights {self.pareto_k:.2f}"
        )
        return (
            f"R-hat {self.r_hat.max():.3f}, bulk ESS {self.ess_bulk.min():.0f}, tail ESS "
            f"{self.ess_tail.min():.0f}, {kind}, Monte Carlo error "
            f"{self.mcse.max():.1%} of the spread"
        )

    @property
    def converged(self) -> bool:
        """Whether all criteria of `failures` are met."""
        return not self.failures()

    def fraction_done(self) -> float:
        """Compute the smallest ratio of chain length or ESS to its requirement, at most 1 [-].

        R-hat and Monte Carlo error are not included: 1 does not mean converged.
        """
        lengths = self.length / self.autocorrelation_time
        return float(
            min(
                lengths.min() / MIN_LENGTH,
                self.ess_bulk.min() / MIN_ESS,
                self.ess_tail.min() / MIN_ESS,
                1.0,
            )
        )


def _unreliable(pareto_k: float | None) -> str:
    """Format as text that the tail index of the weights is too large."""
    return f"tail index of the weights (Pareto k) is {pareto_k:.2f}, below {MAX_PARETO_K:g} needed"


def assess(chains: Chains) -> Convergence:
    """Compute the convergence diagnostics of the chains after a burn-in.

    The burn-in is `BURN_IN` autocorrelation times, but at most half of the chains.

    Args:
        chains: Chains of at least 8 steps.
    """
    times = autocorrelation_times(chains.z)
    burn_in = int(min(np.ceil(BURN_IN * times.max()), chains.n_steps // 2))
    kept = chains.z[:, burn_in:]
    walkers = _as_chains(kept)
    ensembles = kept.reshape(len(kept), -1, kept.shape[-1])
    return Convergence(
        burn_in=burn_in,
        length=kept.shape[1],
        autocorrelation_time=times,
        r_hat=_r_hat(ensembles),
        ess_bulk=_effective(walkers, method="bulk"),
        ess_tail=_effective(walkers, method="tail", prob=TAILS),
        mcse=1 / np.sqrt(_effective(walkers, method="mean")),
        thin=chains.thin,
    )


def assess_weighted(draws: Array, weighted: Array, weights: Array, pareto_k: float) -> Convergence:
    """Compute the diagnostics of weighted draws, which are independent.

    Effective sizes are those of the weighted estimates of the mean (bulk) and of the shares below
    the 5 % and 95 % quantiles (tail), by the variance sum of w²(h - E h)² of an estimate of h.

    Args:
        draws: Coordinates resampled from m independent parts of the draws, shape (m, n, d).
        weighted: Coordinates of all weighted draws, shape (w, d).
        weights: Their weights, with sum one, shape (w,).
        pareto_k: Tail index of the weights [-].
    """
    quantiles = np.quantile(draws.reshape(-1, draws.shape[-1]), TAILS, axis=0)
    tails = [_effective_size((weighted <= q).astype(float), weights) for q in quantiles]
    bulk = _effective_size(weighted, weights)
    return Convergence(
        burn_in=0,
        length=draws.shape[1],
        autocorrelation_time=np.ones(draws.shape[-1]),  # independent but for repeated draws
        r_hat=_r_hat(draws),
        ess_bulk=bulk,
        ess_tail=np.minimum(*tails),
        mcse=1 / np.sqrt(bulk),
        pareto_k=pareto_k,
    )


def _effective_size(h: Array, weights: Array) -> Array:
    """Compute the effective sample size (ESS) of the weighted mean of each column of h, (d,).

    It is the weighted variance of h over the Monte Carlo variance of its mean, the sum of
    w² (h - E h)²; NaN for a column that is constant.

    Args:
        h: A quantity of each draw, shape (w, d).
        weights: Weights with sum one, shape (w,).
    """
    away = (h - weights @ h) ** 2
    return weights @ away / (weights**2 @ away)


def _r_hat(chains: Array) -> Array:
    """Compute the rank-normalised split R-hat of chains (chains, draws, d), shape (d,)."""
    from arviz_stats.base import array_stats  # takes a second

    return np.asarray(array_stats.rhat(chains, chain_axis=0, draw_axis=1, method="rank"))


def _effective(chains: Array, **method: Any) -> Array:
    """Compute effective sample sizes of chains (chains, draws, d), shape (d,)."""
    from arviz_stats.base import array_stats  # takes a second

    return np.asarray(array_stats.ess(chains, chain_axis=0, draw_axis=1, **method))


def _as_chains(z: Array) -> Array:
    """Reshape (ensembles, steps, walkers, d) to ArviZ's (chains, draws, d), a walker a chain."""
    return np.moveaxis(z, 2, 1).reshape(-1, z.shape[1], z.shape[3])
