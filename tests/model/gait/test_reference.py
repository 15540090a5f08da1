# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait import SampledReference

T = np.array([0.5, 1.0, 2.0, 2.5])
THETA = np.outer([0.0, 1.0, 1.5, 4.0], np.arange(1.0, 7.0))
LOG = SampledReference(T, THETA)


@given(st.lists(st.floats(0.0, 3.0), min_size=1))
def test_angles_are_straight_lines_between_samples_in_any_order_of_times(t):
    lines = np.column_stack([np.interp(t, T, column) for column in THETA.T])
    np.testing.assert_allclose(LOG.angles(t), lines, atol=1e-12)


@given(st.floats(0.5, 2.4))
def test_speeds_are_the_slopes_of_the_angles(t):
    h = 1e-7
    slope = (LOG.angles(t + h) - LOG.angles(t)) / h
    if not np.any((t < T) & (t + h > T)):
        np.testing.assert_allclose(LOG.speeds(t), slope, atol=1e-5)


def test_at_a_sample_the_speed_is_that_of_the_line_ahead():
    np.testing.assert_allclose(LOG.speeds(1.0)[0], 0.5 * np.arange(1, 7))


@pytest.mark.parametrize("t", [-3.0, 0.49, 2.5, 9.0])
def test_legs_stand_still_outside_the_samples(t):
    np.testing.assert_array_equal(LOG.speeds(t), np.zeros((1, 6)))
    np.testing.assert_array_equal(LOG.angles(t)[0], THETA[0 if t < 1 else -1])


@pytest.mark.parametrize("bad", [1.0, 0.9, np.nan])
def test_times_that_do_not_increase_are_refused_with_the_sample(bad):
    t = T.copy()
    t[2] = bad
    with pytest.raises(DomainError, match=r"time goes from 1 to .* s after sample 2 .*; expect"):
        SampledReference(t, THETA)


@pytest.mark.parametrize(
    ("t", "theta"), [(T, THETA[:, :5]), (T, THETA[:3]), (T[:1], THETA[:1]), (T[:, None], THETA)]
)
def test_samples_of_other_shapes_are_refused(t, theta):
    with pytest.raises(DomainError, match=r"expected \(m,\) and \(m, 6\) with m at least 2"):
        SampledReference(t, theta)
