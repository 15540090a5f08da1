# SPDX-License-Identifier: MIT
"""The noise of load and of traction is told from what traction follows, run by run."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from model.bayes.averaging.run_noise import noise_sizes, with_true_loads
from support.small_layouts import layout

N_RUNS, SIZE, SLOPE = 60, 20, 0.4


def noisy(true_sd, noise_sd, *, memory=0.0, seed=0):
    """Return blocks whose true load varies within runs, their residual and the true loads."""
    rng = np.random.default_rng(seed)
    blocks = layout(N_RUNS, SIZE)
    own = rng.standard_normal((N_RUNS, SIZE))
    own = lfilter([np.sqrt(1 - memory**2)], [1.0, -memory], own, axis=1).ravel()
    true = blocks.normal_force + true_sd * rng.standard_normal(len(blocks))
    residual = SLOPE * (true - blocks.normal_force) + 0.02 * rng.standard_normal(len(blocks))
    return replace(blocks, normal_force=true + noise_sd * own), residual, true


@pytest.mark.parametrize("memory", [0.0, 0.8])
@pytest.mark.parametrize("true_sd", [0.04, 0.08, 0.14])
def test_a_load_keeps_the_share_of_its_variation_that_traction_follows(true_sd, memory):
    blocks, residual, true = noisy(true_sd, 0.05, memory=memory)
    found = with_true_loads(blocks, residual, np.full(len(blocks), SLOPE))
    mean = blocks.run_mean(blocks.normal_force)[blocks.run]
    share = np.polyfit(blocks.normal_force - mean, found.normal_force - mean, 1)[0]
    cell = blocks.normal_force - true
    cell = cell - blocks.run_mean(cell)[blocks.run]  # its noise has a part that a run shares
    assert share == pytest.approx(true_sd**2 / (true_sd**2 + np.var(cell)), abs=0.12)
    error = found.normal_force - true
    error = np.std(error - blocks.run_mean(error)[blocks.run])
    assert error < 1.02 * np.std(cell)
    assert np.sqrt(found.load_error.mean()) == pytest.approx(error, rel=0.3)


def test_where_nothing_tells_it_a_run_has_its_mean_load():
    blocks, residual, _ = noisy(0.04, 0.05)
    found = with_true_loads(blocks, residual, np.zeros(len(blocks)))
    np.testing.assert_array_equal(found.normal_force, blocks.normal_force)  # it does not matter
    loud = residual + np.random.default_rng(1).standard_normal(len(blocks))
    found = with_true_loads(blocks, loud, np.full(len(blocks), SLOPE))
    mean = blocks.run_mean(blocks.normal_force)[blocks.run]
    np.testing.assert_allclose(found.normal_force, mean)


def test_loads_of_single_rows_stay_as_measured():
    blocks = layout(12, 1)
    found = with_true_loads(blocks, np.zeros(12), np.full(12, SLOPE))
    np.testing.assert_array_equal(found.normal_force, blocks.normal_force)


def test_runs_that_are_alike_have_noise_of_one_size():
    blocks, residual, _ = noisy(0.0, 0.0)
    np.testing.assert_allclose(noise_sizes(blocks, residual, np.zeros(len(blocks))), 1.0, atol=0.1)


def test_runs_of_stick_slip_are_noisier_whatever_the_curve():
    blocks, residual, _ = noisy(0.0, 0.0)
    loud = blocks.run % 2 == 0
    sizes = noise_sizes(blocks, residual * np.where(loud, 10.0, 1.0), np.zeros(len(blocks)))
    ratio = np.median(sizes[loud]) / np.median(sizes[~loud])
    assert ratio == pytest.approx(10.0, rel=0.2)


def test_what_the_error_of_slip_does_is_no_noise_of_traction():
    blocks, residual, _ = noisy(0.0, 0.0)
    steep, rng = blocks.run % 2 == 0, np.random.default_rng(2)
    slope = np.where(steep, 100.0, 0.0)
    blocks = replace(blocks, slip_error=np.full(len(blocks), 1e-3**2))
    sizes = noise_sizes(blocks, residual + slope * 1e-3 * rng.standard_normal(len(blocks)), slope)
    assert np.median(sizes[steep]) < 3 * np.median(sizes[~steep])


def test_one_run_has_the_usual_noise():
    np.testing.assert_array_equal(noise_sizes(layout(1, 5), np.arange(5.0), np.zeros(5)), 1.0)


def test_noise_that_grows_with_the_force_has_that_size_in_short_runs_too():
    rng = np.random.default_rng(3)
    blocks = layout(N_RUNS, 6)
    force = np.geomspace(0.5, 5.0, N_RUNS)[rng.permutation(N_RUNS)][blocks.run]
    blocks = replace(blocks, traction_force=force)
    sizes = noise_sizes(
        blocks, 0.02 * force * rng.standard_normal(len(blocks)), np.zeros_like(force)
    )
    ratio = sizes / force
    assert np.std(ratio[force > 1]) < 0.1 * np.mean(ratio)  # six blocks tell a size to 30 %


def test_runs_without_traction_keep_the_noise_that_a_cell_has_without_force():
    rng = np.random.default_rng(4)
    blocks = layout(N_RUNS, 6)
    force = np.geomspace(0.05, 5.0, N_RUNS)[rng.permutation(N_RUNS)][blocks.run]
    force = np.where(blocks.run < 5, 0.0, force)
    true = 0.03 + 0.02 * force
    blocks = replace(blocks, traction_force=force)
    sizes = noise_sizes(blocks, true * rng.standard_normal(len(blocks)), np.zeros_like(force))
    ratio = (sizes / true)[blocks.run < 5] / np.median(sizes / true)
    assert np.all((ratio > 0.5) & (ratio < 2.0))
