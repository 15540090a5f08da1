# SPDX-License-Identifier: MIT
"""Score tests give what a fit with one more term would give."""

import numpy as np
import pytest
from scipy.stats import kstest

from model.bayes.checks.linear import whiten
from model.bayes.likelihood import NUISANCE, predict_blocks
from model.slip.definition import slip_per_radius_error
from model.slip.thesis_curve import THESIS_LAW
from support.linearised_fits import linearised, with_force

NAMES = [parameter.name for parameter in (*THESIS_LAW.parameters, *NUISANCE)]


def test_what_the_fit_can_absorb_has_no_size():
    posterior, fit, _ = linearised()
    step = 1e-4 * np.eye(len(fit.z))[0]
    values = posterior.values(np.stack([fit.z + step, fit.z - step]))
    ahead, behind = predict_blocks(fit.blocks, posterior.law, values).force
    left = fit.project(((ahead - behind) / 2e-4)[:, None])[:, 0]
    white = whiten(fit.blocks, (ahead - behind)[:, None] / 2e-4, fit.factors)
    assert np.sum(left**2) < 0.01 * np.sum(white**2)


@pytest.mark.parametrize("size", [-0.3, 0.0, 0.2])
def test_a_force_that_was_added_is_found_with_its_size(size):
    _, fit, _ = linearised(with_force(lambda s: np.full(len(s), size)))
    term = fit.test(np.ones(len(fit.blocks)))
    assert term.size == pytest.approx(size, abs=4 * term.sd)
    assert (term.p < 1e-6) == (size != 0)
    assert term.t == pytest.approx(term.size / term.sd)


def test_whitened_residuals_of_the_truth_are_white():
    _, fit, _ = linearised()
    white = whiten(fit.blocks, fit.residual[:, None], fit.factors)[:, 0]
    assert kstest(white / white.std(), "norm").pvalue > 0.001


def test_a_term_that_scatters_between_runs_is_no_more_sure_than_its_scatter():
    _, fit, _ = linearised()
    force = np.where(np.arange(fit.blocks.n_runs) % 2 == 0, 1.0, -1.0)[fit.blocks.run]
    model = 1 / np.linalg.norm(fit.project(force[:, None]))
    assert fit.test(force).sd >= 0.999 * model


def test_a_shift_of_slip_is_nothing_but_the_radius_error_that_is_fitted():
    posterior, fit, _ = linearised()
    moved = np.tile(fit.values, (2, 1))
    moved[:, NAMES.index("radius_error")] += [1e-5, -1e-5]
    more, less = predict_blocks(fit.blocks, posterior.law, moved).force
    shift = fit.per_slip * slip_per_radius_error(fit.blocks.slip, fit.blocks.definition)
    np.testing.assert_allclose((less - more) / 2e-5, shift, rtol=1e-3, atol=1e-3 * shift.max())


def test_a_term_that_the_fit_absorbs_leaves_no_force_and_another_leaves_itself():
    _, fit, _ = linearised(fixed={})
    rolling, alternating = fit.blocks.normal_force, (-1.0) ** np.arange(len(fit.blocks))
    assert np.abs(fit.beyond_fit(rolling)).max() < 0.1 * rolling.min()
    left = fit.beyond_fit(alternating)
    assert np.corrcoef(left, alternating)[0, 1] > 0.95
    np.testing.assert_allclose(left.std(), alternating.std(), rtol=0.1)


def test_how_slip_is_distributed_within_blocks_is_blamed_on_nothing():
    """What a sine wave's distribution changes is absorbed as far as its prior goes, N(0, 1)."""
    posterior, fit, _ = linearised()
    as_sine = predict_blocks(fit.blocks, posterior.law, fit.values[None], sine=True).force[0]
    ripple = as_sine - fit.predicted.force
    assert np.abs(ripple).max() > 0
    for size in (1.0, 100.0):  # the second as if it had a hundred times the prior's size
        white = whiten(fit.blocks, size * ripple[:, None], fit.factors)
        left = fit.project(size * ripple[:, None])
        assert np.sum(left**2) <= np.sum(white**2) / (1 + np.sum(white**2) / size**2) * (1 + 1e-9)
    assert fit.spread().shape == fit.absorbed(ripple).shape == fit.z.shape
