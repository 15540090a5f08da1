# SPDX-License-Identifier: MIT
"""Score tests give what a fit with further terms would give."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import kstest

from model.bayes.checks.linear import curve_features, whiten
from model.bayes.likelihood import NUISANCE, predict_blocks
from model.slip.definition import slip_per_radius_error
from model.slip.thesis_curve import THESIS_LAW
from support.linearised_fits import linearised, with_force

NAMES = [parameter.name for parameter in (*THESIS_LAW.parameters, *NUISANCE)]


def step_of(posterior, fit, i=0, size=1e-4):
    """Return the change of all forces by a coordinate's, per unit, shape (n,) [N]."""
    step = size * np.eye(len(fit.z))[i]
    values = posterior.values(np.stack([fit.z + step, fit.z - step]))
    ahead, behind = predict_blocks(fit.blocks, posterior.law, values).force
    return (ahead - behind) / (2 * size)


def test_what_the_fit_can_absorb_has_no_size():
    posterior, fit, _ = linearised()
    force = step_of(posterior, fit)[:, None]
    assert np.sum(fit.project(force) ** 2) < 0.01 * np.sum(
        whiten(fit.blocks, force, fit.factors) ** 2
    )
    (column,) = np.eye(len(fit.z))[:1]  # the prior holds back a little of a unit
    np.testing.assert_allclose(fit.absorbed(force[:, 0]), column, atol=0.02)


@pytest.mark.parametrize("sizes", [(-0.3, 0.0), (0.2, 0.02)])
def test_forces_that_were_added_are_found_together_with_their_sizes(sizes):
    planted = with_force(lambda s: sizes[0] + sizes[1] * s.normal_force)
    _, fit, _ = linearised(planted)
    term = fit.test(np.column_stack([np.ones(len(fit.blocks)), fit.blocks.normal_force]))
    assert np.all(np.abs(term.size - sizes) < 4 * term.sd)
    assert term.p < 1e-6
    alone = fit.test(np.ones((len(fit.blocks), 1)))
    assert term.gain >= alone.gain > 100


def test_terms_that_are_taken_out_are_not_found_again():
    _, fit, _ = linearised(with_force(lambda s: 0.02 * s.normal_force))
    terms = np.column_stack([np.ones(len(fit.blocks)), fit.blocks.normal_force])
    assert fit.test(terms).gain > 100
    left = fit.without(terms)
    np.testing.assert_allclose(left.rest @ fit.project(terms), 0.0, atol=1e-6)
    np.testing.assert_allclose(left.project(terms), 0.0, atol=1e-6)


@pytest.mark.parametrize("m", [1, 2])
def test_p_values_of_sound_data_are_uniform(m):
    _, fit, _ = linearised(length=100)
    rng, blocks = np.random.default_rng(m), fit.blocks
    terms = np.column_stack([np.ones(len(blocks)), fit.per_slip * blocks.slip**2])[:, :m]
    p = []
    for _ in range(300):
        drawn = rng.standard_normal(len(fit.rest))
        p.append(replace(fit, rest=drawn - fit.basis @ (fit.basis.T @ drawn)).test(terms).p)
    assert kstest(p, "uniform").pvalue > 0.01
    assert np.mean(np.array(p) < 0.05) < 0.1


def test_a_term_that_scatters_between_runs_is_no_more_sure_than_its_scatter():
    rng = np.random.default_rng(3)
    zeros = rng.normal(0.0, 0.5, 48)
    _, fit, _ = linearised(with_force(lambda s: zeros[s.run]))
    term = fit.test(np.ones((len(fit.blocks), 1)))
    assert term.sd[0] == pytest.approx(0.5 / np.sqrt(48), rel=0.4)
    assert term.p > 0.003 / 4


def test_whitened_residuals_of_the_truth_are_white():
    _, fit, _ = linearised()
    white = whiten(fit.blocks, fit.residual[:, None], fit.factors)[:, 0]
    assert kstest(white / white.std(), "norm").pvalue > 0.001


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


def test_the_effect_is_the_change_of_the_curve_or_what_is_left_beside_it():
    posterior, fit, _ = linearised()
    k = len(posterior.law.parameters)
    for i in range(2):  # coordinates of slip stiffness and shape
        ahead = posterior.values((fit.z + 0.1 * np.eye(len(fit.z))[i])[None])
        change = np.diff(
            curve_features(THESIS_LAW, np.vstack([fit.values, ahead])[:, :k], fit.blocks), axis=0
        )[0]
        effect = fit.effect(0.1 * step_of(posterior, fit, i))
        assert effect.stiffness == pytest.approx(change[0], abs=0.01)
        assert effect.force == pytest.approx(abs(change[1]), abs=0.01)
    beside = fit.effect(0.5 * (-1.0) ** np.arange(len(fit.blocks)))
    assert beside.force == pytest.approx(0.5 / np.abs(fit.predicted.force).max(), rel=0.1)


def test_how_slip_is_distributed_within_blocks_is_blamed_on_nothing():
    """What a sine wave's distribution changes is absorbed as far as its prior goes, N(0, 1)."""
    posterior, fit, _ = linearised()
    as_sine = predict_blocks(fit.blocks, posterior.law, fit.values[None], sine=True).force[0]
    ripple = (as_sine - fit.predicted.force)[:, None]
    assert np.abs(ripple).max() > 0
    for size in (1.0, 100.0):  # the second as if it had a hundred times the prior's size
        white = whiten(fit.blocks, size * ripple, fit.factors)
        left = fit.project(size * ripple)
        assert np.sum(left**2) <= np.sum(white**2) / (1 + np.sum(white**2) / size**2) * (1 + 1e-9)
    assert fit.spread().shape == fit.z.shape
