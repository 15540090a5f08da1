# SPDX-License-Identifier: MIT
"""Left-out runs are predicted alike by weighted draws and by fits without them."""

import numpy as np
import pytest

from model.bayes import left_out
from model.bayes.averaging.blocks import block_means
from model.bayes.drawing.laplace import LaplaceMixture, find_modes
from model.bayes.drawing.weighted import importance_draws
from model.bayes.left_out import Refitted, leave_out
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.slip import Brush
from model.slip.rig_errors import RigErrors
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep

LAW, TRUTH = Brush(), (20.0, 0.4)
PERFECT = RigErrors(1e-4, 1e-3, 1e-4)  # so that no run decides alone
PLAN = SweepPlan(slips=(-0.05, 0.01, 0.03, 0.3), loads=(4.0, 12.0), rate=40.0)


@pytest.fixture(scope="module")
def posterior():
    rng = np.random.default_rng(4)
    samples = simulate_sweep(LAW, TRUTH, plan=PLAN, imperfections=TYPICAL_RIG, rng=rng).samples
    blocks = block_means(samples, 10)
    return SlipPosterior(blocks, LAW, default_priors(LAW, blocks, LoadCell(), PERFECT))


@pytest.fixture(scope="module")
def approximation(posterior):
    known = {"slip_stiffness": 20.0, "friction": 0.4, "noise_floor": 0.03}
    start = posterior.coordinates(known)[None]
    return LaplaceMixture(find_modes(posterior.log_density, start))


@pytest.fixture(scope="module")
def draws(posterior, approximation):
    return importance_draws(
        posterior.log_density, approximation, n=2000, rng=np.random.default_rng(5)
    )


@pytest.fixture
def left_out_by_groups(posterior, approximation, draws):
    def leave(group):
        return leave_out(
            posterior, draws, group, approximation=approximation,
            rng=np.random.default_rng(6),
        )  # fmt: skip

    return leave


def test_weighted_draws_predict_a_left_out_run_as_a_fit_without_it(left_out_by_groups, monkeypatch):
    runs = np.arange(8)
    by_weights = left_out_by_groups(runs)
    monkeypatch.setattr(left_out, "MAX_PARETO_K", -10.0)
    anew = left_out_by_groups(runs)
    assert anew.refitted.all()
    np.testing.assert_allclose(by_weights.log_density, anew.log_density, atol=0.4)
    assert by_weights.log_density.sum() == pytest.approx(anew.log_density.sum(), abs=0.8)


def test_a_run_at_a_load_never_seen_is_predicted_worse(left_out_by_groups):
    alone, with_load = left_out_by_groups(np.arange(8)), left_out_by_groups(np.arange(8) // 4)
    assert with_load.pareto_k.shape == (2,)
    assert with_load.log_density.sum() < alone.log_density.sum()


def test_many_bad_weights_are_mended_in_ten_folds(left_out_by_groups, monkeypatch):
    folds = []
    monkeypatch.setattr(left_out, "MAX_PARETO_K", -10.0)
    monkeypatch.setattr(left_out, "MAX_SINGLE_FOLDS", 3)
    monkeypatch.setattr(left_out, "N_GROUPED_FOLDS", 2)

    def without(task):
        folds.append(np.flatnonzero(task.left_out).tolist())
        return Refitted(np.full(int(task.left_out.sum()), float(len(folds))), 0.1)

    monkeypatch.setattr(left_out, "refit_without", without)
    found = left_out_by_groups(np.arange(8))
    assert folds == [[0, 2, 4, 6], [1, 3, 5, 7]]
    np.testing.assert_array_equal(found.log_density, [1, 2] * 4)
