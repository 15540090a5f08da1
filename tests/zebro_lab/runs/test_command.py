# SPDX-License-Identifier: MIT
"""Runs are listed and excluded from the command line, with their reasons."""

import os

from support.written_runs import edit, make_run
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.runs.manifest import read_manifest


def test_an_exclusion_can_be_undone_and_stays_on_record(tmp_path, run_command):
    folder = make_run(tmp_path)
    assert run_command("exclude", folder, "--why", "belt slipped").code == 0
    assert run_command("exclude", folder, "--undo", "--why", "it was the other").code == 0
    assert read_manifest(folder).excluded is None
    assert len(read_rig_data([tmp_path]).samples) == 200
    assert "completed (was excluded: belt slipped)" in run_command("runs", tmp_path).out
    assert "it was the other" in (folder / "run.json").read_text()
    again = run_command("exclude", folder, "--undo")
    assert again.code == 1
    assert "is not excluded" in again.err


def test_a_run_that_is_being_recorded_is_not_excluded(tmp_path, run_command):
    folder = make_run(tmp_path)
    edit(folder, exit_status="recording", stop=None)
    before = (folder / "run.json").read_text()
    refused = run_command("exclude", folder, "--why", "belt slipped")
    assert refused.code == 1
    assert "is being recorded" in refused.err
    assert (folder / "run.json").read_text() == before
    os.utime(folder / "log.mcap", (0, 0))  # a kill left it behind
    assert run_command("exclude", folder, "--why", "belt slipped").code == 0


def test_bytes_of_a_foreign_encoding_are_kept_as_escapes(tmp_path, run_command):
    folder = make_run(tmp_path, label="caf\udce9", material="\udcff")
    assert run_command("exclude", folder, "--why", "na\udcefve 🤖").code == 0
    manifest = read_manifest(folder)
    assert (manifest.label, manifest.material) == (r"caf\udce9", r"\udcff")
    assert manifest.excluded == {"why": r"na\udcefve 🤖"}


def test_an_exclusion_needs_a_reason(tmp_path, run_command):
    folder = make_run(tmp_path)
    assert run_command("exclude", folder).code == 2
    assert read_manifest(folder).excluded is None


def test_simulated_runs_are_listed_as_such_and_counted(tmp_path, run_command):
    make_run(tmp_path, label="a")
    make_run(tmp_path, label="b", source="real")
    make_run(tmp_path, label="c", source="mixed:real,sim:imu")
    first, second, third, count = run_command("runs", tmp_path).out.splitlines()
    assert first.endswith("_a  completed  0.2 s  200 /board/raw  SIMULATED sim:noise")
    assert second.endswith("_b  completed  0.2 s  200 /board/raw  real")
    assert third.endswith("SIMULATED mixed:real,sim:imu")
    assert count == f"3 runs in {tmp_path}"
