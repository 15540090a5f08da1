# SPDX-License-Identifier: MIT
"""`zebro-lab compare` prints differences with how surely they are."""

import json

import pytest

from support.compared_folders import calibration

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_the_command_prints_probabilities_says_simulated_and_shows_names_as_they_are(
    tmp_path, run_command
):
    one, other = calibration(tmp_path / "[bold]one"), calibration(tmp_path / "[z]b", friction=0.5)
    ended = run_command("compare", one, other, "--out", tmp_path / "out")
    assert ended.code == 0
    for part in ("SIMULATED", "[bold]one", "P([z]b is larger)", "100.0% *"):
        assert part in ended.out


def test_a_curve_is_judged_in_words_and_in_the_document(tmp_path, run_command):
    fitted = calibration(tmp_path / "fitted")
    ended = run_command("compare", fitted, "coulomb:0.6", "--out", tmp_path / "out", "--json")
    document = json.loads(ended.out)
    assert (document["place"]["inside"], document["place"]["half_widths"] > 1) == (False, True)
    first = document["quantities"][0]
    assert first["first"]["low"] < first["first"]["median"] < first["first"]["high"]
    assert first["second"]["median"] - first["first"]["median"] == pytest.approx(
        first["difference"]["median"], abs=1e-3
    )
    assert "outside" in ended.err
