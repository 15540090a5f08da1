# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.bayes.averaging.blocks import block_means
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.slip.rig_errors import RUN_OUT, run_out_scatter
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep
from support.slip_runs import mean_of_blocks, samples, wander, white

NOISE = 0.01


def test_noise_is_not_mistaken_for_wander():
    rng = np.random.default_rng(6)
    blocks = block_means(samples(white(rng, (100, 250), NOISE)), 10)
    assert blocks.slip_wander.mean() < 0.05 * NOISE**2
    assert blocks.slip_wander.max() < NOISE**2  # not one block of 2,500 stands out by chance


@pytest.mark.parametrize("noise", [0.0, 0.003], ids=["noise-free", "noisy"])
@pytest.mark.parametrize("length", [3, 10, 50])
def test_wander_within_blocks_is_the_variance_of_the_true_slip_in_them(noise, length):
    rng = np.random.default_rng(7)
    true = wander(rng, (60, 250), NOISE, steps=40)
    blocks = block_means(samples(true + white(rng, true.shape, noise)), length)
    mean = np.repeat(mean_of_blocks(true.ravel(), blocks.count), blocks.count)
    within = mean_of_blocks((true.ravel() - mean) ** 2, blocks.count)
    # The noise is known to 2.6e-7 by 15,000 second differences.
    assert blocks.slip_wander.mean() == pytest.approx(within.mean(), rel=0.05, abs=8e-7)


@pytest.mark.parametrize("noise", [0.0, 0.001, 0.003])
def test_steady_blocks_and_lively_ones_are_told_apart_without_bias(noise):
    rng = np.random.default_rng(12)
    true = wander(rng, (60, 250), NOISE, steps=40)
    blocks = block_means(samples(true + white(rng, true.shape, noise)), 25)
    mean = np.repeat(mean_of_blocks(true.ravel(), blocks.count), blocks.count)
    within = mean_of_blocks((true.ravel() - mean) ** 2, blocks.count)
    slope, _ = np.polyfit(blocks.slip_wander, within, 1)
    assert slope == pytest.approx(1.0, abs=0.15)


def test_a_jump_too_near_a_runs_end_for_a_block_of_its_own_stays_in_its_block():
    rng = np.random.default_rng(13)
    true = np.zeros((20, 250))
    true[7, 240:] = 0.2  # within the last block of 25
    blocks = block_means(samples(true + white(rng, true.shape, 0.001)), 25)
    jumped = np.argmax(blocks.slip_wander)
    assert jumped == 7 * 10 + 9
    assert blocks.slip_wander[jumped] == pytest.approx(0.2**2 * 0.6 * 0.4, rel=0.05)
    assert np.delete(blocks.slip_wander, jumped).max() < 0.001**2


def test_in_a_smooth_record_every_block_keeps_its_own_wander():
    phase = np.random.default_rng(8).uniform(0, 2 * np.pi, (5, 1))
    data = samples(NOISE * np.sin(phase + np.arange(200) / 20))
    blocks = block_means(data, 19)
    mean = np.repeat(mean_of_blocks(data.slip, blocks.count), blocks.count)
    own = mean_of_blocks((data.slip - mean) ** 2, blocks.count)
    np.testing.assert_allclose(blocks.slip_wander, own, rtol=0.02, atol=1e-9)


def test_where_every_run_is_short_slip_counts_as_noise_free():
    rng = np.random.default_rng(11)
    data = samples([white(rng, 7, NOISE) for _ in range(10)])
    blocks = block_means(data, 2)
    np.testing.assert_array_equal(slip_noise_variance(data), 0.0)
    np.testing.assert_array_equal(blocks.slip_error, 0.0)
    np.testing.assert_array_equal(blocks.run_slip_error, 0.0)
    np.testing.assert_allclose(blocks.slip, mean_of_blocks(data.slip, blocks.count))


def test_a_clean_sweep_has_no_noise_and_keeps_its_slip():
    data = samples([np.linspace(0.0, 0.5, 200), np.linspace(0.5, -0.2, 150)])
    blocks = block_means(data, 10)
    np.testing.assert_allclose(slip_noise_variance(data), 0.0, atol=1e-25)
    np.testing.assert_allclose(blocks.slip, mean_of_blocks(data.slip, blocks.count), atol=1e-12)
    np.testing.assert_allclose(blocks.slip_error, 0.0, atol=1e-20)
    np.testing.assert_allclose(blocks.run_slip_error, 0.0, atol=1e-20)


# --- regression calibration


def calibrated(rig, seed, *, length=20):
    """Return the blocks of a simulated sweep, their mean true slip and their mean measured slip."""
    plan = SweepPlan(slips=tuple(np.linspace(0.0, 0.9, 40)), loads=(6.0,), duration=1.2)
    rng = np.random.default_rng(seed)
    log = simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=rig, rng=rng)
    blocks = block_means(log.samples, length)
    true, measured = (mean_of_blocks(x, blocks.count) for x in (log.slip_true, log.samples.slip))
    return blocks, true, measured


def error_scores(rig, seeds):
    """Return errors of slip over the claimed ones: of every block, of every run's mean."""
    scores, run_scores = [], []
    for seed in seeds:
        blocks, true, _ = calibrated(rig, seed)
        error = blocks.slip - true
        scores.append(error / np.sqrt(blocks.slip_error + blocks.run_slip_error[blocks.run]))
        of_run = blocks.run_mean(blocks.slip_error) / np.bincount(blocks.run)
        run_scores.append(blocks.run_mean(error) / np.sqrt(of_run + blocks.run_slip_error))
    return np.array(scores), np.array(run_scores)


@pytest.mark.parametrize("wander_sd", [0.0, 0.003, 0.01])
def test_the_claimed_error_of_slip_is_the_error_it_has(wander_sd):
    rig = replace(TYPICAL_RIG, slip_wander_sd=wander_sd, speed_noise=0.035)
    for scores in error_scores(rig, range(10)):
        assert 0.85 < scores.std() < 1.2
        assert abs(scores.mean()) < 0.2


def test_wander_that_noise_hides_is_left_to_the_scatter_of_the_fit():
    # A tenth of the noise: whether it is there at all, 40 runs can hardly tell.
    rig = replace(TYPICAL_RIG, slip_wander_sd=0.001, speed_noise=0.035)
    unclaimed = []
    for seed in range(10):
        blocks, true, _ = calibrated(rig, seed)
        claimed = blocks.slip_error + blocks.run_slip_error[blocks.run]
        unclaimed.append(np.mean((blocks.slip - true) ** 2 - claimed))
    assert np.mean(unclaimed) < run_out_scatter(0.035, 0.12, RUN_OUT) ** 2
    _, run_scores = error_scores(rig, range(10))
    assert 0.85 < run_scores.std() < 1.2


def test_the_variance_around_a_blocks_slip_adds_wander_and_both_errors():
    blocks, _, _ = calibrated(TYPICAL_RIG, seed=0)
    shared = np.repeat(blocks.run_slip_error, np.bincount(blocks.run))
    expected = blocks.slip_wander + blocks.slip_error + shared
    np.testing.assert_allclose(blocks.slip_variance(), expected, rtol=1e-14)


@pytest.mark.parametrize("runs", [5, 40, 250])
def test_noise_alone_moves_no_block_away_from_its_run(runs):
    rng = np.random.default_rng(15)
    kept = []
    for _ in range(30):
        blocks = block_means(samples(white(rng, (runs, 100), NOISE)), 8)
        middle = np.repeat(blocks.run_mean(blocks.slip), np.bincount(blocks.run))
        kept.append(np.ptp(blocks.slip - middle) < 1e-12)
    assert sum(kept) >= 29


def bumped(rng, slip, noise, *, per_load=0.0):
    """Return samples of runs (m, n) with noise of slip, half of whose blocks of 20 ride a bump."""
    bump = np.tile(np.repeat([1.0, 0.0], 20) * np.sin(np.arange(40) / 3), slip.shape[1] // 40)
    load = 8.0 + 3.0 * bump + np.zeros_like(slip)
    true = slip + per_load * (load - 8.0)
    return replace(samples(true + white(rng, true.shape, noise)), normal_force=load.ravel()), true


def covariances(data, true):
    """Return the blocks, and covariance of true slip and load in each."""
    blocks = block_means(data, 20)
    load, slip = data.normal_force.reshape(-1, 20), true.reshape(-1, 20)
    return blocks, np.mean(load * slip, axis=1) - load.mean(axis=1) * slip.mean(axis=1)


def test_noise_of_slip_is_no_covariance_with_load():
    rng = np.random.default_rng(16)
    blocks, _ = covariances(*bumped(rng, np.zeros((60, 120)), NOISE))
    made = NOISE * np.sqrt(blocks.load_variance.max() / 20)
    assert np.sqrt(np.mean(blocks.slip_load_covariance**2)) < 0.05 * made


@pytest.mark.parametrize("noise", [0.002, NOISE])
def test_slip_that_follows_load_keeps_its_covariance(noise):
    rng = np.random.default_rng(17)
    blocks, true = covariances(*bumped(rng, np.zeros((60, 120)), noise, per_load=0.003))
    on_bump = blocks.load_variance > 1.0
    found = blocks.slip_load_covariance[on_bump].mean()
    lost = noise**2 / 20 / (noise**2 / 20 + 0.003**2 * blocks.load_variance[on_bump].mean())
    assert found == pytest.approx(true[on_bump].mean(), rel=1.5 * lost + 0.01)


def test_the_claimed_error_of_a_covariance_is_the_error_it_has():
    rng = np.random.default_rng(18)
    data, slip = bumped(rng, wander(rng, (60, 400), 0.01, steps=10), NOISE)
    blocks, true = covariances(data, slip)
    plain = block_means(replace(data, normal_force=np.full_like(data.slip, 8.0)), 20)
    claimed = (blocks.slip_error - plain.slip_error) * blocks.normal_force**2
    on_bump = blocks.load_variance > 1.0
    error = np.mean((blocks.slip_load_covariance - true)[on_bump] ** 2)
    assert error == pytest.approx(claimed[on_bump].mean(), rel=0.3)
