# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.poses import compose
from model.walk.stride import MOST_STRIDES, repeated_strides, strides_until_alike

N = 8
ARC = np.column_stack([np.linspace(0, 0.3, N + 1), np.zeros(N + 1), np.linspace(0, 0.1, N + 1)])
TILT = 0.01 * np.sin(np.linspace(0, 2 * np.pi, N + 1))[:, None] * [1.0, 2.0]


def strides(first_scale):
    """Yield arcs that start where the one before ends; the first is `first_scale` times as long."""
    start, scale = np.zeros(3), first_scale
    while True:
        states = compose(start, ARC * [scale, scale, 1.0])
        yield np.hstack([states, TILT])
        start, scale = states[-1], 1.0


def test_strides_end_with_the_first_that_is_like_the_one_before():
    assert len(strides_until_alike(strides(0.8), least_length=0.05)) == 3
    assert len(strides_until_alike(strides(1.0), least_length=0.05)) == 2


def test_a_walk_that_never_settles_ends_after_the_most_strides():
    rng = np.random.default_rng(1)
    unlike = (rng.standard_normal((N + 1, 5)) for _ in range(100))
    assert len(strides_until_alike(unlike, least_length=0.05)) == MOST_STRIDES


@pytest.mark.parametrize("steps", [3, N, 2 * N, 5 * N + 3])
def test_repeated_strides_are_the_walk_that_goes_on(steps):
    walked = strides_until_alike(strides(1.0), least_length=0.05)
    found = repeated_strides(walked, steps)
    t = np.arange(steps + 1)
    assert found.shape == (steps + 1, 5)
    np.testing.assert_allclose(found[:, 2], 0.1 * t / N, atol=1e-12)
    np.testing.assert_allclose(found[:, 3:], TILT[t % N], atol=1e-12)
    moves = np.linalg.norm(np.diff(found[:, :2], axis=0), axis=1)
    np.testing.assert_allclose(moves, 0.3 / N, atol=1e-12)
