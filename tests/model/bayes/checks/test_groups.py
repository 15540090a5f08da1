# SPDX-License-Identifier: MIT
"""Mean residuals by load and side are judged together."""

from dataclasses import replace

import numpy as np

from model.bayes.advice import Advice
from model.bayes.checks.groups import group_residuals, groups
from support.linearised_fits import linearised, with_force


def test_groups_are_each_load_and_side_and_agree_with_the_truth():
    _, fit, _ = linearised()
    found = group_residuals(fit)
    assert len(found.mean) == 4
    assert found.driving.tolist() == [False, True, False, True]
    assert found.p > 0.01
    assert groups(fit, Advice("do")).passed


def test_what_one_load_and_side_has_and_the_others_have_not_fails():
    _, fit, _ = linearised(
        with_force(lambda s: np.where((s.normal_force > 8) & (s.slip < 0), 0.3, 0.0))
    )
    check = groups(fit, Advice("do"))
    assert check.failed
    assert "braking" in check.evidence


def test_one_run_does_not_show_how_runs_scatter():
    def first(s):
        chosen = s.run == 0
        return replace(
            s, slip=s.slip[chosen], normal_force=s.normal_force[chosen], run=s.run[chosen],
            traction_force=s.traction_force[chosen], run_names=s.run_names[:1],
            time=s.time[chosen],
        )  # fmt: skip

    check = groups(linearised(first)[1], Advice("do"))
    assert check.untested == "repeatability (one run)"


def test_large_slips_are_judged_on_their_own():
    _, fit, _ = linearised(with_force(lambda s: 0.3 * (np.abs(s.slip) > 0.3)))
    assert group_residuals(fit, outer=True).p < 1e-4
    assert group_residuals(fit, outer=True).p < group_residuals(fit).p


def test_many_small_means_of_one_sign_count_together():
    _, fit, _ = linearised(with_force(lambda s: -0.06 * np.ones(len(s))))
    found = group_residuals(fit)
    assert np.all(np.abs(found.mean / found.sd) < 8)
    assert found.p < 0.01
