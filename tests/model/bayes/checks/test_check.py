# SPDX-License-Identifier: MIT
"""A question is answered with yes, with no and an advice, or by what cannot be told."""

import pytest

from model.bayes.advice import Advice
from model.bayes.checks.check import Outcome, decided, not_testable


@pytest.mark.parametrize("holds", [True, False])
def test_an_answer_has_advice_only_where_it_is_no(holds):
    check = decided("Question?", holds, "1 of 2", Advice("do"))
    assert (check.failed, check.untested) == (not holds, "")
    assert check.advice == (() if holds else (Advice("do"),))


def test_what_data_cannot_tell_is_neither_yes_nor_no():
    check = not_testable("Question?", "one run", Advice("do"), untested="claim (one run)")
    assert check.outcome is Outcome.NOT_TESTABLE
    assert not check.failed
    assert (check.evidence, check.advice) == ("one run", (Advice("do"),))
