# SPDX-License-Identifier: MIT
"""Residuals of the model's own data are white, and so are the means of runs."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.linalg import cholesky, toeplitz

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.likelihood import NUISANCE, log_likelihood, predict_blocks
from model.bayes.residuals import analyse_residuals, lag_correlation
from model.slip import MagicFormula, SlipDefinition

LAW = MagicFormula(curvature=0.0)
LAW_VALUES = (20.0, 1.5, 0.38)
LOADS = (2.13, 6.63, 12.75)
SIZE = 6


def parameters(law_values=LAW_VALUES, **nuisance):
    known = {
        "slip_error_scale": 1.0,
        "noise_floor": 0.02,
        "noise_slope": 0.01,
        "noise_correlation": 0.6,
        "offset_spread": 0.05,
        **nuisance,
    }
    return np.array([[*law_values, *(known.get(p.name, 0.0) for p in NUISANCE)]])


def blocks(slips, loads, rng, *, size=SIZE):
    """Return blocks with slip errors and wander, a run a set-point, no traction yet."""
    load, slip = (a.ravel() for a in np.meshgrid(loads, slips, indexing="ij"))
    n_runs, n = len(slip), len(slip) * size
    run = np.repeat(np.arange(n_runs), size)
    return SlipBlocks(
        slip=slip[run] + 0.003 * rng.standard_normal(n),
        normal_force=load[run] * rng.uniform(0.98, 1.1, n),
        traction_force=np.zeros(n),
        count=np.full(n, 10),
        run=run,
        run_names=tuple(map(str, range(n_runs))),
        definition=SlipDefinition.MATERIAL,
        slip_wander=np.full(n, 4e-6),
        slip_error=np.full(n, 1e-6),
        load_variance=np.zeros(n),
        load_skewness=np.zeros(n),
        slip_load_covariance=np.zeros(n),
        run_slip_error=np.full(n_runs, 5e-7),
        load_error=np.zeros(n),
        noise_size=np.ones(n),
    )


def sweep(seed=0):
    """Draw tractions from the data model, run by run from its dense covariance."""
    rng = np.random.default_rng(seed)
    data, values = blocks(np.linspace(0.0, 0.6, 30), LOADS, rng), parameters()
    predicted = predict_blocks(data, LAW, values)
    rho, tau = values[0, -2:]
    force = predicted.force[0].copy()
    for run in range(data.n_runs):
        rows = data.run == run
        s, g = predicted.noise[0, rows], predicted.slope[0, rows]
        covariance = np.outer(s, s) * toeplitz(np.power(rho, np.arange(len(s)), dtype=float))
        covariance += tau**2 + data.run_slip_error[run] * np.outer(g, g)
        covariance += np.diag(g**2 * data.slip_error[rows])
        force[rows] += cholesky(covariance, lower=True) @ rng.standard_normal(len(s))
    return replace(data, traction_force=force)


def test_residuals_and_run_means_of_the_models_own_data_are_white_and_standard_normal():
    data = sweep()
    found = analyse_residuals(data, LAW, parameters())
    assert stats.kstest(found.whitened, "norm").pvalue > 0.01
    assert stats.kstest(found.run_score, "norm").pvalue > 0.01
    correlation, pairs = lag_correlation(found.whitened, data.run, 1)
    assert abs(correlation) * np.sqrt(pairs) < 3


def test_whitened_residuals_carry_the_likelihood():
    data = sweep()
    values = parameters()
    whitened = analyse_residuals(data, LAW, values).whitened
    shifted = replace(data, traction_force=predict_blocks(data, LAW, values).force[0])
    exponent = log_likelihood(shifted, LAW, values) - log_likelihood(data, LAW, values)
    np.testing.assert_allclose(0.5 * np.sum(whitened**2), exponent, rtol=1e-9)


def test_a_run_means_interval_widens_with_the_posteriors_spread():
    data = sweep()
    sure = analyse_residuals(data, LAW, parameters())
    rng = np.random.default_rng(1)
    draws = np.repeat(parameters(), 200, axis=0)
    draws[:, 2] *= rng.normal(1.0, 0.05, 200)
    unsure = analyse_residuals(data, LAW, draws)
    assert np.abs(unsure.run_score).mean() < 0.8 * np.abs(sure.run_score).mean()


def test_figures_of_fit_are_those_of_the_block_residuals():
    data = sweep()
    found = analyse_residuals(data, LAW, parameters())
    residual = data.traction_force - predict_blocks(data, LAW, parameters()).force[0]
    assert found.rmse == pytest.approx(residual.std(), rel=0.01)
    assert found.r_squared == pytest.approx(
        1 - residual.var() / data.traction_force.var(), abs=1e-3
    )
    over_load = np.sqrt(np.mean((residual / data.normal_force) ** 2))
    assert found.rmse_over_load == pytest.approx(over_load)


# --- lag-one correlation


@settings(max_examples=30)
@given(rho=st.floats(-0.9, 0.9), seed=st.integers(0, 20))
def test_lag_one_correlation_of_ar1_values_is_rho(rho, seed):
    rng = np.random.default_rng(seed)
    data = blocks(np.linspace(0, 1, 20), LOADS, rng, size=100)
    root = np.linalg.cholesky(toeplitz(np.power(rho, np.arange(100), dtype=float)))
    values = (rng.standard_normal((data.n_runs, 100)) @ root.T).ravel()
    assert lag_correlation(values, data.run, 1)[0] == pytest.approx(rho, abs=0.06)


def test_the_step_from_one_run_to_the_next_does_not_count():
    rng = np.random.default_rng(3)
    data = blocks(np.linspace(0, 1, 20), LOADS, rng, size=2)
    alternating = np.tile([1.0, -1.0], data.n_runs)
    assert lag_correlation(alternating, data.run, 1)[0] == pytest.approx(-1.0)
    stepping = np.repeat(np.tile([1.0, -1.0], data.n_runs // 2), 2)
    assert lag_correlation(stepping, data.run, 1)[0] == pytest.approx(1.0)


def test_runs_of_one_block_have_no_lag_one_correlation():
    rng = np.random.default_rng(4)
    data = blocks(np.linspace(0, 1, 20), LOADS, rng, size=1)
    assert lag_correlation(rng.standard_normal(len(data)), data.run, 1)[0] == 0.0


def test_a_few_wild_pairs_are_correlated_by_no_more_than_one():
    run = np.repeat(np.arange(10), [40, *[8] * 9])
    values = np.where(run == 0, 10.0, 0.1)
    for lag in range(1, 40):
        correlation, pairs = lag_correlation(values, run, lag)
        assert correlation <= 1.0 + 1e-12
        assert pairs == 40 - lag + 9 * max(0, 8 - lag)
