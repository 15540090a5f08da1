# SPDX-License-Identifier: MIT
"""`zebro-lab compare` prints differences with how surely they are."""

import json

import pytest

from support.compared_folders import calibration

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_the_command_prints_probabilities_and_says_simulated(tmp_path, run_command):
    one, other = calibration(tmp_path / "one"), calibration(tmp_path / "other", friction=0.5)
    arguments = ["compare", str(one), str(other), "--out", str(tmp_path / "out")]
    ended = run_command(*arguments)
    assert ended.code == 0
    printed = ended.out
    assert "SIMULATED" in printed
    assert "P(other is larger)" in printed
    assert "100.0% *" in printed


def test_a_curve_is_judged_in_words_and_in_the_document(tmp_path, run_command):
    fitted = calibration(tmp_path / "fitted")
    ended = run_command("compare", fitted, "coulomb:0.6", "--out", tmp_path / "out", "--json")
    place = json.loads(ended.out)["place"]
    assert (place["inside"], place["half_widths"] > 1) == (False, True)
    assert "outside" in ended.err


def test_a_name_that_looks_like_markup_is_shown_as_it_is(tmp_path, run_command):
    one, other = calibration(tmp_path / "[bold]one"), calibration(tmp_path / "[z]b", friction=0.5)
    arguments = ["compare", str(one), str(other), "--out", str(tmp_path / "out")]
    ended = run_command(*arguments)
    assert ended.code == 0
    printed = ended.out
    assert "P([z]b is larger)" in printed
    assert "[bold]one" in printed
