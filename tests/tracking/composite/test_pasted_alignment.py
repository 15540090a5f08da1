# SPDX-License-Identifier: MIT
"""Pasted exposures are aligned by what is visible of them."""

import numpy as np
import pytest

from support.drawn_board import composite, likeness
from tracking.composite.chain import steady_chain
from tracking.composite.pasted_alignment import PastedReading


@pytest.mark.parametrize(
    "how", [{"lights": np.linspace(1.5, 1.0, 5)}, {"around_px": 22}], ids=["light", "floor"]
)
def test_pasted_exposures_are_found_in_light_that_changes_and_cut_out_with_floor(how):
    step = np.array([0.15, 0.0, 0.08])
    walk = steady_chain(np.array([-0.3, -0.1, 0.1]), step, 0.0, 4, 0)
    picture = likeness(composite(walk, "pasted", **how), walk[-1], reach=0.45)
    reading = PastedReading(picture)
    found = reading.align(reading.find())
    poses = np.array([each.alignment.pose.planar for each in found])[::-1]
    assert len(poses) == len(walk)
    assert np.abs(poses[:, :2] - walk[:, :2]).max() < 3e-3
