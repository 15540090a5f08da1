# SPDX-License-Identifier: MIT
"""A killed experiment is resumed so that each point is measured exactly once."""

import subprocess
import sys
from collections import Counter

import pytest

from zebro_lab.experiment.journal import JOURNAL_FILE
from zebro_lab.files.errors import SettingsError
from zebro_lab.runs.folder import find_runs
from zebro_lab.runs.manifest import MANIFEST_FILE, read_manifest

KILLED_BEFORE_A_POINTS_LINE = """
import os, signal, sys
from zebro_lab.experiment.journal import JournalWriter
append, left = JournalWriter.append, [int(sys.argv.pop(1))]

def killed(self, kind, text, **more):
    if kind == "point":
        left[0] -= 1
        if left[0] == 0:
            os.kill(os.getpid(), signal.SIGKILL)
    return append(self, kind, text, **more)

JournalWriter.append = killed
from zebro_lab.main import main
main()
"""


def killed_run(plan, data, *, at):
    """Run a plan in a process that is killed between a run's end record and its journal line."""
    arguments = ["rig", "run", str(plan), "--rig", "sim", "--fast", "--data", str(data)]
    done = subprocess.run(
        [sys.executable, "-c", KILLED_BEFORE_A_POINTS_LINE, str(at), *arguments],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == -9, done.stdout + done.stderr


def counted(data):
    """Count the runs that a calibration takes, by the label of their point."""
    manifests = [read_manifest(run) for run in find_runs(data)]
    return Counter(m.label.partition(" attempt")[0].partition(" again")[0]
                   for m in manifests if m.excluded is None)  # fmt: skip


def test_a_point_killed_before_its_journal_line_is_counted_once(lab, plan, tmp_path):
    data = tmp_path / "data"
    killed_run(plan, data, at=3)
    assert lab.run(plan, data, resume=True).finished == 6
    assert sorted(counted(data).values()) == [1] * 6


def test_points_of_another_rig_are_not_taken_for_points_of_this_one(lab, plan, tmp_path):
    data = tmp_path / "data"
    killed_run(plan, data, at=3)
    for run in find_runs(data):
        file = run / MANIFEST_FILE
        file.write_text(file.read_text().replace('"sim:rig"', '"real"'))
    journal = (data / JOURNAL_FILE).read_bytes()
    with pytest.raises(SettingsError, match=r"measured on 'real', and this rig is 'sim:rig'"):
        lab.run(plan, data, resume=True)
    assert (data / JOURNAL_FILE).read_bytes() == journal


def test_a_refused_attempt_killed_before_its_journal_line_is_not_counted(
    lab, plan, tmp_path, monkeypatch
):
    plan.write_text(plan.read_text().replace("slip = 0.02   ", "slip = 1e-9   "))
    data = tmp_path / "data"
    killed_run_at_exclusion(plan, data)
    assert not counted(data)


def killed_run_at_exclusion(plan, data):
    """Run a plan in a process that is killed right after the first run's end record."""
    code = """
import os, signal
from zebro_lab.recording import run_files
write = run_files.write_manifest

def killed(folder, manifest):
    write(folder, manifest)
    if manifest.exit_status != "recording":
        os.kill(os.getpid(), signal.SIGKILL)

run_files.write_manifest = killed
from zebro_lab.main import main
main()
"""
    arguments = ["rig", "run", str(plan), "--rig", "sim", "--fast", "--data", str(data)]
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == -9, done.stdout + done.stderr


def test_a_damaged_run_does_not_keep_an_experiment_from_going_on(lab, plan, tmp_path):
    from rig.experiment.control import Control
    from rig.safety import StopCategory

    data, control = tmp_path / "data", Control()
    stop = lab.StopAfter(3, lambda: control.stop.request(StopCategory.SAFE, "planted"))
    lab.run(plan, data, watcher=stop, control=control)
    (find_runs(data)[1] / MANIFEST_FILE).write_text("{ not JSON")
    foreign = data / "20200101T000000Z_slip-rig_foreign"
    foreign.mkdir()
    (foreign / MANIFEST_FILE).write_text("[1, 2]")
    outcome = lab.run(plan, data, resume=True)
    assert (outcome.finished, outcome.attempts) == (6, 4)  # the damaged point is measured again


def test_an_experiment_has_one_owner(lab, plan, tmp_path):
    data, refused = tmp_path / "data", []

    def second():
        with pytest.raises(OSError, match=r"is in use by process \d+") as found:
            lab.run(plan, data, resume=True)
        refused.append(str(found.value))

    assert lab.run(plan, data, watcher=lab.StopAfter(2, second)).completed
    assert "experiment" in refused[0]
    assert lab.run(plan, data, resume=True).attempts == 0  # and afterwards it is free
