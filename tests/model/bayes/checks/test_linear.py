# SPDX-License-Identifier: MIT
"""Score tests give what a fit with one more term would give."""

import numpy as np
import pytest
from scipy.stats import kstest

from model.bayes.checks.linear import whiten
from model.bayes.likelihood import predict_blocks
from support.linearised_fits import linearised, with_force


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
