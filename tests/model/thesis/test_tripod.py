# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.thesis.tripod import switch_by_listing, switch_by_table

FIRST, SECOND = (0, 3, 4), (1, 2, 5)
HEIGHTS = st.lists(st.floats(0.0, 0.07), min_size=6, max_size=6).map(np.array)


def down(legs):
    return np.isin(np.arange(6), legs)


def legs(contact):
    return tuple(int(i) for i in np.flatnonzero(contact))


def heights(**by_leg):
    """Hip heights of 0.05 m but for those given, as leg1=0.06."""
    return np.array([by_leg.get(f"leg{i}", 0.05) for i in range(1, 7)])


@given(HEIGHTS, st.sampled_from([0, 1]), st.sampled_from([FIRST, SECOND]))
def test_the_listing_always_stands_on_a_whole_tripod(height, inner, start):
    contact = down(start)
    switch_by_listing(height, contact, inner)
    assert legs(contact) in (FIRST, SECOND)


@given(HEIGHTS)
def test_table_3_1_leaves_each_side_on_its_higher_hips(height):
    contact = down(FIRST)
    switch_by_table(height, contact)
    for side in (0, 1):
        pair, middle = 0.5 * (height[side] + height[side + 4]), height[side + 2]
        assert contact[side] == contact[side + 4] != contact[side + 2]
        higher = middle if contact[side + 2] else pair
        assert higher >= max(pair, middle) - 1e-12


def test_the_listing_lets_one_inner_leg_decide_where_table_3_1_takes_the_mean():
    height = heights(leg3=0.051, leg1=0.0505, leg5=0.053)
    by_listing, by_table = down(FIRST), down(FIRST)
    assert switch_by_listing(height, by_listing, 0)
    assert not switch_by_table(height, by_table)
    assert (legs(by_listing), legs(by_table)) == (SECOND, FIRST)


def test_the_listing_does_not_look_at_outer_legs():
    height = heights(leg2=0.06, leg6=0.06, leg4=0.01)
    by_listing, by_table = down(FIRST), down(FIRST)
    assert not switch_by_listing(height, by_listing, 0)
    assert switch_by_table(height, by_table)
    assert legs(by_table) == (0, 1, 4, 5)


def test_in_a_right_turn_the_right_legs_decide():
    contact = down(FIRST)
    assert switch_by_listing(heights(leg2=0.06), contact, 1)
    assert legs(contact) == SECOND


@pytest.mark.parametrize("start", [FIRST, SECOND])
def test_equal_heights_change_nothing(start):
    contact = down(start)
    assert not switch_by_listing(heights(leg1=0.05 + 1e-14), contact, 0)
    assert not switch_by_table(heights(leg3=0.05 + 1e-14), contact)
    assert legs(contact) == start
