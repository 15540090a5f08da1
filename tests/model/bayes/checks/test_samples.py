# SPDX-License-Identifier: MIT
"""What single samples, signs and values tell becomes a finding with its cause, or a note."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import ExcludeRuns
from model.bayes.checks.causes import Cause, Question
from model.bayes.checks.samples import sample_findings
from model.bayes.plain.fit import plain_fit
from model.slip.thesis_curve import THESIS_LAW
from support.linearised_fits import linearised, scaled, sound_sweep, unchanged, with_force

TIME = sound_sweep().samples.time


def wave(amplitude):
    return scaled(lambda _: 1 + amplitude * np.sin(2 * np.pi * 7.0 * TIME))


def means(samples, spoilt=()):
    """Average each run to one row of a table, of which some are off by 1.5 N."""
    n = np.bincount(samples.run)
    slip, load, force = (
        np.bincount(samples.run, values) / n
        for values in (samples.slip, samples.normal_force, samples.traction_force)
    )
    return replace(
        samples, slip=slip, normal_force=load, run=np.arange(len(n)), time=None,
        traction_force=force + 1.5 * np.isin(np.arange(len(n)), spoilt),
    )  # fmt: skip


def found_in(change=unchanged, moved=0.0, **more):
    """Return findings of changed samples, with a coordinate of the centre moved, and notes."""
    posterior, fit, samples = linearised(change, **more)
    priors = {p.name: posterior.priors[p.name] for p in THESIS_LAW.parameters}
    plain = plain_fit(
        samples, THESIS_LAW, priors=priors, zero_sd=0.003, rng=np.random.default_rng(1)
    )
    friction = [p.name for p in posterior.free].index("friction")
    fit = replace(fit, z=fit.z + moved * np.eye(len(fit.z))[friction])
    findings, notes = sample_findings(posterior, fit, samples, plain)
    return [each for each in findings if each.real], notes


def held(samples):
    """Repeat each first value of 50 samples in every other run."""
    first = 50 * (np.arange(len(samples)) // 50)
    kept = np.where(samples.run % 2, first, np.arange(len(samples)))
    return replace(samples, traction_force=samples.traction_force[kept])


PLANTED = {
    Cause.FORCE_SCALE: (scaled(lambda s: np.where(s.run % 9 == 3, -1, 1)), "opposes the slip in 5"),
    Cause.OUTLIERS: (
        with_force(lambda s: 4.0 * (np.arange(len(s)) % 37 == 20)), "samples are off by about 4",
    ),
    Cause.SATURATION: (
        lambda s: replace(s, traction_force=np.clip(s.traction_force, -3, 3)), "are exactly 3 N",
    ),
    Cause.FROZEN: (held, "repeat the value before"),
    Cause.STICK_SLIP: (wave(0.4), "7 Hz"),
}  # fmt: skip


@pytest.mark.parametrize("cause", PLANTED)
def test_a_planted_fault_is_found_and_its_cause_and_advice_are_named(cause):
    change, text = PLANTED[cause]
    ((best, *_), _) = found_in(change)
    assert best.causes[0] == cause
    assert text in best.text
    assert best.advice.reason.startswith(best.text)


def test_a_sound_rig_has_neither_findings_nor_notes():
    assert found_in() == ([], [])


def test_a_small_oscillation_is_a_note_and_no_finding():
    findings, (note,) = found_in(wave(0.1))
    assert findings == []
    assert "at 7 Hz" in note
    assert "the curve is that of its mean" in note


def test_rows_of_a_table_that_lie_far_out_are_left_out_by_name():
    (outlying,), _ = found_in(lambda s: means(s, spoilt=(7, 20)), length=1)
    names = [sound_sweep().samples.run_names[i] for i in (7, 20)]
    assert outlying.advice == ExcludeRuns(outlying.text, tuple(names))
    assert found_in(means, length=1) == ([], [])


@pytest.mark.parametrize(("moved", "is_found"), [(0.5, False), (6.0, True)])
def test_a_value_far_from_its_prior_is_implausible(moved, is_found):
    findings, _ = found_in(moved=moved)
    assert [each.question for each in findings] == [Question.UNITS] * is_found
    assert all("friction is 0.38, +5." in each.text for each in findings)
