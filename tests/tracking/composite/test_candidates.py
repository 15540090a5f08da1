# SPDX-License-Identifier: MIT
"""Places where an exposure may be lie along a walk."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_board import (
    STEPS,
)
from tracking.composite.candidates import headed
from tracking.composite.chain import (
    stepped,
)


@given(step=STEPS, turned=st.integers(0, 3))
def test_a_square_robot_is_headed_along_the_arc_that_leads_to_it(step, turned):
    after = stepped(np.zeros(3), step * [1, 0, 1])
    seen = after + np.array([0, 0, turned * np.pi / 2])
    found = headed(seen, np.zeros((1, 3)), square=True)
    assert np.cos(found[2] - after[2]) == pytest.approx(1.0)
