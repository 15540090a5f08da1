# SPDX-License-Identifier: MIT
"""What scatters between runs is found with its size, and told from a scatter of another kind."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import CorrectData, ExcludeRuns, TryDefinition, ZeroBeforeEach
from model.bayes.checks.between_runs import scatter_between_runs
from model.bayes.checks.causes import Cause, likely
from support.linearised_fits import STABILITY, linearised, only, scaled, unchanged, with_force

DRAWN = np.random.default_rng(2).standard_normal(48)


def findings(change=unchanged, stability=STABILITY):
    _, fit, _ = linearised(change)
    return tuple(scatter_between_runs(fit, stability))


def size_of(finding) -> float:
    return float(finding.text.split("differ by ")[1].split()[0])


PLANTED = {
    Cause.FORCE_ZERO: (with_force(lambda s: 0.5 * DRAWN[s.run]), 0.5, ZeroBeforeEach),
    Cause.MATERIALS: (scaled(lambda s: np.where(DRAWN[s.run] > 0, 0.7, 1)), 0.15, CorrectData),
    Cause.SLIP_ZERO: (
        lambda s: replace(s, slip=s.slip - 0.005 * DRAWN[s.run] * (1 - s.slip)), 0.005, CorrectData,
    ),
    Cause.DEFINITION: (  # beyond what is linear: its size is not
        lambda s: replace(s, slip=s.slip + 2.0 * np.sign(DRAWN[s.run]) * s.slip**2), None,
        TryDefinition,
    ),
}  # fmt: skip


@pytest.mark.parametrize("cause", PLANTED)
def test_a_planted_scatter_explains_most_with_its_size(cause):
    change, size, advice = PLANTED[cause]
    best = likely(findings(change))[0]
    assert best.causes == (cause,)
    assert size is None or size_of(best) == pytest.approx(size, rel=0.35)
    assert isinstance(best.advice, advice)


def test_a_sound_rig_scatters_in_no_way():
    assert all(each.p > 0.01 for each in findings())


def test_zeros_that_scatter_as_the_load_cell_may_have_no_effect():
    change = PLANTED[Cause.FORCE_ZERO][0]
    (within,) = [each for each in findings(change, 0.2) if each.causes == (Cause.FORCE_ZERO,)]
    assert within.p < 1e-6
    assert not within.real


def test_a_few_odd_runs_are_named_to_be_left_out():
    samples = with_force(lambda s: 4.0 * np.isin(s.run, (3, 17)))
    found = [each for each in findings(samples) if each.causes == (Cause.FORCE_ZERO,)]
    assert found[0].real
    _, fit, _ = linearised()
    names = fit.blocks.run_names
    assert found[0].advice == ExcludeRuns(found[0].advice.reason, (names[3], names[17]))


def test_fewer_than_six_runs_show_no_scatter():
    assert findings(lambda s: only(s, np.arange(5))) == ()
