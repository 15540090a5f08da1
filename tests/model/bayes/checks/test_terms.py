# SPDX-License-Identifier: MIT
"""Each term is found where it was planted, with its size, before any other."""

from dataclasses import replace

import pytest

from model.bayes.advice import CorrectData, TryDefinition, ZeroBeforeEach
from model.bayes.checks.terms import LOAD, SIDES, TIME, ZERO, find
from support.linearised_fits import linearised, with_force


def elapsed(samples):
    return samples.run / (samples.n_runs - 1)


PLANTED = {
    "force in proportion to load": (
        ZERO, with_force(lambda s: -0.03 * s.normal_force), -0.03, CorrectData,
    ),
    "shift of slip": (
        ZERO, lambda s: replace(s, slip=s.slip - 0.003 * (1 - s.slip)), 0.003, CorrectData,
    ),
    "driving and braking": (
        SIDES,
        lambda s: replace(s, traction_force=s.traction_force * (1 - 0.08 * (s.slip < 0))),
        0.04, CorrectData,
    ),
    "slip definition": (SIDES, lambda s: replace(s, slip=s.slip + s.slip**2), -1.0, TryDefinition),
    "friction over load": (
        LOAD,
        lambda s: replace(s, traction_force=s.traction_force * (s.normal_force / 7) ** -0.1),
        -0.1, CorrectData,
    ),
    "zero lost with time": (TIME, with_force(lambda s: 0.5 * elapsed(s)), 0.25, ZeroBeforeEach),
    "changing friction": (
        TIME,
        lambda s: replace(s, traction_force=s.traction_force * (1.05 - 0.1 * elapsed(s))),
        -0.05, CorrectData,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_term_is_found_first_with_its_size_and_its_advice(name):
    family, change, size, advice = PLANTED[name]
    _, fit, _ = linearised(change)
    best = find(fit, family)[0]
    assert best.name == name
    assert best.term.p < 1e-4
    assert best.term.size == pytest.approx(size, rel=0.35)
    assert isinstance(best.advice, advice)
    assert best.advice.reason == best.text


@pytest.mark.parametrize("family", [ZERO, SIDES, LOAD, TIME])
def test_nothing_is_found_where_nothing_was_planted(family):
    _, fit, _ = linearised()
    assert all(each.term.p > 1e-3 for each in find(fit, family))


def test_an_error_that_the_fit_estimates_is_found_only_beyond_what_the_rig_may_have():
    usual, far = (
        linearised(
            lambda s, e=e: replace(s, slip=s.slip - e * (1 - s.slip)),
            fixed={},
            found={"radius_error": -e, "rolling_resistance": 0.0},
        )[1]
        for e in (0.01, 0.05)  # its prior's standard deviation is 0.01
    )
    assert all(each.term.p > 0.01 for each in find(usual, ZERO))
    assert find(far, ZERO)[0].name == "shift of slip"
