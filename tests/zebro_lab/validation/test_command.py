# SPDX-License-Identifier: MIT
"""`zebro-lab validate` prints errors, bands and what is simulated."""

import json

import pytest

from zebro_lab.validation.predicted_walks import pairs_of_run

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_the_command_prints_a_table_and_says_simulated(walk, tmp_path, run_command):
    prediction, track = pairs_of_run(walk)
    arguments = ["--predicted", prediction, "--track", track, "--out", tmp_path / "out"]
    ended = run_command("validate", *arguments)
    assert ended.code == 0
    printed = ended.out
    assert "SIMULATED" in printed
    assert "no-slip-simple" in printed
    assert "coverage of the 90% band: x " in printed
    assert "predicted uncertainty (NEES)" in printed


def test_json_is_the_manifest_of_the_folder_with_verdict_of_the_source(walk, tmp_path, run_command):
    prediction, track = pairs_of_run(walk)
    arguments = ["--predicted", prediction, "--track", track, "--out", tmp_path / "out"]
    ended = run_command("validate", *arguments, "--json", "--quiet")
    document = json.loads(ended.out)
    assert (ended.code, ended.err) == (0, "")
    assert (document["command"], document["exit_code"], document["simulated"]) == (
        "validate", 0, True,
    )  # fmt: skip
    assert document["validation"] == json.loads((tmp_path / "out" / "manifest.json").read_text())
