# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.linalg import cholesky, toeplitz

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import nearest_level
from model.bayes.likelihood import NUISANCE, log_likelihood, predict_blocks
from model.bayes.plain.fit import fit_blocks
from model.bayes.posterior import LoadCell, default_priors
from model.bayes.residuals import analyse_residuals, far_runs, lag_correlation
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


def blocks(slips, loads, rng, *, size=SIZE, repeats=1):
    """Return blocks with slip errors and wander, a run a set-point, no traction yet."""
    load, slip = (np.tile(a.ravel(), repeats) for a in np.meshgrid(loads, slips, indexing="ij"))
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


def with_traction(data, rng, values=None, law=LAW):
    """Draw the tractions from the data model, run by run from its dense covariance."""
    values = parameters() if values is None else values
    predicted = predict_blocks(data, law, values)
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


def sweep(seed=0, *, values=None, slips=None, repeats=1):
    rng = np.random.default_rng(seed)
    slips = np.linspace(0.0, 0.6, 30) if slips is None else slips
    return with_traction(blocks(slips, LOADS, rng, repeats=repeats), rng, values)


def own_lag_one(data, residuals):
    """Return the lag-one correlation of residuals as a share of its standard error."""
    pairs = len(data) - data.n_runs
    return residuals.lag_one * np.sqrt(pairs)


# --- the model's own data


def test_whitened_residuals_of_the_models_own_data_are_white_and_standard_normal():
    data = sweep()
    found = analyse_residuals(data, LAW, parameters())
    assert stats.kstest(found.whitened, "norm").pvalue > 0.01
    assert abs(own_lag_one(data, found)) < 3
    assert found.whitened.shape == (len(data),)


def test_whitened_residuals_carry_the_likelihood():
    data = sweep()
    values = parameters()
    whitened = analyse_residuals(data, LAW, values).whitened
    shifted = replace(data, traction_force=predict_blocks(data, LAW, values).force[0])
    exponent = log_likelihood(shifted, LAW, values) - log_likelihood(data, LAW, values)
    np.testing.assert_allclose(0.5 * np.sum(whitened**2), exponent, rtol=1e-9)


def test_ninety_of_a_hundred_run_means_lie_inside_their_interval():
    inside, below = 0.0, 0
    for seed in range(10):
        found = analyse_residuals(sweep(seed), LAW, parameters())
        inside += found.inside / 10
        below += found.inside_p < 0.01
        assert abs(found.run_score.mean()) < 0.4
    assert inside == pytest.approx(0.9, abs=0.03)  # of 900 runs
    assert below == 0


def test_a_run_means_interval_widens_with_the_posteriors_spread():
    data = sweep()
    sure = analyse_residuals(data, LAW, parameters())
    rng = np.random.default_rng(1)
    draws = np.repeat(parameters(), 200, axis=0)
    draws[:, 2] *= rng.normal(1.0, 0.05, 200)
    unsure = analyse_residuals(data, LAW, draws)
    assert np.abs(unsure.run_score).mean() < 0.8 * np.abs(sure.run_score).mean()


def test_the_true_law_leaves_no_structure():
    found = [analyse_residuals(sweep(seed), LAW, parameters()) for seed in range(20)]
    assert max(residuals.misfit for residuals in found) < 0.02
    p_values = [residuals.misfit_p for residuals in found]
    assert stats.kstest(p_values, "uniform").pvalue > 0.01


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


# --- what is wrong is found


@pytest.mark.parametrize("ignored", ["noise_correlation", "offset_spread"])
def test_correlation_that_the_values_ignore_is_found(ignored):
    data = sweep(values=parameters(offset_spread=0.1))
    blind = analyse_residuals(data, LAW, parameters(**{"offset_spread": 0.1, ignored: 0.0}))
    assert own_lag_one(data, blind) > 5


def test_offsets_that_the_values_ignore_push_run_means_out_of_their_intervals():
    data = sweep(values=parameters(offset_spread=0.2))
    blind = analyse_residuals(data, LAW, parameters(offset_spread=0.0))
    assert blind.inside < 0.7
    assert blind.inside_p < 1e-3
    assert analyse_residuals(data, LAW, parameters(offset_spread=0.2)).inside_p > 0.01


def test_a_wrong_shape_is_reported_as_misfit():
    data = sweep()
    wrong = analyse_residuals(data, LAW, parameters((20.0, 1.9, 0.38)))
    assert wrong.misfit > 0.05
    assert wrong.misfit_p < 1e-3


def refitted(data):
    """Return the law's best values for these data, the measurement's left as they are."""
    priors = default_priors(LAW, data, LoadCell())
    rng = np.random.default_rng(0)
    plain = fit_blocks(data, LAW, priors=priors, zero_sd=1e-9, rng=rng)
    return parameters(tuple(plain.values))


def test_an_odd_law_fitted_to_a_lopsided_curve_is_reported_as_misfit():
    data = sweep(slips=np.linspace(-0.6, 0.6, 60))
    braking = data.slip < 0
    lopsided = replace(data, traction_force=np.where(braking, 0.6, 1.0) * data.traction_force)
    found = analyse_residuals(lopsided, LAW, refitted(lopsided))
    assert found.misfit > 0.05
    assert found.misfit_p < 1e-3
    whole = analyse_residuals(data, LAW, refitted(data))
    assert whole.misfit < 0.02


def test_misfit_measures_what_repeats_and_not_the_scatter_of_runs():
    noisy = parameters(offset_spread=0.4)
    found = analyse_residuals(sweep(values=noisy), LAW, noisy)
    assert found.rmse > 0.3
    assert found.misfit < 0.03
    assert found.misfit_p > 0.01


def planted(data, share, *, at=LOADS):
    """Add a share of the peak at their load to the tractions of some loads."""
    load = np.array(LOADS)[nearest_level(data.normal_force, np.array(LOADS))]
    peak = np.max(np.abs(predict_blocks(data, LAW, parameters()).force[0]) / load) * load
    return replace(
        data, traction_force=data.traction_force + np.where(np.isin(load, at), share * peak, 0.0)
    )


def test_the_misfits_size_is_the_planted_one():
    found = analyse_residuals(planted(sweep(), -0.1), LAW, parameters())
    assert found.misfit == pytest.approx(0.1, rel=0.15)


@pytest.mark.parametrize("load", LOADS)
def test_a_single_load_that_the_law_misses_is_found_however_small(load):
    data = sweep(repeats=2)
    found = analyse_residuals(planted(data, 0.12, at=(load,)), LAW, parameters())
    assert found.misfit == pytest.approx(0.12, rel=0.25)
    assert found.misfit_p < 1e-3
    assert analyse_residuals(data, LAW, parameters()).misfit_p > 0.01


def as_sweeps(data, runs):
    """Return the blocks of each load as runs that sweep all slips, `runs` a load."""
    level = nearest_level(data.normal_force, np.array(LOADS))
    order = np.argsort(level, kind="stable")
    turn = np.arange(len(data)) % (len(data) // 3) % runs
    order = order[np.lexsort((turn, level[order]))]
    run = np.repeat(np.arange(3 * runs), len(data) // (3 * runs))
    kept = {
        name: getattr(data, name)[order]
        for name in ("slip", "normal_force", "slip_wander", "slip_error", "count",
                     "load_variance", "load_skewness", "slip_load_covariance")
    }  # fmt: skip
    return replace(
        data, **kept, run=run, run_names=tuple(map(str, range(3 * runs))),
        traction_force=np.zeros(len(data)), run_slip_error=np.full(3 * runs, 5e-7),
    )  # fmt: skip


def test_few_sweeps_with_offsets_are_not_taken_for_a_misfit():
    rng = np.random.default_rng(3)
    plain = as_sweeps(blocks(np.linspace(0.0, 0.6, 30), LOADS, rng), runs=3)
    values = parameters(offset_spread=0.15)
    found = [analyse_residuals(with_traction(plain, rng, values), LAW, values) for _ in range(30)]
    assert sum(each.misfit_p < 1e-3 for each in found) <= 1  # 4, if each bin of a sweep counted
    assert max(each.misfit for each in found) < 0.02


@pytest.mark.parametrize("runs", [2, 3])
def test_a_misfit_that_few_sweeps_share_is_found_whatever_their_offsets(runs):
    rng = np.random.default_rng(5)
    plain = as_sweeps(blocks(np.linspace(0.0, 0.6, 30), LOADS, rng), runs=runs)
    values = parameters(offset_spread=0.15)
    data = with_traction(plain, rng, values)
    share = np.abs(predict_blocks(plain, LAW, values).force[0] / plain.normal_force).max()
    sine = 0.1 * share * np.sin(4 * np.pi * plain.slip / 0.6) * plain.normal_force
    wavy = replace(data, traction_force=data.traction_force + sine)
    found = analyse_residuals(wavy, LAW, values)
    assert found.misfit == pytest.approx(0.1 / np.sqrt(2), rel=0.15)
    assert found.misfit_p < 1e-3
    assert found.detectable < 0.05


def test_a_pair_of_runs_can_show_no_misfit_and_three_times_as_many_can():
    values = parameters(offset_spread=0.05)

    def detectable(repeats):
        rng = np.random.default_rng(6)
        data = blocks(np.array([0.3]), np.array([6.63]), rng, repeats=repeats)
        return analyse_residuals(with_traction(data, rng, values), LAW, values).detectable

    assert detectable(2) > 0.2
    assert detectable(6) < 0.05


def test_where_nothing_is_repeated_there_is_no_claim_of_misfit():
    rng = np.random.default_rng(2)
    data = with_traction(blocks(np.array([0.05]), LOADS, rng), rng)
    found = analyse_residuals(data, LAW, parameters((5.0, 1.2, 0.9)))
    assert found.misfit == 0.0
    assert np.isnan(found.misfit_p)


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


@pytest.mark.parametrize("n", [8, 12, 24, 60, 250])
def test_runs_of_one_kind_are_hardly_ever_far_from_the_others(n):
    scores = np.random.default_rng(n).standard_normal((500, n))
    assert sum(len(far_runs(score)) > 0 for score in scores) <= 2


def test_runs_of_another_kind_are_far_even_where_they_lie_within_their_own_intervals():
    rng = np.random.default_rng(1)
    score = np.append(0.3 * rng.standard_normal(24), [-1.3, -1.4, -2.0, -3.8])
    assert set(far_runs(score)) == {24, 25, 26, 27}
    assert far_runs(score)[0] == 27


def test_scores_that_are_all_small_are_not_far_however_close_the_others_are():
    assert len(far_runs(np.append(1e-3 * np.arange(20), 1.5))) == 0
