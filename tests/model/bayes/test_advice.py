# SPDX-License-Identifier: MIT
"""Advice holds lines, commands and options that can be used as they stand."""

import tomllib

import numpy as np
import pytest

from model.bayes.advice import (
    SECONDS,
    SHORT,
    beyond_the_peak,
    exclude_runs,
    measure_slips,
    try_laws,
    zero_before_each,
)
from model.slip.definition import SlipDefinition, convert_slip
from model.slip.laws import LAWS

LOADS = np.array([5.0, 10.0])
SLIPS = np.array([0.01, 0.03, 0.2])


def plan_in(advice: str) -> dict:
    """Parse the lines of a plan in advice, which are between its first and its last line."""
    return tomllib.loads("\n".join(advice.splitlines()[1:-1]))


def test_further_slips_are_lines_of_a_plan_and_are_fitted_with_the_others():
    advice = measure_slips("x", loads=LOADS, slips=SLIPS, definition=SlipDefinition.MATERIAL)
    plan = plan_in(advice)
    assert plan["points"]["loads"] == list(LOADS)
    np.testing.assert_allclose(plan["points"]["slips"], SLIPS, rtol=0.06)
    assert plan["points"]["duration"] == SECONDS
    assert plan["controls"]["tare_every"] == len(SLIPS)
    assert "calibrate-slip DATA FURTHER" in advice.splitlines()[-1]


@pytest.mark.parametrize("definition", SlipDefinition)
def test_slips_of_a_plan_are_material_whatever_was_fitted(definition):
    slips = convert_slip(SLIPS, SlipDefinition.MATERIAL, definition)
    advice = measure_slips("x", loads=LOADS, slips=slips, definition=definition)
    np.testing.assert_allclose(plan_in(advice)["points"]["slips"], SLIPS, rtol=0.06)


@pytest.mark.parametrize("definition", SlipDefinition)
def test_a_slip_that_no_rig_can_hold_becomes_the_largest_that_it_can(definition):
    advice = measure_slips("x", loads=LOADS, slips=np.array([-3.0, 3.0]), definition=definition)
    assert min(plan_in(advice)["points"]["slips"]) > -10.1
    assert max(plan_in(advice)["points"]["slips"]) <= 1.0


def test_short_runs_have_a_zero_each_and_are_fitted_alone():
    advice = zero_before_each("x")
    assert plan_in(advice)["points"]["duration"] == SHORT
    assert plan_in(advice)["controls"]["tare_every"] == 1
    assert "calibrate-slip FURTHER" in advice.splitlines()[-1]


@pytest.mark.parametrize("law", LAWS)
def test_every_other_law_is_offered_and_load_sensitivity_to_the_law_that_has_it(law):
    advice = try_laws("x", law, both_signs=False)
    assert {name for name in LAWS if f"--law {name}" in advice} == set(LAWS) - {law}
    assert ("--load-sensitivity" in advice) == (law == "magic-formula")
    assert "driving and braking" not in advice
    assert "driving and braking apart" in try_laws("x", law, both_signs=True)


def test_each_run_that_is_left_out_has_its_command():
    lines = exclude_runs("x", ["one", "two"]).splitlines()
    assert lines[1:] == [f"zebro-lab exclude DATA/{run} --why REASON" for run in ("one", "two")]


def test_slips_beyond_the_peak_begin_at_it_and_take_the_side_of_the_data():
    peaks = np.array([0.03, 0.06])
    slips = beyond_the_peak(peaks, np.array([0.001, 0.06]))
    assert slips[0] == pytest.approx(0.03)
    assert slips[-1] == pytest.approx(0.24)
    np.testing.assert_allclose(beyond_the_peak(peaks, np.array([-0.06])), -slips)


def test_without_a_peak_slips_go_on_from_the_largest_tested():
    slips = beyond_the_peak(np.array([np.inf]), np.array([0.01, 0.1]))
    assert slips[0] == pytest.approx(0.1)
    assert slips[-1] == pytest.approx(0.4)
