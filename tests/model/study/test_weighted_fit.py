# SPDX-License-Identifier: MIT
"""Fits of simulated blocks have reliable weights, by adapted draws where need be."""

import numpy as np
import pytest

from model.bayes.laplace import Laplace, LaplaceMixture, find_mode
from model.study import weighted_fit
from model.study.simulated_blocks import simulate_blocks
from model.study.weighted_fit import LEAST, fit_blocks, weigh
from support.study_layouts import design

TRUE = np.array([20.0, 0.4, *np.zeros(6), 1.0, 0.0, 0.05, 0.02, 0.3, 0.05])


@pytest.fixture(scope="module")
def fitted():
    study = design()
    blocks = simulate_blocks(study.blocks, study.law, TRUE, rng=np.random.default_rng(4))
    return fit_blocks(study, blocks, np.random.default_rng(5))


def test_a_fit_is_reliable_and_holds_the_truth(fitted):
    assert fitted.reliable
    assert fitted.effective >= LEAST
    friction = fitted.values(4000, np.random.default_rng(1))[:, 1]
    assert abs(friction.mean() - 0.4) < 4 * friction.std()


def test_a_poor_first_approximation_is_adapted_to_the_same_posterior(fitted, monkeypatch):
    posterior = fitted.posterior
    good = find_mode(posterior.log_density, posterior.coordinates({"friction": 0.4})[None])
    off = good.mode + 2 * np.sqrt(np.diag(good.covariance))
    narrow = Laplace(off, 0.1 * good.covariance, good.log_density)
    monkeypatch.setattr(weighted_fit, "DRAWS", 500)
    adapted = weigh(posterior, LaplaceMixture((narrow,)), np.random.default_rng(3))
    assert len(adapted.draws.z) != 500
    assert adapted.reliable
    ours, theirs = (each.values(4000, np.random.default_rng(1)) for each in (adapted, fitted))
    assert np.all(np.abs(ours.mean(axis=0) - theirs.mean(axis=0)) < 0.2 * theirs.std(axis=0))
