# SPDX-License-Identifier: MIT
"""Runs are listed and excluded from the command line, with their reasons."""

import os
import time

import pytest

from model import file_lock
from support.recorders import count_in, recorder, some, until
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


@pytest.mark.parametrize("ahead", [-3600, 0, 3600])
def test_a_run_that_is_being_recorded_is_not_excluded_whatever_a_clock_says(
    tmp_path, run_command, monkeypatch, ahead
):
    here = time.time()
    monkeypatch.setattr(time, "time", lambda: here + ahead)
    with recorder(tmp_path) as run:
        run.write("legs", some(0, 10))
        until(lambda: count_in(run) == 10)
        before = (run.folder / "run.json").read_text()
        for undo in ((), ("--undo",)):
            refused = run_command("exclude", run.folder, "--why", "belt slipped", *undo)
            assert refused.code == 1
        assert "is being recorded; end the recording first" in (
            run_command("exclude", run.folder, "--why", "belt slipped").err
        )
        assert (run.folder / "run.json").read_text() == before
        assert "  recording  " in run_command("runs", tmp_path).out
    assert run_command("exclude", run.folder, "--why", "belt slipped").code == 0
    assert read_manifest(run.folder).excluded == {"why": "belt slipped"}


def test_a_run_is_excluded_as_soon_as_its_recorder_is_dead(tmp_path, run_command):
    folder = make_run(tmp_path)
    edit(folder, exit_status="recording", stop=None)
    os.utime(folder / "log.mcap", (time.time() + 3600,) * 2)
    assert "  recovered  " in run_command("runs", tmp_path).out
    assert run_command("exclude", folder, "--why", "belt slipped").code == 0


def test_without_locks_the_age_of_the_log_tells(tmp_path, run_command, monkeypatch):
    monkeypatch.setattr(file_lock, "fcntl", None)
    folder = make_run(tmp_path)
    edit(folder, exit_status="recording", stop=None)
    assert run_command("exclude", folder, "--why", "belt slipped").code == 1
    os.utime(folder / "log.mcap", (0, 0))
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
