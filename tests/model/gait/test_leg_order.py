# SPDX-License-Identifier: MIT
"""An order of legs in which no robot walks is found, with one in which it does."""

from itertools import permutations

import numpy as np
import pytest

from model.gait.leg_motion import leg_motion
from model.gait.leg_order import ORDERS, OrderFault, order_fault, regularity
from support.leg_motions import T, tripod, wave


def fault(theta: np.ndarray) -> OrderFault | None:
    motion = leg_motion(theta)
    assert motion is not None
    return order_fault(motion, motion.direction)


def listed(theta: np.ndarray, order: tuple[int, ...]) -> np.ndarray:
    """Return the columns of a log that lists legs in this order."""
    return theta[:, np.array(order) - 1]


def test_sides_in_antiphase_are_no_gait_and_the_order_by_sides_is_named():
    found = fault(listed(tripod().angles(T), (1, 3, 5, 2, 4, 6)))
    assert found is not None
    assert found.groups == ((1, 3, 5), (2, 4, 6))
    assert (1, 3, 5, 2, 4, 6) in found.orders


@pytest.mark.parametrize("order", ORDERS)
def test_usual_orders_are_found_and_are_among_the_repairs(order):
    for theta in (tripod().angles(T), tripod(1.4).angles(T), wave(2 / 3, 1 / 3, 1 / 3)):
        found = fault(listed(theta, order))
        assert found is not None
        assert order in found.orders


def test_a_turn_tells_orders_apart_that_a_straight_walk_does_not():
    straight, turn = (fault(listed(tripod(s).angles(T), (1, 2, 4, 6, 5, 3))) for s in (1.0, 1.4))
    assert straight is not None
    assert turn is not None
    assert set(turn.orders) < set(straight.orders)


def test_nine_of_ten_wrong_orders_of_a_tripod_are_found():
    """The others exchange legs of a tripod, or the two tripods: the same steps."""
    theta = tripod().angles(T)
    found = [fault(listed(theta, order)) is not None for order in permutations(range(1, 7))]
    assert sum(found) == 648
    assert not found[0]


def test_regularity_is_one_for_any_two_lags_and_free_of_a_common_phase():
    rng = np.random.default_rng(2)
    for _ in range(20):
        row, side, start = rng.integers(48) / 48, rng.uniform(), rng.uniform()
        phase = (start + row * (np.arange(6) // 2) + side * (np.arange(6) % 2)) % 1
        assert regularity(phase) == pytest.approx(1.0)
        assert regularity(rng.permutation(phase) + rng.uniform()) <= 1.0 + 1e-12


def test_legs_without_a_common_rhythm_are_not_judged():
    rates = np.array([4.0, 4.3, 4.6, 4.9, 5.2, 5.5])
    theta = np.column_stack(
        [tripod().angles(rate / 4 * T)[:, leg] for leg, rate in enumerate(rates)]
    )
    assert fault(listed(theta, (1, 3, 5, 2, 4, 6))) is None
