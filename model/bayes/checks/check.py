# SPDX-License-Identifier: MIT
"""One question about a fit: its answer (yes, no, or not testable) with one number and its limit."""

from dataclasses import dataclass
from enum import StrEnum

from model.bayes.advice import Advice


class Outcome(StrEnum):
    """Answer to a question that is yes for sound data."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_TESTABLE = "not testable with these data"


@dataclass(frozen=True)
class Check:
    """A question about a fit, answered.

    Attributes:
        name: The question, as text.
        outcome: Whether the answer is yes, no, or these data cannot tell.
        evidence: The number that decides and its limit, or why these data cannot tell, as text.
        advice: What to do where the answer is not yes, the most useful first.
        untested: What a headline calls that which these data cannot tell; empty otherwise.
    """

    name: str
    outcome: Outcome
    evidence: str
    advice: tuple[Advice, ...] = ()
    untested: str = ""

    @property
    def failed(self) -> bool:
        """Whether the question could be answered and the answer is no."""
        return self.outcome is Outcome.FAILED


def decided(name: str, holds: bool, evidence: str, *advice: Advice) -> Check:
    """Return a question that these data answer.

    Args:
        name: The question.
        holds: Whether the answer is yes.
        evidence: The number that decides, and its limit.
        advice: What to do where it is no.
    """
    if holds:
        return Check(name, Outcome.PASSED, evidence)
    return Check(name, Outcome.FAILED, evidence, advice)


def not_testable(name: str, why: str, *advice: Advice, untested: str) -> Check:
    """Return a question that these data cannot answer.

    Args:
        name: The question.
        why: Why not, as text.
        advice: What to measure so that it can be answered.
        untested: What a headline calls it.
    """
    return Check(name, Outcome.NOT_TESTABLE, why, advice, untested)
