# SPDX-License-Identifier: MIT
"""Suspect a wrong order of measured legs, from the groups in which they step.

The phases of walking legs are a sum of one lag from row to row and one from side to side, as in
the symmetric gaits of Hildebrand (tripod, tetrapod, waves); the legs of a side do not swing all at
once while the other side stands; and the legs of one side turn the same way. An order that breaks
this, where another order of the same legs does not, is probably wrong.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, permutations
from typing import Final

import numpy as np

from model.arrays import Array
from model.gait.leg_motion import CLEAR, LegMotion
from model.robot import N_LEGS

ORDERS: Final[dict[tuple[int, ...], str]] = {
    (1, 3, 5, 2, 4, 6): "the left side from front to rear, then the right side",
    (2, 4, 6, 1, 3, 5): "the right side from front to rear, then the left side",
    (1, 2, 4, 6, 5, 3): "clockwise from front left",
    (1, 3, 5, 6, 4, 2): "counter-clockwise from front left",
    (2, 4, 6, 5, 3, 1): "clockwise from front right",
    (2, 1, 3, 5, 6, 4): "counter-clockwise from front right",
    (5, 3, 1, 6, 4, 2): "the left side from rear to front, then the right side",
    (6, 4, 2, 5, 3, 1): "the right side from rear to front, then the left side",
}
"""Orders in which robots' software lists legs, seen from above: the leg of each place."""
SIDE: Final = np.arange(N_LEGS) % 2
"""Side of each leg, 0 left and 1 right."""
# Least `regularity` of an order that is not suspected, and of one that is suggested instead.
_IRREGULAR, _REGULAR = 0.91, 0.96
_TURN: Final = 0.5  # least `_sides_differ` in a turn
_TOGETHER: Final = 0.12  # largest difference of phase of legs that step together [cycles]
_CONSTANT: Final = 0.8  # least coherence of a gait
_GRID: Final = np.arange(48) / 48  # lags from row to row that `regularity` tries [cycles]


@dataclass(frozen=True)
class OrderFault:
    """Legs that step together as no walking robot's do.

    Attributes:
        groups: Numbers of the legs that step together.
        orders: Orders that would be consistent, the usual ones first: the leg of each place.
    """

    groups: tuple[tuple[int, ...], ...]
    orders: tuple[tuple[int, ...], ...]


def order_fault(motion: LegMotion, direction: Array) -> OrderFault | None:
    """Return what is suspected of the order of legs; None if it, or no other order, is plausible.

    None also without a steady gait of all six legs, with known phases and middles of stance.

    Orders that differ by exchanging left and right, or front and rear, look alike.

    Args:
        motion: How the legs turned.
        direction: Direction of each leg once wrong signs are repaired, 1, -1 or 0, shape (6,).
    """
    together = motion.turning.all() and np.ptp(motion.turns) <= 0.2 * motion.turns.mean() + 0.5
    if not together or motion.coherence < _CONSTANT or (motion.weight < CLEAR).any():
        return None
    if _plausible(motion.phase, direction, _IRREGULAR):
        return None
    orders = _consistent_orders(motion, direction)
    return OrderFault(_groups(motion.phase), orders) if orders else None


def regularity(phase: Array) -> float:
    r"""Return how well phases agree with one lag from row to row and one from side to side.

    .. math::
        \max_{a, b} \Bigl|\tfrac16 \sum_j e^{2\pi i (\varphi_j - a\,row_j - b\,side_j)}\Bigr|

    Args:
        phase: Phase of each leg, shape (6,) [cycles].

    Returns:
        1 for a symmetric gait such as a tripod, else less [-].

    >>> round(regularity(np.array([0, 0.5, 0.5, 0, 0, 0.5])), 6)
    1.0
    >>> round(regularity(np.array([0, 0.5, 0, 0.5, 0.5, 0])), 3)
    0.745
    """
    turned = np.exp(2j * np.pi * phase)
    rows = np.exp(-2j * np.pi * np.outer(_GRID, np.arange(N_LEGS // 2)))
    # The lag of sides turns the sum over one side onto that over the other.
    by_side = np.abs(rows @ np.column_stack([turned[side == SIDE] for side in (0, 1)]))
    return float(by_side.sum(axis=1).max()) / N_LEGS


def _consistent_orders(motion: LegMotion, direction: Array) -> tuple[tuple[int, ...], ...]:
    """Return the orders of `ORDERS` that make the gait plausible, else one that moves few legs.

    Where the sweeps of the two sides differ clearly, as in a turn, only those orders are returned
    whose `_sides_differ` is at least half the largest. Empty if no order is plausible.
    """

    def consistent(order: tuple[int, ...]) -> bool:
        """Return whether the gait is plausible, with `_REGULAR`, if legs are in this order."""
        phase, turned = (_by_leg(order, values) for values in (motion.phase, direction))
        return _plausible(phase, turned, _REGULAR)

    found = [order for order in ORDERS if consistent(order)]
    if not found:
        return tuple(next(([order] for order in _by_moved_legs() if consistent(order)), []))
    sides = [_sides_differ(_by_leg(order, motion.weight)) for order in found]
    least = 0.5 * max(sides) if max(sides) >= _TURN else 0.0
    return tuple(order for order, each in zip(found, sides, strict=True) if each >= least)


def _by_moved_legs() -> Iterator[tuple[int, ...]]:
    """Yield orders of the six legs: first those that exchange two, then all permutations."""
    legs = range(1, N_LEGS + 1)
    for first, second in combinations(legs, 2):
        swap = {first: second, second: first}
        yield tuple(swap.get(leg, leg) for leg in legs)
    yield from permutations(legs)


def _by_leg(order: tuple[int, ...], values: Array) -> Array:
    """Sort values, one for each place of an order (the number of its leg), by leg, shape (6,)."""
    return values[np.argsort(order)]


def _sides_differ(weight: Array) -> float:
    """Return how clearly the sweeps of the two sides differ, as they do in a turn, from 0 to 1.

    It is the variance of `LegMotion.weight` between the sides over its variance among all legs.
    """
    between = (weight[SIDE == 0].mean() - weight[SIDE == 1].mean()) ** 2 / 4
    return float(between / max(weight.var(), 1e-4))


def _plausible(phase: Array, direction: Array, least: float) -> bool:
    """Return whether phases and directions by leg are those of a walking robot.

    The legs of a side must not turn opposite ways, nor all step at once while the other side
    stands, and `regularity` must be `least` or more.
    """
    for side in (0, 1):
        turned = direction[side == SIDE]
        if turned.max() > 0 > turned.min():
            return False
    return not _sides_alternate(phase) and regularity(phase) >= least


def _sides_alternate(phase: Array) -> bool:
    """Return whether the legs of each side step together, at another time than the other side's.

    Together is within about `_TOGETHER` of their mean phase, another time by more than that.
    """
    turned = np.exp(2j * np.pi * phase)
    means = [turned[side == SIDE].mean() for side in (0, 1)]
    apart = abs(np.angle(means[0] * np.conj(means[1]))) / (2 * np.pi)
    return min(map(abs, means)) > np.cos(2 * np.pi * _TOGETHER) and bool(apart > _TOGETHER)


def _groups(phase: Array) -> tuple[tuple[int, ...], ...]:
    """Group the numbers of legs whose phase is within `_TOGETHER` of their group's first leg."""
    groups: list[list[int]] = []
    for leg, at in enumerate(phase):
        for group in groups:
            if abs((at - phase[group[0]] + 0.5) % 1 - 0.5) <= _TOGETHER:
                group.append(leg)
                break
        else:
            groups.append([leg])
    return tuple(tuple(leg + 1 for leg in group) for group in groups)
