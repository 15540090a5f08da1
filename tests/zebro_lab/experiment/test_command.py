# SPDX-License-Identifier: MIT
"""`zebro-lab rig run` as a person starts, stops and resumes it."""

import subprocess
import sys
import time
from functools import partial
from pathlib import Path

from typer.testing import CliRunner

from rig.experiment.run import RunOutcome
from rig.twins import simulated_rig_devices
from support.logs import events
from zebro_lab.experiment.command import experiment_in_numbers
from zebro_lab.experiment.journal import Journal
from zebro_lab.main import app
from zebro_lab.runs.folder import find_runs


def zebro_lab(*arguments):
    return CliRunner().invoke(app, ["rig", *map(str, arguments)])


def test_a_run_says_what_each_point_is_worth(short, tmp_path):
    result = zebro_lab("run", short, "--rig", "sim", "--fast", "--data", tmp_path / "data")
    assert result.exit_code == 0, result.output
    assert "point-0002 Fn 8 N slip 0.0500 (attempt 1): good" in result.output
    assert "completed: 2 points finished, 0 points failed" in result.output


LATE = """
import sys
from rig.experiment import acquire, run
arm, go, known = acquire.GuardedAcquisition.arm, run._Run.go, set()

def armed(self):
    arm(self)
    known.update(sys.modules)

def gone(self):
    outcome = go(self)
    print("late:", sorted(set(sys.modules) - known))
    return outcome

acquire.GuardedAcquisition.arm, run._Run.go = armed, gone
from zebro_lab.main import app
app(["rig", "run", *sys.argv[1:]])
"""


def test_nothing_is_imported_while_the_discs_turn(short, tmp_path):
    """An import takes up to half a second, in which no watchdog is fed."""
    options = ("--rig", "sim", "--fast", "--data", tmp_path / "data")
    found = subprocess.run([sys.executable, "-c", LATE, short, *options], capture_output=True,
                           text=True, check=True)  # fmt: skip
    assert "late: []" in found.stdout


def test_refused_points_have_an_exit_code_of_their_own(short, tmp_path):
    short.write_text(short.read_text().replace("slip = 0.02   ", "slip = 1e-9   "))
    result = zebro_lab("run", short, "--rig", "sim", "--fast", "--data", tmp_path / "data")
    assert result.exit_code == 3
    assert "2 points failed" in result.output


def test_a_weighing_prints_line_and_prior():
    result = zebro_lab("weigh", "--rig", "sim", "--fast", "--masses", "0.2,1")
    assert result.exit_code == 0, result.output
    assert "[load_cell]" in result.output
    assert zebro_lab("weigh", "--rig", "sim", "--masses", "one").exit_code == 2


def test_a_short_run_in_real_time_takes_its_time(short, tmp_path, monkeypatch):
    patient = partial(simulated_rig_devices, watchdog=3.0)
    monkeypatch.setattr("zebro_lab.experiment.opened_rig.simulated_rig_devices", patient)
    began = time.monotonic()
    options = ["--rig", "rig-odrive-netft@sim", "--data", tmp_path / "data"]
    result = zebro_lab("run", short, "--no-watchdog-proof", *options)
    assert result.exit_code == 0, result.output
    assert time.monotonic() - began > 1.5
    assert "completed: 2 points finished" in result.output


def test_drives_without_a_watchdog_in_time_are_refused_before_motion(short, tmp_path, monkeypatch):
    slow = partial(simulated_rig_devices, watchdog=5.0)
    monkeypatch.setattr("zebro_lab.experiment.opened_rig.simulated_rig_devices", slow)
    result = zebro_lab("run", short, "--rig", "rig-odrive-netft@sim", "--data", tmp_path / "data")
    assert result.exit_code == 1
    assert "axis.config.enable_watchdog" in result.output
    assert not find_runs(tmp_path / "data")


def test_a_proof_that_was_left_out_is_kept_in_journal_and_logs(lab, short, tmp_path):
    data = tmp_path / "data"
    lab.run(short, data, no_watchdog_proof=True)
    told = next(entry for entry in lab.journal(data) if entry["kind"] == "guards off")
    assert "watchdog_proof" in told["text"]
    for run in find_runs(data):
        assert any("guards off: " in text and "watchdog_proof" in text for text in events(run))


def test_streams_that_a_shell_has_closed_are_no_fault(short, tmp_path):
    command = (
        f"{sys.executable} -c 'from zebro_lab.main import main; main()' rig run {short} --rig sim "
        f"--fast --data {tmp_path / 'data'} <&- >&-"
    )
    done = subprocess.run(["sh", "-c", command], stderr=subprocess.PIPE, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_run_that_was_cut_short_has_its_reason_and_no_numbers():
    entry = {"text": "safe stop: SIGTERM", "number": 3, "accepted": False, "attempt": 1,
             "folder": "a"}  # fmt: skip
    journal = Journal("hash", {}, frozenset({"a"}), None, [entry])
    outcome = RunOutcome("safe stop: SIGTERM", 2, (), 1, "real")
    found = experiment_in_numbers(outcome, journal, Path("data"))
    assert not found["simulated"]
    assert found["runs"] == [{
        "name": "a", "point": 3, "attempt": 1, "accepted": False, "why": "safe stop: SIGTERM",
        "slip_ratio": None, "friction": None, "normal_force_N": None,
    }]  # fmt: skip
