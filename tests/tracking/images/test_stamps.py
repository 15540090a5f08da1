# SPDX-License-Identifier: MIT
"""Stamps in whole seconds give the times of a regular timer."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tracking.images import fit_interval


@given(
    start=st.floats(0, 10), interval=st.floats(2.2, 8.0), count=st.integers(12, 60),
    dropped=st.integers(2, 9),
)  # fmt: skip
@example(start=0.0067150, interval=2.9998184, count=48, dropped=7)  # 0.66 s off: a triangle
def test_whole_seconds_and_a_regular_interval_never_lose_the_second(
    start, interval, count, dropped
):
    numbers = np.delete(np.arange(count), dropped)
    truth = start + interval * numbers
    fit = fit_interval(np.floor(truth))
    assert fit is not None
    assert fit.interval == pytest.approx(interval, abs=1.5 / count)
    # The stamps leave each time a second at most, and the centroid of a convex polygon lies within
    # two thirds of its width from either edge.
    assert np.abs(fit.t - truth).max() <= 2 / 3 + 1e-9
    assert fit.sd.max() < 0.3


def test_fitted_times_are_sharper_than_stamps_and_cover():
    rng, z, sds = np.random.default_rng(0), [], []
    for _ in range(200):
        truth = rng.uniform(0, 1) + rng.uniform(1.8, 2.6) * np.arange(40)
        fit = fit_interval(np.floor(truth))
        z.append((fit.t - truth) / fit.sd)
        sds.append(fit.sd)
    assert np.mean(sds) < 0.05
    assert 0.8 < np.sqrt(np.mean(np.square(z))) < 1.2


def test_missing_exposures_are_counted():
    truth = 0.3 + 2.37 * np.delete(np.arange(30), [7, 8])
    fit = fit_interval(np.floor(truth))
    assert fit.missing == (7, 8)


def test_an_irregular_hand_gives_no_interval():
    stamps = np.cumsum(np.random.default_rng(1).integers(2, 30, 25))
    assert fit_interval(stamps) is None


def test_no_stamps_give_no_interval():
    assert fit_interval([]) is None
