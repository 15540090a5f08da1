# SPDX-License-Identifier: MIT
"""Weighted draws in place of a sampler's: same posterior, diagnostics of their own."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.drawing.weighted import WeightedDraws
from model.bayes.preview import preview, weighted_posterior
from support.short_calibration import short_calibration


def rng():
    return np.random.default_rng(7)


@pytest.fixture(scope="module")
def posterior():
    return short_calibration().posterior


@pytest.fixture(scope="module")
def weighted(posterior):
    """Return draws about the first coordinate of which weights move by half a deviation."""
    z = 0.2 * np.random.default_rng(5).standard_normal((20_000, len(posterior.free)))
    centre = short_calibration().fit.laplace.mode
    weights = np.exp(0.5 * z[:, 0] / 0.2)
    return WeightedDraws(centre + z, weights / weights.sum(), 0.1, np.arange(20_000.0))


def test_parts_are_resampled_by_their_weights(posterior, weighted):
    draws, found = weighted_posterior(posterior, weighted, parts=4, n=1000, rng=rng())
    moved = (draws.z - short_calibration().fit.laplace.mode) / 0.2
    assert moved[..., 0].mean() == pytest.approx(0.5, abs=0.08)
    assert abs(moved[..., 1].mean()) < 0.08
    assert found.converged
    assert found.pareto_k == 0.1
    np.testing.assert_array_equal(draws.values[2], posterior.values(draws.z[2]))
    index = draws.log_density.astype(int)
    np.testing.assert_array_equal(weighted.z[index], draws.z)
    assert [part.min() // 5000 for part in index] == [part.max() // 5000 for part in index]
    assert len({part.min() // 5000 for part in index}) == 4  # no draw is in two parts


def test_the_first_answer_is_of_the_laws_parameters_and_warns_of_its_weights(posterior, weighted):
    found = preview(posterior, weighted, rng=rng())
    assert [e.parameter for e in found.estimates] == list(posterior.law.parameters)
    assert found.effective_size == pytest.approx(20_000 * np.exp(-0.25), rel=0.05)
    assert found.reliable
    assert not preview(posterior, replace(weighted, pareto_k=0.7), rng=rng()).reliable
