# SPDX-License-Identifier: MIT
"""Two computations of one posterior must agree, within what their draws can show."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import SampleAgain, SampleLonger, SamplePosterior
from model.bayes.checks.check import Outcome
from model.bayes.checks.sampling import convergence_checks, engines
from support.judged_fits import AGREED, CONVERGED


@pytest.mark.parametrize("changes", [{"mean": 0.11}, {"spread": 0.36}])
def test_a_difference_beyond_both_limits_fails(changes):
    check = engines(replace(AGREED, **changes))
    assert check.failed
    assert check.advice == SampleAgain("two computations of the posterior differ")


@pytest.mark.parametrize("changes", [{"mean": 0.11, "mean_error": 0.03},
                                     {"spread": 0.07, "spread_error": 0.02}])  # fmt: skip
def test_a_difference_of_a_few_monte_carlo_errors_is_explained_by_them(changes):
    assert engines(replace(AGREED, **changes)).passed


@pytest.mark.parametrize("changes", [{"pareto_k": 0.7}, {"mean_error": 0.2}, {"spread_error": 0.1}])
def test_a_comparison_that_says_nothing_is_not_silent(changes):
    check = engines(replace(AGREED, **changes))
    assert check.outcome is Outcome.NOT_TESTABLE
    assert check.untested.startswith("second computation (")


def test_every_unmet_rule_of_convergence_is_a_failed_check():
    (good,) = convergence_checks(CONVERGED)
    assert good.passed
    short = replace(CONVERGED, r_hat=np.array([1.1]), length=100)
    found = convergence_checks(short)
    assert [check.failed for check in found] == [True, True]
    assert found[0].advice == SampleLonger(
        "sample longer", 2 * replace(CONVERGED, length=100).moves
    )


def test_weighted_draws_that_nothing_confirms_are_untested_and_asked_to_be_sampled():
    check = engines(None)
    assert check.outcome is Outcome.NOT_TESTABLE
    assert check.untested == "second computation (posterior not sampled)"
    (bad,) = convergence_checks(replace(CONVERGED, pareto_k=0.9))
    assert {type(check.advice), type(bad.advice)} == {SamplePosterior}
