# SPDX-License-Identifier: MIT
"""Blocks begin where a run begins and where slip jumps, and are of nearly equal size between."""

import numpy as np
import pytest

from model.bayes.averaging.block_edges import block_starts
from model.bayes.averaging.blocks import block_means
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.slip import SlipDefinition
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES

NOISE = 0.002


def samples(*slip_runs):
    """Return samples of runs at 6 N that follow the thesis's law without noise of the force."""
    slip = np.concatenate(slip_runs)
    lengths = [len(run) for run in slip_runs]
    return SlipSamples(
        slip=slip,
        normal_force=np.full(len(slip), 6.0),
        traction_force=THESIS_LAW.force(slip, 6.0, THESIS_VALUES),
        run=np.repeat(np.arange(len(lengths)), lengths),
        run_names=tuple(f"run {index}" for index in range(len(lengths))),
        definition=SlipDefinition.MATERIAL,
    )


def starts_of(data, length):
    return block_starts(data, length, noise=slip_noise_variance(data))[0].tolist()


def steps(*set_points, each=100):
    return np.repeat(set_points, each)


@pytest.mark.parametrize("noise", [0.0, NOISE])
@pytest.mark.parametrize("length", [7, 15, 30, 60])
def test_no_block_has_two_set_points_whatever_its_length(noise, length):
    rng = np.random.default_rng(length)
    slip = steps(0.01, 0.3, 0.05, 0.9, 0.02)
    data = samples(slip + noise * rng.standard_normal(len(slip)), slip[:250])
    starts = starts_of(data, length)
    assert {0, 100, 200, 300, 400, 500, 600, 700, 750} <= set(starts)
    sizes = np.diff(starts)
    assert sizes.min() >= length / 2
    assert sizes.max() <= 1.5 * length + 1


def test_the_force_of_a_block_is_the_laws_at_its_slip():
    data = samples(steps(0.004, 0.02, 0.3, 0.01, 0.9))
    blocks = block_means(data, 15)
    expected = THESIS_LAW.force(blocks.slip, 6.0, THESIS_VALUES)
    np.testing.assert_allclose(blocks.traction_force, expected, rtol=1e-9)
    np.testing.assert_allclose(blocks.slip_wander, 0.0, atol=1e-20)


def test_a_glide_a_wave_noise_and_wander_are_no_jumps():
    rng = np.random.default_rng(3)
    walk = 0.003 * np.cumsum(rng.standard_normal(400)) / 8
    for slip in (
        np.linspace(0.0, 0.5, 400),
        0.1 * np.sin(np.arange(400) / 30),
        NOISE * rng.standard_normal(400),
        np.linspace(0.0, 0.5, 400) + NOISE * rng.standard_normal(400),
        walk + NOISE * rng.standard_normal(400),
    ):
        assert starts_of(samples(slip), 20) == list(range(0, 401, 20))


def rippling(rng, n=40_000):
    """Return true slip that both discs' speeds ripple, and measured values, as much noise on it."""
    time, phase = np.arange(n), 85 * rng.random(2)
    waves = [np.sin(2 * np.pi * (time + phase[i]) / period) for i, period in enumerate((87, 122))]
    true = 0.005 * np.sum(waves, axis=0)
    return true, true + 0.006 * rng.standard_normal(n)


@pytest.mark.parametrize("length", [50, 64, 100])
def test_noise_does_not_choose_cuts_in_a_ripple(length):
    """Measured slips of blocks would be off to where the noise of their samples is large."""
    true, measured = rippling(np.random.default_rng(length))
    starts = np.array(starts_of(samples(measured), length))
    count = np.diff(starts)
    mean, error = (np.add.reduceat(x, starts[:-1]) / count for x in (true, measured - true))
    per_slip = mean @ error / (mean @ mean)
    assert abs(per_slip) < 4 * 0.006 / np.sqrt(length * (mean @ mean))
    assert np.mean(error**2 * count) == pytest.approx(0.006**2, rel=4 * np.sqrt(2 / len(count)))


def test_a_jump_within_a_ripple_is_one():
    _, measured = rippling(np.random.default_rng(2), 1000)
    starts = starts_of(samples(measured + np.repeat([0.1, 0.16], 500)), 60)
    assert min(abs(start - 500) for start in starts) <= 1


def test_no_part_is_shorter_than_half_a_block():
    slip = np.concatenate([steps(0.1, each=100), steps(0.5, each=9), steps(0.1, each=100)])
    sizes = np.diff(starts_of(samples(slip), 20))
    assert sizes.min() >= 10


def test_blocks_of_two_samples_know_no_jump():
    assert starts_of(samples(np.linspace(0.0, 0.5, 10)), 2) == [0, 2, 4, 6, 8, 10]
