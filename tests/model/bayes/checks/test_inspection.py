# SPDX-License-Identifier: MIT
"""What is wrong with data is named, or the two causes that cannot be told apart."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.check import Outcome
from model.bayes.checks.inspection import CROSSING, ONE_CURVE, STEADY, TERMS, inspect
from support.linearised_fits import CHOICE, linearised, unchanged, with_force


def inspected(change=unchanged):
    return inspect(*linearised(change), CHOICE)


def check_named(name, found):
    (check,) = [each for each in found.checks if each.name == name]
    return check


def only(samples, chosen):
    """Keep the samples of some runs."""
    run = np.cumsum(np.append(0, np.diff(samples.run[chosen]) > 0))
    return replace(
        samples, slip=samples.slip[chosen], normal_force=samples.normal_force[chosen],
        traction_force=samples.traction_force[chosen], run=run, time=samples.time[chosen],
        run_names=tuple(f"run {i}" for i in range(run[-1] + 1)),
    )  # fmt: skip


def test_a_sound_rig_has_nothing_to_suspect():
    found = inspected()
    assert {check.outcome for check in found.checks} == {Outcome.PASSED}
    assert {*TERMS} < {check.name for check in found.checks}


def test_a_shift_of_slip_is_named_before_what_follows_from_it():
    found = inspected(lambda s: replace(s, slip=s.slip - 0.003 * (1 - s.slip)))
    assert check_named(CROSSING, found).failed
    assert found.suspected[0].name == "shift of slip"
    assert "radii" in check_named(CROSSING, found).cause


def test_at_one_load_a_constant_force_and_one_of_the_load_cannot_be_told_apart():
    found = inspected(lambda s: only(replace(s, traction_force=s.traction_force - 0.3), s.run < 24))
    assert {each.name for each in found.suspected} == {
        "constant force", "force in proportion to load",
    }  # fmt: skip


def test_a_gain_by_direction_that_rolling_resistance_could_hide_is_untested():
    found = inspect(*linearised(fixed={}), CHOICE)
    check = check_named(ONE_CURVE, found)
    assert check.outcome is Outcome.NOT_TESTABLE
    assert check.untested.startswith("driving and braking alike (a difference of ")
    assert "weigh the load cell in both directions" in check.advice.step
    assert check_named(ONE_CURVE, inspected()).passed  # no rolling resistance is allowed for


def test_a_gain_by_direction_that_nothing_hides_is_a_failure_all_the_same():
    uneven = with_force(lambda s: 0.4 * np.maximum(s.traction_force, 0.0))
    check = check_named(ONE_CURVE, inspect(*linearised(uneven, fixed={}), CHOICE))
    assert check.failed
    assert "driving forces are" in check.cause


def test_slip_of_one_sign_tests_neither_the_crossing_nor_both_sides():
    found = inspected(lambda s: only(s, s.run % 12 >= 6))
    for name in (CROSSING, ONE_CURVE):
        assert check_named(name, found).untested == "zero of slip and force (slip of one sign)"


@pytest.mark.parametrize(("runs", "why"), [(1, "one run"), (2, "two runs"), (3, "3 runs")])
def test_a_few_runs_do_not_show_what_changes_with_time(runs, why):
    found = inspected(lambda s: only(s, s.run < runs))
    assert check_named(STEADY, found).untested == f"repeatability ({why})"


def test_a_drift_is_found_however_it_goes():
    found = inspected(with_force(lambda s: 0.6 * s.run / 47))
    assert check_named(STEADY, found).failed
    assert "drifts by" in found.suspected[0].text
