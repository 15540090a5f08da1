# SPDX-License-Identifier: MIT
"""Independent emcee ensembles that are sampled in parallel; the only importer of emcee.

R-hat needs independent chains. The walkers of one ensemble propose along each other's
differences, so an ensemble is one chain. Several are run, each with its own seed and start.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from emcee import EnsembleSampler, State
from emcee.autocorr import integrated_time
from emcee.moves import DEMove, MHMove

from model.arrays import Array
from model.bayes.drawing.mixture import StudentMixture
from model.errors import DomainError, FitError

MOVES = ((DEMove, 1.0),)
"""Moves of emcee with their shares, without jumps: differential evolution alone.

In 12 dimensions its autocorrelation time is a quarter of the stretch move's.

The snooker move is not used: emcee's, up to 3.1.6, lacks half of the exponent of its acceptance
ratio and narrows every spread by 7 %.
"""
JUMPS = 0.8  # share of the moves that jump, where there is a distribution to jump to


@dataclass(frozen=True)
class Chains:
    """History of the ensembles, with the state from which sampling can continue.

    Attributes:
        z: Kept coordinates, the starts first, shape (ensembles, steps, walkers, d).
        log_density: Log density at `z`, shape (ensembles, steps, walkers).
        accepted: Fraction of proposals accepted so far; 0 before the first, shape (ensembles,) [-].
        thin: Sampler moves for each kept step.
        random_keys: State of each ensemble's Mersenne Twister, shape (ensembles, 624).
        random_positions: Position in that state, shape (ensembles,).
    """

    z: Array
    log_density: Array
    accepted: Array
    thin: int
    random_keys: np.ndarray
    random_positions: np.ndarray

    @property
    def n_steps(self) -> int:
        """Number of kept steps, the start included."""
        return self.z.shape[1]

    @property
    def moves(self) -> int:
        """Number of sampler moves after the start."""
        return (self.n_steps - 1) * self.thin

    def thinned(self) -> "Chains":
        """Return the chains with every second kept step; the start and, if even, the end stay."""
        z, log_density = self.z[:, ::2], self.log_density[:, ::2]
        return replace(self, z=z, log_density=log_density, thin=2 * self.thin)


def walker_count(d: int) -> int:
    """Return the number of walkers for d dimensions: 3 d rounded up to even, at least 32."""
    return max(32, 2 * ((3 * d + 1) // 2))


def start_chains(
    log_density: Callable[[Array], Array],
    mixture: StudentMixture,
    *,
    ensembles: int,
    rng: np.random.Generator,
    thin: int = 1,
) -> Chains:
    """Draw every walker's start from a mixture near the posterior, inside its support.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        mixture: The mixture.
        ensembles: Number of independent ensembles.
        rng: Source of randomness, of the starts and of each ensemble's seed.
        thin: Sampler moves for each kept step.

    Returns:
        Chains of one step, the starts.

    Raises:
        FitError: Fewer than one in eight draws lies inside the support.
    """
    d = mixture.centres.shape[1]
    walkers = walker_count(d)
    drawn, _ = mixture.draw(8 * ensembles * walkers, rng=rng)
    heights = np.concatenate([log_density(part) for part in np.array_split(drawn, 8 * ensembles)])
    inside = np.flatnonzero(np.isfinite(heights))[: ensembles * walkers]
    if len(inside) < ensembles * walkers:
        raise FitError(
            f"only {len(inside)} of {len(drawn)} starting points lie inside the support, expected "
            f"{ensembles * walkers}; the law hardly suits these data: try another law"
        )
    states = [
        np.random.MT19937(int(seed)).state["state"] for seed in rng.integers(2**31, size=ensembles)
    ]
    return Chains(
        z=drawn[inside].reshape(ensembles, 1, walkers, d),
        log_density=heights[inside].reshape(ensembles, 1, walkers),
        accepted=np.zeros(ensembles),
        thin=thin,
        random_keys=np.stack([state["key"] for state in states]),
        random_positions=np.array([state["pos"] for state in states]),
    )


def advance(
    log_density: Callable[[Array], Array],
    chains: Chains,
    *,
    steps: int,
    jumps: StudentMixture | None = None,
    threads: int = 2,
) -> Chains:
    """Continue sampling every ensemble from its last kept step, the ensembles shared among threads.

    The random numbers continue from the state in the chains: the result does not depend on the
    number of threads or of calls.

    Args:
        log_density: Log density of coordinates (w, d), never NaN; numpy and numba release the GIL
            in it.
        chains: Chains so far.
        steps: Number of kept steps to add, each of `chains.thin` moves.
        jumps: Distribution near the posterior that proposes the share `JUMPS` of the moves, so that
            walkers also jump between modes; None for no such moves.
        threads: Number of ensembles that are sampled at once.

    Returns:
        The chains with the steps added.

    Raises:
        DomainError: The number of steps is below one.
    """
    if steps < 1:
        raise DomainError(f"steps is {steps}; expected 1 or more")

    def walk(ensemble: int) -> EnsembleSampler:
        """Sample one ensemble, by moves of its own."""
        moves = _moves(jumps)
        return _walk(log_density, chains, moves, ensemble=ensemble, steps=steps)

    with ThreadPoolExecutor(threads) as pool:
        walked = list(pool.map(walk, range(len(chains.z))))
    states: list[Any] = [sampler.random_state for sampler in walked]
    old = chains.n_steps - 1
    accepted = np.array([sampler.acceptance_fraction.mean() for sampler in walked])
    return Chains(
        z=np.concatenate([chains.z, np.stack([_kept(s.get_chain()) for s in walked])], axis=1),
        log_density=np.concatenate(
            [chains.log_density, np.stack([_kept(s.get_log_prob()) for s in walked])], axis=1
        ),
        accepted=(old * chains.accepted + steps * accepted) / (old + steps),
        thin=chains.thin,
        random_keys=np.stack([state[1] for state in states]),
        random_positions=np.array([state[2] for state in states]),
    )


def _moves(jumps: StudentMixture | None) -> list[tuple[Any, float]]:
    """Return the moves of an ensemble with their shares; they have state, and serve one only."""
    rest = 1.0 if jumps is None else 1 - JUMPS
    moves: list[tuple[Any, float]] = [(move(), rest * share) for move, share in MOVES]
    if jumps is not None:
        moves.append((MHMove(_jump_to(jumps)), JUMPS))
    return moves


def _walk(
    log_density: Callable[[Array], Array],
    chains: Chains,
    moves: list[tuple[Any, float]],
    *,
    ensemble: int,
    steps: int,
) -> EnsembleSampler:
    """Sample one ensemble for a number of kept steps from its last state; return its sampler."""
    _, _, walkers, d = chains.z.shape
    sampler = EnsembleSampler(walkers, d, log_density, moves=moves, vectorize=True)
    state = State(
        chains.z[ensemble, -1],
        log_prob=chains.log_density[ensemble, -1],
        random_state=(
            "MT19937", chains.random_keys[ensemble], int(chains.random_positions[ensemble]), 0, 0.0,
        ),
    )  # fmt: skip
    sampler.run_mcmc(
        state, steps, thin_by=chains.thin, skip_initial_state_check=True, store=True, progress=False
    )
    return sampler


def _jump_to(
    proposal: StudentMixture,
) -> Callable[[Array, np.random.RandomState], tuple[Array, Array]]:
    """Return a proposal function for emcee: draws of the mixture, independent of the walkers.

    It returns the proposed coordinates and the logarithm of the Hastings factor.
    """

    def propose(z: Array, rng: np.random.RandomState) -> tuple[Array, Array]:
        """Draw as many points as z (w, d) has; return them and the log Hastings factors (w,)."""
        # A generator of its own: RandomState hides half a pair of normals from its state array.
        drawn, _ = proposal.draw(len(z), rng=np.random.default_rng(rng.randint(2**31)))
        return drawn, proposal.log_pdf(z) - proposal.log_pdf(drawn)

    return propose


def _kept(stored: Array | None) -> Array:
    """Return what the sampler stored; raise `FitError` if that is nothing."""
    if stored is None:
        raise FitError("the sampler stored no steps; expected all of them")
    return stored


def autocorrelation_times(z: Array) -> Array:
    """Estimate each coordinate's integrated autocorrelation time, the largest over the ensembles.

    Args:
        z: Coordinates, shape (ensembles, steps, walkers, d).

    Returns:
        Time in kept steps, shape (d,).
    """
    times = [np.atleast_1d(integrated_time(chain, quiet=True, tol=0)) for chain in z]
    return np.max(times, axis=0)
