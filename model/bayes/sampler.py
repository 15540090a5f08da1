# SPDX-License-Identifier: MIT
"""Independent emcee ensembles that advance side by side; the only importer of emcee.

R-hat needs chains that share nothing. The walkers of one ensemble propose along each other's
differences, so an ensemble is one chain; several are run, each with its own seed and start.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from emcee import EnsembleSampler, State
from emcee.autocorr import integrated_time
from emcee.moves import DEMove, KDEMove

from model.bayes.laplace import Laplace
from model.errors import DomainError, FitError
from model.slip.law import Array

MOVES = ((DEMove, 1.0),)
"""A quarter of the stretch move's autocorrelation time in 12 dimensions. No snooker move: emcee's,
up to 3.1.6, misses half the exponent of its acceptance ratio and narrows every spread by 7 %."""

JUMPS = ((DEMove, 0.6), (KDEMove, 0.4))
"""For large ensembles: a density estimated from the other walkers proposes jumps between modes."""

CROWD = 24  # walkers a dimension from which such an estimate is any good

START_WIDTH = 1.2  # of the Laplace approximation's: R-hat wants starts at least as wide as the end


@dataclass(frozen=True)
class Chains:
    """What the ensembles have walked so far, and all that is needed to walk on.

    Attributes:
        z: Kept coordinates, shape (ensembles, steps, walkers, d).
        log_density: Their log density, shape (ensembles, steps, walkers).
        accepted: Fraction of proposals accepted, shape (ensembles,).
        thin: Sampler moves for each kept step.
        random_keys: State of each ensemble's random generator, shape (ensembles, 624).
        random_positions: Place in that state, shape (ensembles,).
    """

    z: Array
    log_density: Array
    accepted: Array
    thin: int
    random_keys: np.ndarray
    random_positions: np.ndarray

    @property
    def n_steps(self) -> int:
        """Count the kept steps."""
        return self.z.shape[1]


def walker_count(d: int, *, crowd: bool = False) -> int:
    """Choose the number of walkers for d dimensions: even, at least 32.

    Args:
        d: Dimensions.
        crowd: Take 24 a dimension, in place of three, and jump between modes: where data are few,
            modes are many, and a density that is quick to evaluate pays for it.
    """
    return CROWD * d + CROWD * d % 2 if crowd else max(32, 2 * ((3 * d + 1) // 2))


def start_chains(
    log_density: Callable[[Array], Array],
    laplace: Laplace,
    *,
    ensembles: int,
    thin: int,
    rng: np.random.Generator,
    crowd: bool = False,
) -> Chains:
    """Draw every walker's start from a widened Laplace approximation.

    Args:
        log_density: Log density of coordinates (w, d).
        laplace: The approximation at the posterior's mode.
        ensembles: How many independent ensembles.
        thin: Sampler moves for each kept step.
        rng: Source of randomness, of the starts and of each ensemble's seed.
        crowd: Many walkers that jump between modes; see `walker_count`.

    Returns:
        Chains of one step.

    Raises:
        FitError: Too few of the draws lie inside the support.
    """
    d = len(laplace.mode)
    walkers = walker_count(d, crowd=crowd)
    drawn = rng.multivariate_normal(
        laplace.mode, START_WIDTH**2 * laplace.covariance, size=8 * ensembles * walkers
    )
    heights = np.concatenate([log_density(part) for part in np.array_split(drawn, 8 * ensembles)])
    inside = np.flatnonzero(np.isfinite(heights))[: ensembles * walkers]
    if len(inside) < ensembles * walkers:
        raise FitError(
            f"only {len(inside)} of {len(drawn)} starting points lie inside the support; the "
            "posterior's mode sits on its edge, so the law hardly suits these data"
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
    log_density: Callable[[Array], Array], chains: Chains, *, steps: int, threads: int = 2
) -> Chains:
    """Walk every ensemble on, the ensembles shared among threads.

    The result depends on the chains alone: not on threads, nor on how many calls the walk is cut
    into.

    Args:
        log_density: Log density of coordinates (w, d); numpy and numba release the GIL in it.
        chains: Where the ensembles stand.
        steps: Kept steps to add.
        threads: Ensembles to advance at once.

    Returns:
        The longer chains.

    Raises:
        DomainError: No step is asked for.
    """
    if steps < 1:
        raise DomainError(f"steps is {steps}; expected 1 or more")

    def walk(ensemble: int) -> EnsembleSampler:
        return _walk(log_density, chains, ensemble=ensemble, steps=steps)

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


def _walk(
    log_density: Callable[[Array], Array], chains: Chains, *, ensemble: int, steps: int
) -> EnsembleSampler:
    _, _, walkers, d = chains.z.shape
    kinds = JUMPS if walkers >= CROWD * d else MOVES
    moves = [(move(), share) for move, share in kinds]  # a move has state: one for each ensemble
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


def _kept(stored: Array | None) -> Array:
    if stored is None:
        raise FitError("the sampler kept no step although it was asked to store them")
    return stored


def autocorrelation_times(z: Array) -> Array:
    """Estimate each coordinate's integrated autocorrelation time, the longest of the ensembles.

    Args:
        z: Coordinates, shape (ensembles, steps, walkers, d).

    Returns:
        Time in kept steps, shape (d,).
    """
    times = [np.atleast_1d(integrated_time(chain, quiet=True, tol=0)) for chain in z]
    return np.max(times, axis=0)
