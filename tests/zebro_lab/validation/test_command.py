# SPDX-License-Identifier: MIT
"""`zebro-lab validate` prints errors, bands and what is simulated."""

from zebro_lab.validation.predicted_walks import pairs_of_run


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
