# SPDX-License-Identifier: MIT
"""The plain fit finds the curve that the data are made of, whatever form they have."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.averaging.blocks import block_means
from model.bayes.plain_fit import fit_blocks, plain_fit
from model.bayes.posterior import LoadCell, default_priors
from model.errors import FitError
from model.slip import MagicFormula, SlipDefinition
from model.slip.samples import SlipSamples

LAW, TRUTH = MagicFormula("constant"), np.array([20.0, 1.5, 0.4, -0.1])


def drawn(slip, load, *, noise=0.01, seed=0, zero=0.0, offset=0.0, a_run=0.0):
    """Return samples of runs with slips and loads of shape (runs, samples)."""
    rng = np.random.default_rng(seed)
    force = LAW.force(slip - zero * (1 - slip), load, TRUTH) + offset
    force = force + a_run * rng.standard_normal((len(slip), 1))
    return SlipSamples(
        slip.ravel(), load.ravel(), (force + noise * rng.standard_normal(slip.shape)).ravel(),
        np.repeat(np.arange(len(slip)), slip.shape[1]), tuple(map(str, range(len(slip)))),
        SlipDefinition.MATERIAL,
    )  # fmt: skip


def set_points(n=24, samples=20, **more):
    slip = np.repeat(np.append(-np.geomspace(0.005, 0.5, n // 2), np.geomspace(0.005, 0.5, n // 2)),
                     samples).reshape(n, samples)  # fmt: skip
    load = np.where(np.arange(n) % 3, 4.0, 10.0)[:, None] + 0 * slip
    return drawn(slip, load, **more)


def sweeps(runs=6, samples=300, **more):
    slip = np.tile(np.linspace(-0.3, 0.3, samples), (runs, 1))
    return drawn(slip, np.repeat([[4.0], [10.0]], runs // 2, axis=0) + 0 * slip, **more)


def fitted(samples, *, seed=1):
    priors = default_priors(LAW, block_means(samples, 10), LoadCell())
    return plain_fit(
        samples, LAW, priors=priors, zero_sd=0.01, rng=np.random.default_rng(seed)
    )  # fmt: skip


@pytest.mark.parametrize("make", [set_points, sweeps])
@pytest.mark.parametrize("wrong", [{}, {"zero": 0.008, "offset": 0.05}])
def test_the_curve_is_found_with_the_zeros_of_force_and_slip(make, wrong):
    found = fitted(make(**wrong))
    assert found.values[[0, 2]] == pytest.approx(TRUTH[[0, 2]], rel=0.02)
    assert found.zero == pytest.approx(wrong.get("zero", 0.0), abs=5e-4)
    assert found.offset == pytest.approx(wrong.get("offset", 0.0), abs=0.01)


def test_runs_of_one_slip_are_means_and_share_their_offset():
    found = fitted(set_points())
    assert found.of_run_means
    assert not found.rows.offset_a_run


def test_sweeps_have_rows_and_an_offset_each():
    found = fitted(sweeps(a_run=0.5))
    assert len(found.rows) == 1800
    assert found.rows.offset_a_run
    assert found.values[[0, 2]] == pytest.approx(TRUTH[[0, 2]], rel=0.02)


def test_a_spoilt_run_hardly_moves_the_fit():
    samples = set_points()
    spoilt = samples.traction_force + 2.0 * (samples.run == 20)
    assert fitted(replace(samples, traction_force=spoilt)).values[2] == pytest.approx(0.4, rel=0.03)


def test_other_starts_lead_to_the_same_fit():
    first, second = (fitted(set_points(noise=0.1), seed=seed).values for seed in (1, 2))
    np.testing.assert_allclose(first, second, rtol=1e-3)


def test_resampled_fits_scatter_as_fits_of_other_data_do():
    draws = fitted(set_points(noise=0.0, a_run=0.05)).draws
    others = [fitted(set_points(noise=0.0, a_run=0.05, seed=seed)).values for seed in range(12)]
    assert np.std(draws[:, 0]) == pytest.approx(np.std(others, axis=0)[0], rel=0.7)


def test_more_rows_than_are_wanted_are_averaged_where_the_curve_is_straight():
    found = fitted(sweeps(samples=3000))
    assert len(found.rows) < 7000
    assert found.values[0] == pytest.approx(20.0, rel=0.02)


def test_block_means_are_fitted_without_samples():
    blocks = block_means(set_points(), 10)
    priors = default_priors(LAW, blocks, LoadCell())
    found = fit_blocks(blocks, LAW, priors=priors, zero_sd=0.01, rng=np.random.default_rng(0))
    assert found.values[[0, 2]] == pytest.approx(TRUTH[[0, 2]], rel=0.03)


def test_averages_that_bend_the_curve_move_the_fit_and_short_ones_do_not():
    samples = sweeps(samples=600)
    found = fitted(samples)
    long, half, short = (block_means(samples, length) for length in (60, 30, 2))
    assert found.moved(long, half) > 1.0
    assert found.moved(short, block_means(samples, 1)) < 0.2


def test_loads_at_which_no_curve_is_valid_are_refused(monkeypatch):
    monkeypatch.setattr(MagicFormula, "valid", lambda *_: np.array(False))
    with pytest.raises(FitError, match="check the unit of the load"):
        fitted(set_points())
