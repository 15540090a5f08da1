# SPDX-License-Identifier: MIT
"""Steps lead there and back, and chains of them are the same from anywhere."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.drawn_board import STEPS
from tracking.composite.chain import steady_chain, step_between, stepped, stepped_back, unsteadiness

POSES = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-3, 3)).map(np.array)


@given(pose=POSES, step=STEPS)
def test_a_step_there_and_back_ends_where_it_began(pose, step):
    np.testing.assert_allclose(step_between(pose, stepped(pose, step)), step, atol=1e-9)
    np.testing.assert_allclose(stepped_back(stepped(pose, step), step), pose, atol=1e-9)


@given(pose=POSES, step=STEPS, more=st.floats(-0.05, 0.05))
def test_a_chain_is_the_same_from_any_of_its_exposures(pose, step, more):
    chain = steady_chain(pose, step, more, 4, 0)
    first = step_between(chain[2], chain[3])
    again = steady_chain(chain[2], first, more, 2, 2)
    np.testing.assert_allclose(again[[4, 3, 0, 1, 2]], chain, atol=1e-9)


def test_steady_steps_are_steady_and_a_slip_is_not():
    walk = steady_chain(np.zeros(3), np.array([0.1, 0.0, 0.1]), 0.0, 6, 0)
    assert unsteadiness(walk) == pytest.approx(0.0, abs=1e-12)
    walk[3, 0] += 0.02
    assert unsteadiness(walk) > 10
