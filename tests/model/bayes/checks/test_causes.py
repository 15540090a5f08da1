# SPDX-License-Identifier: MIT
"""A finding counts beyond chance and with an effect; one or two causes are named."""

from dataclasses import replace

import pytest

from model.bayes.advice import Advice
from model.bayes.checks.causes import Cause, Effect, Finding, Question, likely, named

FOUND = Finding(
    Question.SLIP, (Cause.SLIP_ZERO,), "text", 100.0, 1e-6, Effect(0.1, 0.0), Advice("do")
)


@pytest.mark.parametrize(
    ("p", "effect", "real"),
    [
        (0.002, Effect(-0.06, 0.0), True),
        (0.002, Effect(0.0, -0.012), True),
        (1e-30, Effect(0.04, 0.009), False),
        (0.004, Effect(0.5, 0.5), False),
    ],
)
def test_a_finding_is_real_only_beyond_chance_and_with_an_effect(p, effect, real):
    assert replace(FOUND, p=p, effect=effect).real == real


@pytest.mark.parametrize(
    ("gains", "n"), [((100.0, 39.0), 1), ((100.0, 41.0), 2), ((12.0, 4.0), 2), ((50.0, 45.0), 2)]
)
def test_a_rival_is_kept_that_explains_nearly_as_much(gains, n):
    found = [replace(FOUND, gain=gain) for gain in gains]
    assert [each.gain for each in likely(reversed(found))] == list(gains[:n])


def test_what_is_no_finding_is_not_likely_however_much_it_explains():
    assert likely([replace(FOUND, effect=Effect(0.0, 0.0)), replace(FOUND, p=0.1)]) == ()


def test_at_most_two_causes_are_named_and_a_rival_comes_before_the_other_reading_of_the_best():
    second = replace(FOUND, causes=(Cause.DEFINITION, Cause.LAW))
    assert named([FOUND]) == (Cause.SLIP_ZERO,)
    assert named([FOUND, FOUND]) == (Cause.SLIP_ZERO,)
    assert named([second]) == (Cause.DEFINITION, Cause.LAW)
    assert named([second, FOUND, FOUND]) == (Cause.DEFINITION, Cause.SLIP_ZERO)
    assert named([]) == ()
