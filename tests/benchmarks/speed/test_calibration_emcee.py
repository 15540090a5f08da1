# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.speed.calibration import LOAD_CELL, simulate
from benchmarks.speed.calibration_emcee import (
    naive,
    numpy_log_likelihood,
    scipy_log_likelihood,
)
from model.bayes.drawing.sampler import walker_count
from model.bayes.fit import prepare_fit
from model.bayes.likelihood import log_likelihood
from model.slip.thesis_curve import THESIS_LAW
from rig.slip_rig.sweep import SweepPlan

pytestmark = pytest.mark.long

SMALL = SweepPlan(slips=(0.02, 0.05, 0.1, 0.2, 0.4, 0.8), duration=0.4)


@pytest.fixture(scope="module")
def fit():
    return prepare_fit(
        simulate(SMALL).samples, THESIS_LAW, load_cell=LOAD_CELL, rng=np.random.default_rng(1),
        validate=False,
    )  # fmt: skip


@pytest.mark.parametrize("dense", [scipy_log_likelihood, numpy_log_likelihood])
def test_a_dense_likelihood_is_ours(fit, dense):
    posterior = fit.posterior
    values = posterior.values(fit.approximation.draw(10, rng=np.random.default_rng(2)))
    ours = log_likelihood(posterior.blocks, posterior.law, values)
    found = [dense(posterior, row) for row in values]
    np.testing.assert_allclose(found, ours, rtol=0, atol=1e-8)


def test_naive_walkers_make_whole_moves_and_each_evaluation_counts(fit):
    found = naive(fit, numpy_log_likelihood, seconds=1e-9, per_evaluation=0.01)
    walkers = walker_count(len(fit.laplace.mode))
    assert found.effective == pytest.approx(0.01 * 2 * walkers)  # the starts and one move
    assert found.rate > 0
