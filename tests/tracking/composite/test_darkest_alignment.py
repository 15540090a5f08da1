# SPDX-License-Identifier: MIT
"""Of darkest values each exposure is aligned by where it is the darkest."""

import numpy as np
import pytest

from support.drawn_board import composite, likeness
from tracking.composite.darkest_alignment import DarkestReading

WALK = np.array([[-0.2, -0.05, 0.2], [0.1, 0.03, 0.35]])


def test_places_on_a_raster_are_aligned_and_what_is_none_is_dropped():
    picture = likeness(composite(WALK, "darkest"), WALK[0], reach=0.35)
    near = np.array([WALK[0], WALK[1] + [0.004, -0.003, 0.02], [0.1, -0.25, 0.3]])
    found = DarkestReading(picture).align(near)
    poses = np.array([each.alignment.pose.planar for each in found])
    assert len(poses) == 2
    np.testing.assert_allclose(poses[:, :2], WALK[:, :2], atol=1.5e-3)
    np.testing.assert_allclose(poses[:, 2], WALK[:, 2], atol=0.02)
    assert [each.visible for each in found] == pytest.approx([0.9, 0.9], abs=0.1)
