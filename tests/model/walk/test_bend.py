# SPDX-License-Identifier: MIT
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from model.walk.bend import bent_states


@given(st.floats(-0.1, 0.1), st.floats(-1.0, 1.0))
def test_bent_states_turn_by_curvature_times_distance_and_are_as_long_as_stretched(
    stretch, curvature
):
    s = np.linspace(0.0, 0.3, 30)
    states = np.column_stack([s, 0 * s, 0.2 + 0 * s])
    (moved,) = bent_states(
        states[None], distance=np.array([stretch]), curvature=np.array([curvature])
    )
    np.testing.assert_allclose(moved[:, 2], 0.2 + curvature * s, atol=1e-12)
    length = np.hypot(*np.diff(moved[:, :2], axis=0).T).sum()
    np.testing.assert_allclose(length, 0.3 * (1 + stretch))
