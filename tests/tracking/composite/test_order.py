# SPDX-License-Identifier: MIT
"""Exposures are put in the order of the walk."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.composite import order_exposures


@given(
    turning=st.floats(-0.55, 0.55), step=st.floats(0.1, 0.4), n=st.integers(3, 14),
    seed=st.integers(0, 999),
)  # fmt: skip
def test_an_arc_is_put_in_order_whatever_order_it_came_in(turning, step, n, seed):
    yaw = turning * np.arange(n)
    middle = yaw + turning / 2
    xy = np.cumsum(step * np.column_stack((np.cos(middle), np.sin(middle))), axis=0)
    shuffled = np.random.default_rng(seed).permutation(n)
    order = order_exposures(np.column_stack((xy, yaw))[shuffled])
    # Past a full turn an arc lies on itself and no picture tells the laps apart.
    if abs(turning) * n < 2 * np.pi:
        assert [int(shuffled[k]) for k in order] == list(range(n))


def test_two_exposures_are_ordered_by_their_headings():
    assert order_exposures([[1.0, 0, 0], [0.0, 0, 0]]) == (1, 0)


@pytest.mark.reference
def test_a_walk_of_the_virtual_world_is_ordered(shared):
    lines = Path(shared / "virtual-world/photos/s1.10_A/truth.csv").read_text().splitlines()
    names = lines[0].split(",")
    rows = np.array([line.split(",") for line in lines[1:]], dtype=float)
    poses = rows[:, [names.index(name) for name in ("x", "y", "yaw")]]
    for seed in range(20):
        shuffled = np.random.default_rng(seed).permutation(len(poses))
        order = order_exposures(poses[shuffled])
        assert [int(shuffled[k]) for k in order] == list(range(len(poses)))
