# SPDX-License-Identifier: MIT
"""Student-t noise is a density, becomes Gaussian noise, and is hardly moved by far blocks."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.blocks import block_means
from model.bayes.gaussian_equivalent import gaussian_equivalent
from model.bayes.laplace import LaplaceMixture, find_mode
from model.bayes.likelihood import PredictedForces, filter_runs, predict_blocks
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.rig_errors import RigErrors
from model.bayes.student import filter_student_runs, normal_scores
from model.bayes.tail_choice import choose_tail
from model.slip import Brush
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep

LAW, TRUTH = Brush(), (20.0, 0.4)
KNOWN = {"slip_stiffness": 20.0, "friction": 0.4, "noise_floor": 0.03}


def filtered(residual, tail, starts=(0, 3, 7)):
    n = len(residual)
    rng = np.random.default_rng(1)
    noise, slope = rng.uniform(0.5, 1.5, (2, 1, 7))[..., :n]
    errors = 0.1 * np.ones(n), np.array([0.3, 0.2])
    given = residual[None], noise, slope, *errors, np.array(starts), np.array([0.6])
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


def simulated(seed, dropped):
    """Return samples and, for a share of the tenths of a second, a force that falls short."""
    slips = np.tile([0.005, 0.015, 0.03, 0.06, 0.15, 0.4], 3)
    plan = SweepPlan(slips=tuple(slips), loads=(4.0, 12.0), rate=50.0)
    rng = np.random.default_rng(seed)
    samples = simulate_sweep(LAW, TRUTH, plan=plan, imperfections=TYPICAL_RIG, rng=rng).samples
    force = samples.traction_force.copy()
    for start in range(0, len(force), 5):
        if rng.random() < dropped:
            force[start : start + 5] *= rng.uniform(0.0, 0.6)
    return replace(samples, traction_force=force)


def posterior_of(samples):
    """Return the posterior on a rig that is well known, so that intervals are narrow."""
    blocks = block_means(samples, 5)
    cell = LoadCell(zero_stability=0.05, gain_sd=0.001, bias_sd=0.01, crosstalk_sd=0.001)
    priors = default_priors(LAW, blocks, cell, RigErrors(0.001, 0.002))
    return SlipPosterior(blocks, LAW, priors)


def deviations(posterior):
    """Return how far the mode lies from the truth in its standard deviations, K and mu."""
    truth = posterior.coordinates(KNOWN)
    mode = find_mode(posterior.log_density, truth[None])
    return (mode.mode[:2] - truth[:2]) / np.sqrt(np.diag(mode.covariance)[:2])


def test_far_blocks_come_near_and_the_others_stay_for_the_checks():
    posterior = posterior_of(simulated(1, 0.05))
    values = posterior.values(posterior.coordinates(KNOWN)[None])
    assert gaussian_equivalent(posterior, values) is posterior
    blocks = gaussian_equivalent(replace(posterior, tail=3.0), values).blocks
    expected = predict_blocks(blocks, LAW, values).force[0]
    before = np.abs(posterior.blocks.traction_force - expected)
    after = np.abs(blocks.traction_force - expected)
    far = before > 0.8
    assert far.sum() > 5
    assert after[far].max() < 0.25 * before[far].max()
    assert np.median(np.abs(after - before)[~far]) < 0.02


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


@pytest.mark.long
@pytest.mark.parametrize(("dropped", "tails"), [(0.05, {3.0, 5.0}), (0.0, {30.0})])
def test_tails_are_as_heavy_as_the_data_have_them(dropped, tails):
    posterior = posterior_of(simulated(1, dropped))
    gauss = find_mode(posterior.log_density, posterior.coordinates(KNOWN)[None])
    chosen = choose_tail(posterior, LaplaceMixture((gauss,)))
    assert chosen.posterior.tail in tails
    assert (chosen.gain[chosen.posterior.tail] > 10) == (dropped > 0)
