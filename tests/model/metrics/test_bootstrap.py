# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import InsufficientData
from model.metrics.bootstrap import bootstrap_mean


def test_the_interval_of_many_runs_is_that_of_the_mean():
    rng = np.random.default_rng(1)
    values = rng.normal(2.0, 0.5, 400)
    mean, low, high = bootstrap_mean(values, rng=rng)
    assert mean == pytest.approx(values.mean())
    half = 1.645 * values.std() / np.sqrt(len(values))
    assert (low, high) == pytest.approx((mean - half, mean + half), abs=0.2 * half)


def test_equal_runs_have_no_spread():
    assert bootstrap_mean(np.full(3, 0.7), rng=np.random.default_rng(1)) == pytest.approx(
        (0.7,) * 3
    )


def test_one_run_has_no_interval():
    with pytest.raises(InsufficientData, match="1 run"):
        bootstrap_mean(np.array([1.0]), rng=np.random.default_rng(1))
