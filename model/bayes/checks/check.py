# SPDX-License-Identifier: MIT
"""One check of a fit: the claim, its outcome (passed, failed, not testable) and the evidence."""

from dataclasses import dataclass
from enum import StrEnum

from model.bayes.advice import Advice


class Outcome(StrEnum):
    """Outcome of a check."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_TESTABLE = "not testable with these data"


@dataclass(frozen=True)
class Check:
    """One check of a fit.

    Attributes:
        name: Claim that is checked, as text.
        outcome: Whether the claim holds, does not, or cannot be tested with these data.
        evidence: Measured value and its limit, or why these data cannot test the claim, as text.
        advice: What to do when the claim does not hold, or to test it; None if there is nothing.
        untested: What a headline calls that which cannot be tested, with the reason in brackets;
            empty unless `outcome` is not testable.
        cause: What a failed check has found to be wrong, as text; empty where it has not.
    """

    name: str
    outcome: Outcome
    evidence: str
    advice: Advice | None = None
    untested: str = ""
    cause: str = ""

    @property
    def passed(self) -> bool:
        """Whether the claim was tested and holds."""
        return self.outcome is Outcome.PASSED

    @property
    def failed(self) -> bool:
        """Whether the claim was tested and does not hold."""
        return self.outcome is Outcome.FAILED


def decided(name: str, holds: bool, evidence: str, advice: Advice | None = None) -> Check:
    """Return a check that the data can make.

    Args:
        name: Claim that is checked.
        holds: Whether it holds.
        evidence: Measured value and its limit.
        advice: What to do when it does not hold.
    """
    return Check(name, Outcome.PASSED if holds else Outcome.FAILED, evidence, advice)


def not_testable(name: str, why: str, *, untested: str, advice: Advice | None = None) -> Check:
    """Return a check that these data cannot make.

    Args:
        name: Claim that is checked.
        why: Why these data cannot test it, as text.
        untested: What a headline calls it, with the reason in brackets.
        advice: What to measure so that it can be tested.
    """
    evidence = f"{Outcome.NOT_TESTABLE}: {why}"
    return Check(name, Outcome.NOT_TESTABLE, evidence, advice, untested)
