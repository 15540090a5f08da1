# SPDX-License-Identifier: MIT
"""Exposures of a mean are aligned with each other."""

import numpy as np
import pytest

from support.drawn_board import composite, known_at, likeness
from tracking.body import Alignment
from tracking.composite.floor_pattern import FloorPattern
from tracking.composite.mean_alignment import MeanAlignment, floor_pattern
from tracking.composite.steps import steady_chain, stepped


@pytest.mark.parametrize("count", [2, 3])
def test_places_of_few_exposures_in_a_mean_do_not_depend_on_where_they_were_first_seen(count):
    walk = np.array([[-0.3, -0.1, 0.2], [0.0, 0.0, 0.3], [0.3, 0.1, 0.4]])[:count]
    picture = likeness(composite(walk, "mean"), walk[0], reach=0.45)
    started = walk + np.outer(np.arange(count) > 0, [0.004, -0.002, 0.02])
    pattern = floor_pattern(picture, picture.pixels.astype(np.float32), walk)
    flat = pattern.flat(picture.pixels.astype(np.float32))
    found = MeanAlignment(picture, [flat] * count, started, pattern).exposures()
    poses = np.array([each.alignment.pose.planar for each in found])
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 1e-3
    assert np.degrees(np.abs(poses[:, 2] - walk[:, 2]).max()) < 0.5


def test_exposures_aligned_with_each_other_are_moved_to_where_one_is_known_to_be():
    walk = steady_chain(np.array([0.1, 0.0, 0.3]), np.array([0.2, 0.01, 0.1]), 0.0, 3, 0)
    off = np.array([0.004, -0.003, 0.02])
    picture = likeness(np.zeros((400, 640, 3), np.uint8), walk[0], reach=0.4)
    found = [Alignment(known_at(stepped(planar, off)), 0.9, 0.0) for planar in walk]
    nothing = FloorPattern(5.0, np.zeros((3, 7, 7), np.float32))
    moved = MeanAlignment(picture, [], walk, nothing).anchored([*found, None])
    assert moved[-1] is None
    planar = [each.pose.planar for each in moved[:-1]]
    np.testing.assert_allclose(planar, walk, atol=1e-9)
