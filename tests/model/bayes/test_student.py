# SPDX-License-Identifier: MIT
"""Student-t noise is a density, becomes Gaussian noise, and is hardly moved by far blocks."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.laplace import find_mode
from model.bayes.likelihood import PredictedForces, filter_runs, predict_blocks
from model.bayes.student import filter_student_runs, normal_scores
from support.dropped_forces import KNOWN, LAW, deviations, posterior_of, simulated


def filtered(residual, tail, starts=(0, 3, 7)):
    n = len(residual)
    rng = np.random.default_rng(1)
    noise, slope = rng.uniform(0.5, 1.5, (2, 1, 7))[..., :n]
    errors = 0.1 * np.ones(n), np.array([0.3, 0.2])
    given = (
        residual[None],
        noise,
        slope,
        *errors,
        np.array(starts),
        np.array([1.2]),
        np.array([0.01]),
        np.array([0.6]),
    )
    tau = np.array([0.8])
    if tail is None:
        return filter_runs(*given, tau)[0]
    return filter_student_runs(*given, tau, tail)[0][0]


def test_with_many_degrees_of_freedom_the_density_is_that_of_gaussian_noise():
    residual = np.random.default_rng(2).normal(size=7)
    np.testing.assert_allclose(filtered(residual, 1e8), filtered(residual, None), rtol=1e-6)


def test_the_density_of_a_run_is_one_of_its_last_block_given_the_others():
    residual = np.random.default_rng(3).normal(size=7)
    last = 60 * np.sinh(np.linspace(-9, 9, 4001)) / np.sinh(9)
    density = [filtered(np.append(residual[:6], x), 3.0)[1] for x in last]
    marginal = np.trapezoid(np.exp(density), last)
    shorter = filtered(residual[:6], 3.0, starts=(0, 3, 6))[1]
    assert np.log(marginal) == pytest.approx(shorter, abs=2e-3)


def test_a_far_block_moves_its_run_no_more_the_farther_it_is():
    def score(size, tail):
        residual = np.zeros(7)
        residual[4] = size
        step = 1e-4
        ahead, behind = (filtered(residual - side * step, tail)[1] for side in (1, -1))
        return abs(ahead - behind) / (2 * step)

    assert score(100.0, 3.0) < score(3.0, 3.0)
    assert score(100.0, None) > 20 * score(3.0, None)


def test_scores_of_many_degrees_of_freedom_are_white_and_normal():
    posterior = posterior_of(simulated(2, 0.0))
    mode = find_mode(posterior.log_density, posterior.coordinates(KNOWN)[None]).mode
    values = posterior.values(mode[None])
    predicted = predict_blocks(posterior.blocks, LAW, values)
    scores = normal_scores(posterior.blocks, predicted, values, 1e6)[0]
    assert np.std(scores) == pytest.approx(1.0, abs=0.1)
    assert abs(np.corrcoef(scores[1:], scores[:-1])[0, 1]) < 0.15
    far = PredictedForces(predicted.force + 1e9, predicted.slope, predicted.noise)
    assert np.isfinite(normal_scores(posterior.blocks, far, values, 3.0)).all()


@pytest.mark.long
def test_with_heavy_tails_intervals_hold_the_truth_where_gaussian_ones_do_not():
    gauss, student = [], []
    for seed in range(20):
        posterior = posterior_of(simulated(seed, 0.08))
        gauss.append(deviations(posterior))
        student.append(deviations(replace(posterior, tail=3.0)))
    inside = [np.sum(np.abs(found) < 1.645, axis=0) for found in (gauss, student)]
    assert inside[0][1] <= 2  # of friction, 20 of 20 with Student-t noise
    assert min(inside[1]) >= 15  # less happens once in 90
