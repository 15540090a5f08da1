# SPDX-License-Identifier: MIT
from dataclasses import fields, replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from model.bayes.averaging.blocks import SlipBlocks, block_means
from support.slip_runs import mean_of_blocks, samples, white

RUN_LENGTHS = st.lists(st.integers(1, 60), min_size=1, max_size=8)

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
    np.testing.assert_allclose(block_means(data, n).slip_load_covariance, expected, rtol=1e-3)


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
