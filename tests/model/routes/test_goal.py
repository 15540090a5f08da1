# SPDX-License-Identifier: MIT
"""A goal says by how much a pose misses it."""

import numpy as np
import pytest

from model.routes.goal import ARM, Goal


def test_only_a_heading_that_is_asked_for_is_missed():
    assert Goal(1.0, 2.0).missed((1.0, 2.1, 0.7)) == pytest.approx([0.0, 0.1])
    off = Goal(1.0, 2.0, 0.5).missed((1.0, 2.1, 0.7))
    assert off == pytest.approx([0.0, 0.1, 0.2 * ARM])


@pytest.mark.parametrize("turns", [-2, -1, 0, 1, 3])
def test_whole_turns_do_not_count(turns):
    off = Goal(0.0, 0.0, 3.1).missed((0.0, 0.0, -3.1 + 2 * np.pi * turns))
    assert off[2] == pytest.approx(ARM * (2 * np.pi - 6.2))
