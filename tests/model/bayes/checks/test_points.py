# SPDX-License-Identifier: MIT
"""Mean residuals by load and slip are judged together, at the scatter of the runs."""

from dataclasses import replace

import numpy as np
from scipy.stats import kstest

from model.bayes.checks.points import group_residuals
from support.linearised_fits import linearised, unchanged, with_force


def groups_of(change=unchanged, **more):
    return group_residuals(linearised(change, **more)[1])


def test_groups_are_each_load_side_and_quarter_and_agree_with_the_truth():
    found = groups_of()
    assert len(found.mean) == 2 * 2 * 4
    np.testing.assert_allclose(np.unique(found.load), [4.0, 12.0], rtol=0.05)
    assert np.sum(found.slip > 0) == 8
    assert found.p > 0.01
    assert found.share < 0.02


def test_points_beside_the_curve_are_found_and_named():
    found = groups_of(with_force(
        lambda s: 0.6 * ((s.normal_force > 8) & (np.abs(s.slip - 0.1) < 0.07))
    ))  # fmt: skip
    assert found.p < 1e-4
    assert found.share > 0.01
    assert found.worst().startswith("+0.34 ± 0.048 N at slip 0.09 and 12 N and ")


def test_p_values_of_sound_data_are_uniform():
    _, fit, _ = linearised(length=100)
    rng, p = np.random.default_rng(4), []
    for _ in range(200):
        drawn = rng.standard_normal(len(fit.rest))
        p.append(group_residuals(replace(fit, rest=drawn - fit.basis @ (fit.basis.T @ drawn))).p)
    assert kstest(p, "uniform", alternative="greater").pvalue > 0.01


def test_a_scatter_of_runs_is_not_taken_for_a_misfit():
    zeros = np.random.default_rng(6).normal(0.0, 0.5, 48)
    found = groups_of(with_force(lambda s: zeros[s.run]))
    assert found.p > 0.01
    assert np.median(found.sd) > 3 * np.median(groups_of().sd)
