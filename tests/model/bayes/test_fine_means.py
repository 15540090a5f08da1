# SPDX-License-Identifier: MIT
"""Blocks of means are those of the samples, and what no mean shows is kept."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.blocks import SlipBlocks, block_means
from model.bayes.checks.linear import linearise
from model.bayes.checks.periodic import block_times
from model.bayes.checks.raw import clipped, outliers
from model.bayes.fine_means import fine_moments, joined_moments, moments_of_runs, reduce_samples
from model.bayes.samples import SlipSamples
from model.bayes.slip_noise import slip_noise_variance
from support.linearised_fits import linearised, sound_sweep

FEW = 5


def reduced(samples: SlipSamples, length: int = FEW) -> SlipSamples:
    """Return samples averaged by the length, all at once."""
    found = reduce_samples(samples, length)
    slip, load, force, time = found.means
    return SlipSamples(
        slip, load, force, found.run, samples.run_names, samples.definition, time,
        fine=fine_moments([found], samples.n_runs),
    )  # fmt: skip


def assert_same(found: SlipBlocks, expected: SlipBlocks) -> None:
    for name in (
        "slip",
        "normal_force",
        "traction_force",
        "slip_wander",
        "slip_error",
        "count",
        "load_variance",
        "load_skewness",
        "slip_load_covariance",
        "run_slip_error",
    ):
        one, other = getattr(found, name), getattr(expected, name)
        size = np.abs(other).max(initial=1e-30)
        np.testing.assert_allclose(one, other, rtol=1e-7, atol=1e-9 * size, err_msg=name)


@pytest.mark.parametrize("length", [1, 5])
def test_blocks_of_means_are_those_of_the_samples(length):
    samples = sound_sweep().samples
    assert_same(block_means(reduced(samples, length), 20 // length), block_means(samples, 20))


def test_noise_is_that_of_samples_and_a_mean_has_its_share():
    samples = sound_sweep().samples
    np.testing.assert_allclose(
        slip_noise_variance(reduced(samples)), slip_noise_variance(samples) / FEW
    )


def test_parts_of_a_run_that_are_read_apart_are_joined():
    samples = sound_sweep().samples
    half = 3 * FEW  # of the first run
    first, rest = (
        reduce_samples(
            SlipSamples(
                samples.slip[part], samples.normal_force[part], samples.traction_force[part],
                samples.run[part], samples.run_names, samples.definition,
            ),
            FEW,
        )
        for part in (slice(0, half), slice(half, None))
    )  # fmt: skip
    found = fine_moments([first, rest], samples.n_runs)
    whole = reduced(samples).fine
    assert whole is not None
    np.testing.assert_array_equal(found.length, whole.length)
    np.testing.assert_allclose(found.load_third, whole.load_third)
    np.testing.assert_allclose(found.noise[1:], whole.noise[1:])
    assert found.noise[0] == pytest.approx(whole.noise[0], rel=0.2)


def test_outliers_and_limits_of_samples_are_counted():
    samples = sound_sweep().samples
    hit = np.arange(len(samples)) % 331 == 100
    force = samples.traction_force + 40.0 * hit
    spiky = reduced(replace(samples, traction_force=force)).fine
    assert spiky is not None
    expected = outliers(replace(samples, traction_force=force), force, np.zeros(len(force)))
    assert spiky.outliers.count == expected.count > 0.7 * hit.sum()
    assert spiky.outliers.size == pytest.approx(40, rel=0.1)
    assert not outliers(samples, np.zeros(len(samples)), np.zeros(len(samples))).matter
    limited = replace(samples, traction_force=np.minimum(samples.traction_force, 3.0))
    found = reduced(limited).fine
    assert found is not None
    assert found.clipped == (clipped(limited.traction_force), None)
    assert found.clipped[0] is not None


def test_tables_are_joined_and_runs_are_left_out():
    samples = sound_sweep().samples
    fine = reduced(samples).fine
    assert fine is not None
    both = joined_moments([fine, fine])
    assert len(both.length) == 2 * samples.n_runs
    assert both.outliers.count == 2 * fine.outliers.count
    rows = np.arange(len(both.count)) >= len(fine.count)
    left = moments_of_runs(both, rows, np.arange(2 * samples.n_runs) >= samples.n_runs)
    np.testing.assert_array_equal(left.slip_variance, fine.slip_variance)
    np.testing.assert_array_equal(left.noise, fine.noise)


def test_blocks_of_means_have_the_times_of_their_samples():
    posterior, fit, samples = linearised()
    means = reduced(samples, 4)
    own = linearise(replace(posterior, blocks=block_means(means, 3)), fit.z[None])
    np.testing.assert_allclose(block_times(own, means), block_times(fit, samples), atol=0.025)
