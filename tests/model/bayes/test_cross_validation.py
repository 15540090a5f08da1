# SPDX-License-Identifier: MIT
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from model.bayes import cross_validation
from model.bayes.averaging.blocks import block_means
from model.bayes.cross_validation import (
    cross_validate,
    measured_force,
    r_squared,
)
from model.bayes.drawing.laplace import Laplace, find_mode
from model.bayes.likelihood import predict_blocks
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.slip import MagicFormula, SlipDefinition
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep

LAW = MagicFormula(curvature=0.0)
LAW_VALUES = (20.0, 1.5, 0.38)
MATERIAL = SlipDefinition.MATERIAL
PLAN = SweepPlan(slips=(0.01, 0.04, 0.5), loads=(2.13, 12.75), duration=0.3)
COLUMNS = arrays(float, 12, elements=st.floats(-100.0, 100.0))


def simulated(seed=0, plan=PLAN):
    rng = np.random.default_rng(seed)
    return simulate_sweep(LAW, LAW_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng).samples


def posterior_of(blocks):
    return SlipPosterior(blocks, LAW, default_priors(LAW, blocks, LoadCell()))


@pytest.fixture(scope="module")
def samples():
    return simulated()


@pytest.fixture(scope="module")
def posterior(samples):
    return posterior_of(block_means(samples, 20))


@pytest.fixture(scope="module")
def laplace(posterior):
    known = dict(zip(("slip_stiffness", "shape", "friction"), LAW_VALUES, strict=True))
    start = posterior.coordinates({**known, "noise_floor": 0.03})
    return find_mode(posterior.log_density, start[None])


@pytest.fixture(scope="module")
def validation(posterior, laplace):
    return cross_validate(posterior, laplace)


# --- R²


@given(COLUMNS)
def test_a_perfect_prediction_explains_everything(measured):
    measured[0] += 1 + abs(measured).max()
    assert r_squared(measured, measured.copy()) == 1.0


@given(COLUMNS)
def test_the_mean_explains_nothing(measured):
    measured[0] += 1 + abs(measured).max()
    assert r_squared(measured, np.full(12, measured.mean())) == pytest.approx(0.0, abs=1e-12)


@given(COLUMNS, COLUMNS, st.floats(0.1, 10.0), st.floats(-10.0, 10.0))
def test_neither_unit_nor_zero_of_the_force_matters(measured, predicted, scale, shift):
    measured[0] += 1 + abs(measured).max()
    expected = r_squared(measured, predicted)
    found = r_squared(scale * measured + shift, scale * predicted + shift)
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9)


# --- predicting a measured force


def test_without_wander_the_prediction_is_the_likelihoods(posterior):
    blocks = replace(
        posterior.blocks,
        slip_wander=np.zeros(len(posterior.blocks)),
        slip_error=np.zeros(len(posterior.blocks)),
        load_variance=np.zeros(len(posterior.blocks)),
        load_skewness=np.zeros(len(posterior.blocks)),
        slip_load_covariance=np.zeros(len(posterior.blocks)),
        run_slip_error=np.zeros(posterior.blocks.n_runs),
    )
    for crosstalk, tolerance in ((0.0, 1e-6), (0.005, 1e-5)):
        values = np.array(
            [*LAW_VALUES, 0.01, -0.02, 0.1, crosstalk, 0.003, 0.02, 0.05, 0.01, 0.3, 0.1]
        )
        found = measured_force(LAW, values, blocks.slip, blocks.normal_force, MATERIAL)
        expected = predict_blocks(blocks, LAW, values[None]).force[0]
        np.testing.assert_allclose(found, expected, rtol=tolerance, atol=1e-9)


# --- leaving runs out


def test_each_of_few_runs_is_left_out_once_and_alone(validation, posterior):
    np.testing.assert_array_equal(np.sort(validation.fold), np.arange(posterior.blocks.n_runs))
    assert len(validation.values) == posterior.blocks.n_runs
    assert validation.scheme == "leave one run out, 6 runs"


def test_a_fit_never_sees_the_run_it_leaves_out(validation, posterior, laplace):
    spoilt_run = 3
    rows = posterior.blocks.run == spoilt_run
    force = posterior.blocks.traction_force + np.where(rows, 3.0, 0.0)
    spoilt = replace(posterior, blocks=replace(posterior.blocks, traction_force=force))
    found = cross_validate(spoilt, laplace)
    own = validation.fold[spoilt_run]
    np.testing.assert_array_equal(found.values[own], validation.values[own])
    others = np.delete(np.arange(len(found.values)), own)
    assert np.all(np.any(found.values[others] != validation.values[others], axis=1))
    assert found.log_density[spoilt_run] < validation.log_density[spoilt_run] - 10


def test_the_predictive_density_is_that_of_the_run_under_the_others_fit(validation, posterior):
    for run in range(posterior.blocks.n_runs):
        alone = np.arange(posterior.blocks.n_runs) == run
        values = validation.values[validation.fold[run]]
        named = dict(zip((p.name for p in posterior.parameters), values, strict=True))
        z = posterior.coordinates(named)[None]
        expected = posterior.without_runs(~alone).run_log_likelihood(z)[0, 0]
        assert validation.log_density[run] == pytest.approx(expected, rel=1e-6)


def test_a_run_is_predicted_by_the_fit_that_has_not_seen_it(validation, samples):
    predicted = validation.predict(samples, LAW)
    for run, part in enumerate(samples.slices()):
        values = validation.values[validation.fold[run]]
        slip, load = samples.slip[part], samples.normal_force[part]
        expected = measured_force(LAW, values, slip, load, MATERIAL)
        np.testing.assert_array_equal(predicted[part], expected)


def test_left_out_runs_of_the_right_law_are_predicted_well(validation, posterior):
    predicted = np.array(
        [
            measured_force(LAW, validation.values[validation.fold[run]], slip, load, MATERIAL)
            for run, slip, load in zip(
                posterior.blocks.run,
                posterior.blocks.slip,
                posterior.blocks.normal_force,
                strict=True,
            )
        ]
    )
    assert r_squared(posterior.blocks.traction_force, predicted) > 0.97


def test_many_runs_are_left_out_in_interleaved_groups(monkeypatch):
    def stay(log_density, starts, covariance):
        return starts[0]

    monkeypatch.setattr(cross_validation, "climb", stay)
    plan = replace(PLAN, slips=tuple(np.linspace(0, 0.5, 12)))
    posterior = posterior_of(block_means(simulated(plan=plan), 20))
    mode = posterior.coordinates({"noise_floor": 0.05})
    found = cross_validate(posterior, Laplace(mode, np.eye(len(mode)), 0.0))
    np.testing.assert_array_equal(found.fold, np.arange(24) % 10)
    assert found.scheme == "leave out 24 runs in 10 interleaved groups"
    np.testing.assert_array_equal(found.values, np.repeat(posterior.values(mode[None]), 10, axis=0))
    np.testing.assert_allclose(
        found.log_density, posterior.run_log_likelihood(mode[None])[0], rtol=1e-12
    )


def test_folds_fitted_at_once_or_in_turn_are_the_same(posterior, laplace, validation):
    in_turn = cross_validate(posterior, laplace, executor=ThreadPoolExecutor(2))
    np.testing.assert_array_equal(in_turn.values, validation.values)
    np.testing.assert_array_equal(in_turn.log_density, validation.log_density)
