# SPDX-License-Identifier: MIT
"""A check passed, failed, or says what cannot be tested."""

import pytest

from model.bayes.advice import Advice
from model.bayes.checks.check import Outcome, decided, not_testable


@pytest.mark.parametrize("holds", [True, False])
def test_a_claim_that_was_tested_holds_or_does_not(holds):
    check = decided("claim", holds, "1 of 2", Advice("do"))
    assert (check.passed, check.failed, check.untested) == (holds, not holds, "")


def test_a_claim_that_was_not_tested_neither_passed_nor_failed():
    check = not_testable("claim", "one run", untested="claim (one run)", advice=Advice("do"))
    assert check.outcome is Outcome.NOT_TESTABLE
    assert not check.passed
    assert not check.failed
    assert check.evidence == "not testable with these data: one run"
    assert check.untested == "claim (one run)"
    assert check.advice == Advice("do")
