# SPDX-License-Identifier: MIT
"""Order the exposures of one picture along the walk, by heading and path length."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from tracking.camera.lens import Array

_EXACT_ORDER = 12


def order_exposures(poses: ArrayLike) -> tuple[int, ...]:
    """Order exposures along the walk, by the cheapest chain through all.

    A step from one exposure to the next costs its length, and more the less it follows the mean of
    both headings, as a chord follows an arc. Length alone fails where the path comes near itself.

    Args:
        poses: x, y [m] and yaw [rad] of the exposures, shape (n, 3).

    Returns:
        Numbers of the exposures, first to last.
    """
    places = np.asarray(poses, dtype=float).reshape(-1, 3)
    cost = _step_costs(places)
    if len(places) <= _EXACT_ORDER:
        return _best_chain(cost)
    return _improved_chain(cost)


def _step_costs(places: Array) -> Array:
    """Compute the cost of a step from i to j, shape (n, n) [m]."""
    move = places[None, :, :2] - places[:, None, :2]
    distance = np.hypot(move[..., 0], move[..., 1])
    turn = np.angle(np.exp(1j * (places[None, :, 2] - places[:, None, 2])))
    heading = places[:, None, 2] + turn / 2
    chord = np.arctan2(move[..., 1], move[..., 0])
    along = np.cos(chord - heading)
    # A step sideways costs three times its length, one backwards seven times.
    cost = distance * (1 + 3 * (1 - along) + 2 * (1 - np.cos(turn)))
    np.fill_diagonal(cost, np.inf)
    return cost


def _best_chain(cost: Array) -> tuple[int, ...]:
    """Find the cheapest chain through all, by dynamic programming (Held and Karp 1962)."""
    n = len(cost)
    if n == 0:
        return ()
    total = np.full((1 << n, n), np.inf)
    came = np.zeros((1 << n, n), dtype=int)
    for last in range(n):
        total[1 << last, last] = 0.0
    for done in range(1, 1 << n):
        for after in range(n):
            if done >> after & 1:
                continue
            through = total[done] + cost[:, after]
            best = int(np.argmin(through))
            more = done | 1 << after
            if through[best] < total[more, after]:
                total[more, after], came[more, after] = through[best], best
    done, last = (1 << n) - 1, int(np.argmin(total[-1]))
    chain = [last]
    while done & (done - 1):
        before = int(came[done, last])
        done ^= 1 << last
        chain.append(before)
        last = before
    return tuple(chain[::-1])


def _improved_chain(cost: Array) -> tuple[int, ...]:
    """Find a cheap chain: nearest neighbours from every start, then moves of stretches."""
    n = len(cost)
    chains = [_nearest_chain(cost, start) for start in range(n)]
    chain = min(chains, key=lambda c: _length(cost, c))
    improved = True
    while improved:
        improved = False
        for i in range(n):
            for j in range(i + 1, min(i + 4, n) + 1):
                stretch, rest = chain[i:j], chain[:i] + chain[j:]
                options = [rest[:k] + stretch + rest[k:] for k in range(len(rest) + 1)]
                options.append(chain[:i] + stretch[::-1] + chain[j:])
                best = min(options, key=lambda c: _length(cost, c))
                if _length(cost, best) < _length(cost, chain) - 1e-12:
                    chain, improved = best, True
    return tuple(chain)


def _nearest_chain(cost: Array, start: int) -> list[int]:
    chain, left = [start], set(range(len(cost))) - {start}
    while left:
        last = chain[-1]
        chain.append(min(left, key=lambda k: cost[last, k]))
        left.remove(chain[-1])
    return chain


def _length(cost: Array, chain: Sequence[int]) -> float:
    return float(cost[list(chain[:-1]), list(chain[1:])].sum())
