# SPDX-License-Identifier: MIT
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lfilter

from model.bayes.blocks import SlipBlocks, block_means, slip_noise_variance
from model.bayes.samples import SlipSamples
from model.slip import SlipDefinition
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep

NOISE = 0.01
RUN_LENGTHS = st.lists(st.integers(1, 60), min_size=1, max_size=8)


def samples(slip_runs, seed=0):
    """Return samples of runs with these slips and random forces."""
    rng = np.random.default_rng(seed)
    lengths = [len(slip) for slip in slip_runs]
    n = sum(lengths)
    return SlipSamples(
        slip=np.concatenate([np.asarray(slip, dtype=float) for slip in slip_runs]),
        normal_force=rng.uniform(4.0, 6.0, n),
        traction_force=rng.uniform(0.0, 2.0, n),
        run=np.repeat(np.arange(len(lengths)), lengths),
        run_names=tuple(f"run {index}" for index in range(len(lengths))),
        definition=SlipDefinition.MATERIAL,
    )


def white(rng, shape, sd):
    return sd * rng.standard_normal(shape)


def wander(rng, shape, sd, *, steps):
    """Draw Ornstein-Uhlenbeck paths, one a row, with a correlation time in samples."""
    rho = np.exp(-1 / steps)
    shock = rng.standard_normal(shape)
    shock[:, 1:] *= np.sqrt(1 - rho**2)
    return sd * lfilter([1.0], [1.0, -rho], shock, axis=1)


def mean_of_blocks(values, count):
    starts = np.append(0, np.cumsum(count)[:-1])
    return np.add.reduceat(values, starts) / count


# --- cutting


@given(lengths=RUN_LENGTHS, length=st.integers(1, 80))
def test_no_sample_is_lost_and_no_block_straddles_two_runs(lengths, length):
    data = samples([np.linspace(0, 1, n) for n in lengths])
    blocks = block_means(data, length)
    assert blocks.count.min() >= 1
    np.testing.assert_array_equal(np.bincount(blocks.run, blocks.count), lengths)
    assert np.all(np.diff(blocks.run) >= 0)
    np.testing.assert_array_equal(np.unique(blocks.run), np.arange(len(lengths)))


@given(lengths=RUN_LENGTHS, length=st.integers(1, 80))
def test_a_runs_blocks_are_of_nearly_equal_size_near_the_one_asked_for(lengths, length):
    blocks = block_means(samples([np.zeros(n) for n in lengths]), length)
    for run, n in enumerate(lengths):
        count = blocks.count[blocks.run == run]
        assert np.ptp(count) <= 1
        assert len(count) == max(1, round(n / length))


@given(lengths=RUN_LENGTHS, length=st.integers(1, 80))
def test_load_and_traction_are_exact_means(lengths, length):
    data = samples([np.zeros(n) for n in lengths])
    blocks = block_means(data, length)
    for found, column in (
        (blocks.normal_force, data.normal_force),
        (blocks.traction_force, data.traction_force),
    ):
        np.testing.assert_allclose(found, mean_of_blocks(column, blocks.count), rtol=1e-12)


@given(lengths=RUN_LENGTHS, length=st.integers(1, 80), seed=st.integers(0, 100))
def test_calibrating_the_slip_leaves_every_runs_mean_alone(lengths, length, seed):
    rng = np.random.default_rng(seed)
    data = samples([white(rng, n, 0.1) for n in lengths])
    blocks = block_means(data, length)
    before = np.bincount(data.run, data.slip) / lengths
    after = np.bincount(blocks.run, blocks.slip * blocks.count) / lengths
    np.testing.assert_allclose(after, before, atol=1e-12)


def test_blocks_of_one_sample_are_the_samples():
    data = samples([np.linspace(0.0, 0.5, 40)] * 3)
    blocks = block_means(data, 1)
    for name in ("slip", "normal_force", "traction_force", "run"):
        np.testing.assert_allclose(getattr(blocks, name), getattr(data, name), rtol=1e-12)
    np.testing.assert_array_equal(blocks.slip_wander, 0.0)
    np.testing.assert_array_equal(blocks.slip_load_covariance, 0.0)


def test_slip_and_load_that_move_together_leave_their_covariance():
    n = 30
    slip = np.tile(np.linspace(0.0, 0.1, n), 4)
    data = replace(samples([slip]), normal_force=5 + 2 * slip)
    expected = 2 * np.var(slip[:n])
    np.testing.assert_allclose(block_means(data, n).slip_load_covariance, expected, rtol=1e-12)


# --- selecting


@given(keep=st.lists(st.booleans(), min_size=5, max_size=5).filter(any))
def test_selected_runs_keep_their_blocks_and_are_numbered_anew(keep):
    keep = np.array(keep)
    rng = np.random.default_rng(2)
    data = samples([white(rng, n, 0.01) + n / 100 for n in (10, 20, 30, 40, 50)])
    blocks = block_means(data, 7)
    chosen = blocks.select_runs(keep)
    rows = keep[blocks.run]
    assert chosen.n_runs == keep.sum()
    assert chosen.run_names == tuple(np.array(blocks.run_names)[keep])
    np.testing.assert_array_equal(np.flatnonzero(keep)[chosen.run], blocks.run[rows])
    for field in fields(SlipBlocks):
        if field.name not in ("run", "run_names", "definition"):
            column = getattr(blocks, field.name)
            mask = keep if len(column) == blocks.n_runs else rows
            np.testing.assert_array_equal(getattr(chosen, field.name), column[mask])


def test_the_mean_over_a_run_counts_blocks_and_takes_leading_axes_along():
    blocks = block_means(samples([np.zeros(40), np.zeros(20)]), 10)
    values = np.arange(12.0).reshape(2, 6)
    expected = np.stack([values[:, :4].mean(axis=1), values[:, 4:].mean(axis=1)], axis=1)
    np.testing.assert_allclose(blocks.run_mean(values), expected)


# --- sensor noise and true wander told apart


@pytest.mark.parametrize("trend", [0.0, 0.3], ids=["held", "swept"])
@pytest.mark.parametrize("wandering", [0.0, 0.01], ids=["steady", "wandering"])
def test_white_slip_noise_is_recovered_whatever_the_slip_does(trend, wandering):
    rng = np.random.default_rng(4)
    true = np.linspace(0, trend, 250) + wander(rng, (40, 250), wandering, steps=60)
    found = slip_noise_variance(samples(true + white(rng, true.shape, NOISE)))
    assert found.mean() == pytest.approx(NOISE**2, rel=0.1)


def test_the_noise_of_many_short_runs_is_not_underrated():
    rng = np.random.default_rng(0)
    found = slip_noise_variance(samples(white(rng, (1000, 12), NOISE)))
    # Each run's estimate is skewed: the plain median lies at 0.87.
    assert found.mean() == pytest.approx(NOISE**2, rel=0.06)


def test_wander_is_not_mistaken_for_noise():
    rng = np.random.default_rng(5)
    data = samples(wander(rng, (40, 250), NOISE, steps=40))
    assert slip_noise_variance(data).mean() < 0.01 * NOISE**2


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
    # The noise is known to 2e-7, and the wander's fastest part looks like noise.
    assert blocks.slip_wander.mean() == pytest.approx(within.mean(), rel=0.05, abs=5e-7)


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


def test_runs_may_have_sensors_of_different_noise():
    rng = np.random.default_rng(9)
    sizes = np.repeat([0.002, 0.02], 20)[:, None]
    found = slip_noise_variance(samples(sizes * rng.standard_normal((40, 400))))
    np.testing.assert_allclose(found[:20].mean(), 0.002**2, rtol=0.5)
    np.testing.assert_allclose(found[20:].mean(), 0.02**2, rtol=0.1)


def test_runs_too_short_to_judge_take_the_others_noise():
    rng = np.random.default_rng(10)
    long = [white(rng, 300, NOISE) for _ in range(10)]
    found = slip_noise_variance(samples([*long, white(rng, 5, NOISE)]))
    assert found[-1] == pytest.approx(np.median(found[:-1]), rel=0.02)


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
    for scores in error_scores(rig, range(5)):
        assert 0.85 < scores.std() < 1.2
        assert abs(scores.mean()) < 0.2


def test_wander_far_below_the_noise_blurs_the_claimed_error_but_not_by_half():
    # A tenth of the noise: whether it is there at all, 40 runs can hardly tell.
    rig = replace(TYPICAL_RIG, slip_wander_sd=0.001, speed_noise=0.035)
    scores, run_scores = error_scores(rig, range(10))
    assert 0.7 < scores.std() < 1.5
    assert 0.85 < run_scores.std() < 1.2


@pytest.mark.parametrize("wander_sd", [0.0, 0.001, 0.003])
def test_calibrated_slip_is_nearer_to_the_truth_than_measured_slip(wander_sd):
    rig = replace(TYPICAL_RIG, slip_wander_sd=wander_sd, speed_noise=0.035)
    blocks, true, measured = calibrated(rig, seed=0)
    assert np.mean((blocks.slip - true) ** 2) < 0.8 * np.mean((measured - true) ** 2)


def test_without_noise_in_the_speeds_measured_slip_is_taken_at_its_word():
    blocks, true, _ = calibrated(replace(TYPICAL_RIG, speed_noise=0.0), seed=0)
    assert np.abs(blocks.slip - true).max() < 0.1 * TYPICAL_RIG.slip_wander_sd


def test_the_variance_around_a_blocks_slip_adds_wander_and_both_errors():
    blocks, _, _ = calibrated(TYPICAL_RIG, seed=0)
    shared = np.repeat(blocks.run_slip_error, np.bincount(blocks.run))
    expected = blocks.slip_wander + blocks.slip_error + shared
    np.testing.assert_allclose(blocks.slip_variance(), expected, rtol=1e-14)
