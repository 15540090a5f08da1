# SPDX-License-Identifier: MIT
"""Exposures of a robot without a marker are found by how one of them looks."""

import numpy as np
import pytest

from support.drawn_board import composite, found_in
from tracking.composite.steps import steady_chain
from tracking.errors import CompositeError


@pytest.mark.parametrize(
    "kind", ["pasted", "mean", pytest.param("darkest", marks=pytest.mark.long)]
)
def test_exposures_that_overlap_are_found_in_order_and_none_is_made_up(kind):
    step = np.array([0.11, 0.0, 0.12])
    walk = steady_chain(np.array([-0.22, -0.1, 0.15]), step, 0.0, 4, 0)
    poses = found_in(composite(walk, kind), walk[-1], kind, near=(0.0, 0.0), reach=0.35)
    assert len(poses) == len(walk)
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 5e-3
    assert np.degrees(np.abs(poses[:, 2] - walk[:, 2]).max()) < 2.5


@pytest.mark.parametrize("kind", ["pasted", "mean"])
def test_one_exposure_alone_is_no_composite(kind):
    planar = np.array([0.0, 0.0, 0.3])
    with pytest.raises(CompositeError, match="no second exposure of the robot"):
        found_in(composite(planar[None], "pasted"), planar, kind, near=(0, 0), reach=0.15)


def test_a_known_exposure_cut_by_the_edge_is_refused():
    picture = composite(np.array([[0.0, 0.0, 0.3]]), "pasted")
    with pytest.raises(CompositeError, match="edge"):
        found_in(picture, np.array([0.66, 0.0, 0.0]), "pasted", near=(0.5, 0), reach=0.4)
