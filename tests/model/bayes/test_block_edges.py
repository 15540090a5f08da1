# SPDX-License-Identifier: MIT
"""Blocks begin where a run begins and where slip jumps, and are of nearly equal size between."""

import numpy as np
import pytest

from model.bayes.block_edges import block_starts
from model.bayes.blocks import block_means
from model.bayes.samples import SlipSamples
from model.bayes.slip_noise import slip_noise_variance
from model.slip import SlipDefinition
from model.slip.thesis import THESIS_LAW, THESIS_VALUES

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


def test_no_part_is_shorter_than_half_a_block():
    slip = np.concatenate([steps(0.1, each=100), steps(0.5, each=9), steps(0.1, each=100)])
    sizes = np.diff(starts_of(samples(slip), 20))
    assert sizes.min() >= 10


def test_blocks_of_two_samples_know_no_jump():
    assert starts_of(samples(np.linspace(0.0, 0.5, 10)), 2) == [0, 2, 4, 6, 8, 10]
