# SPDX-License-Identifier: MIT
"""Each term is found where it was planted, with its size, before any other."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import CorrectData, TryDefinition, ZeroBeforeEach
from model.bayes.checks.terms import LOAD, SIDES, TIME, ZERO, find, slip_of_a_wrong_radius
from model.slip.definition import SlipDefinition, convert_slip, slip_ratio
from support.linearised_fits import linearised, sound_sweep, with_force


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


@pytest.mark.parametrize("definition", SlipDefinition)
def test_slip_of_a_wrong_radius_is_the_derivative_of_slip_by_the_ground_speed(definition):
    slip = np.array([-0.4, -0.05, 0.05, 0.5])
    material = convert_slip(slip, definition, SlipDefinition.MATERIAL)
    ground, e = 1 - material, 1e-6
    moved = slip_ratio(np.ones(4), ground * (1 - e), definition)
    np.testing.assert_allclose(
        (moved - slip) / e, slip_of_a_wrong_radius(slip, definition), rtol=1e-4
    )


def test_the_sweep_behind_these_is_sound():
    assert sound_sweep().samples.n_runs == 48
