# SPDX-License-Identifier: MIT
"""Which runs an experiment takes for its own, and what it does to those of others."""

import os
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from rig.experiment.control import Control
from rig.safety import StopCategory
from zebro_lab.experiment.journal import JOURNAL_FILE, read_journal
from zebro_lab.experiment.points import finished_points
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.runs.folder import LOG_FILE, find_runs
from zebro_lab.runs.manifest import (
    MANIFEST_FILE,
    RECORDING,
    RunManifest,
    read_manifest,
    write_manifest,
)

POINTS = 6


def manifests(data: Path) -> dict[str, str]:
    return {str(run): (run / MANIFEST_FILE).read_text() for run in find_runs(data)}


def counted(data: Path) -> int:
    return sum(read_manifest(run).excluded is None for run in find_runs(data))


@pytest.mark.parametrize("resume", [False, True])
def test_an_experiment_below_another_is_not_its_own(lab, plan, tmp_path, resume):
    above, below = tmp_path / "data", tmp_path / "data" / "monday"
    assert lab.run(plan, below).completed
    before = manifests(below)
    if resume:
        lab.run(plan, above, watcher=lab.StopAfter(1, lambda: None))
    outcome = lab.run(plan, above, resume=resume)
    assert outcome.finished == POINTS
    assert resume or outcome.attempts == POINTS
    assert manifests(below) == before
    assert counted(above) == 2 * POINTS


def killed_recording(data: Path) -> Path:
    """Write a run folder that a kill left behind, as `record` leaves one."""
    folder = data / "20200101T000000Z_slip-rig_by hand"
    folder.mkdir(parents=True)
    (folder / LOG_FILE).write_bytes(b"")
    start = datetime(2020, 1, 1, tzinfo=UTC).isoformat()
    manifest = RunManifest(kind="slip-rig", label="by hand", source="sim:x", start=start)
    write_manifest(folder, replace(manifest, exit_status=RECORDING))
    return folder


def test_recordings_beside_an_experiment_are_left_alone(lab, plan, tmp_path):
    data = tmp_path / "data"
    recording = killed_recording(data)
    before = manifests(recording)
    assert lab.run(plan, data).finished == POINTS
    assert lab.run(plan, data, resume=True).attempts == 0
    assert manifests(recording) == before


@pytest.mark.parametrize("resume", [False, True])
def test_points_without_their_journal_are_not_measured_over(lab, plan, tmp_path, resume):
    data = tmp_path / "data"
    lab.run(plan, data)
    (data / JOURNAL_FILE).unlink()
    before = manifests(data)
    with pytest.raises(AlreadyExists, match=f"points of an experiment.*{JOURNAL_FILE}"):
        lab.run(plan, data, resume=resume)
    assert manifests(data) == before


def test_the_zero_of_the_latest_run_is_known_to_the_next(lab, plan, tmp_path):
    lab.run(plan, tmp_path)
    zero = finished_points(tmp_path, read_journal(tmp_path)).zero
    stored = read_manifest(find_runs(tmp_path)[-1]).constants
    assert (zero.normal, zero.traction) == (stored["zero_normal"], stored["zero_traction"])


def test_a_run_folder_of_the_journal_that_cannot_exist_is_missing(lab, plan, tmp_path):
    lab.run(plan, tmp_path)
    journal = replace(read_journal(tmp_path), accepted={5000 * "x": 1})
    (notice,) = finished_points(tmp_path, journal).notices
    assert "the run folder is missing" in notice


@pytest.mark.parametrize("damage", ["gone", "empty", "fifo"])
def test_a_point_whose_log_is_lost_is_measured_again(lab, plan, tmp_path, damage):
    data = tmp_path / "data"
    lab.run(plan, data)
    log = find_runs(data)[2] / LOG_FILE
    log.unlink()
    if damage == "empty":
        log.write_bytes(b"")
    elif damage == "fifo":
        os.mkfifo(log)
    said = []
    watcher = lab.StopAfter(99, lambda: None)
    watcher.notice = said.append
    outcome = lab.run(plan, data, resume=True, watcher=watcher)
    assert (outcome.attempts, outcome.finished) == (1, POINTS)
    assert any(LOG_FILE in line and "measured again" in line for line in said)
    assert counted(data) == POINTS


KILLED_BEFORE_A_POINTS_LINE = """
import os, signal
from zebro_lab.experiment.journal import JournalWriter
append, left = JournalWriter.append, [3]

def killed(self, kind, text, **more):
    if kind == "point":
        left[0] -= 1
        if left[0] == 0:
            os.kill(os.getpid(), signal.SIGKILL)
    return append(self, kind, text, **more)

JournalWriter.append = killed
"""
KILLED_AT_AN_EXCLUSION = """
import os, signal
from zebro_lab.recording import run_files
write = run_files.write_manifest

def killed(folder, manifest):
    write(folder, manifest)
    if manifest.exit_status != "recording":
        os.kill(os.getpid(), signal.SIGKILL)

run_files.write_manifest = killed
"""


def killed_run(plan, data, code):
    """Run a plan in a process that is killed between a run's end record and its journal line."""
    arguments = ["rig", "run", str(plan), "--rig", "sim", "--fast", "--data", str(data)]
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\nfrom zebro_lab.main import main\nmain()", *arguments],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == -9, done.stdout + done.stderr


def test_a_point_killed_before_its_journal_line_is_counted_once(lab, plan, tmp_path):
    data = tmp_path / "data"
    killed_run(plan, data, KILLED_BEFORE_A_POINTS_LINE)
    assert lab.run(plan, data, resume=True).finished == POINTS
    counts = [read_manifest(run) for run in find_runs(data)]
    labels = Counter(m.label.partition(" attempt")[0].partition(" again")[0]
                     for m in counts if m.excluded is None)  # fmt: skip
    assert sorted(labels.values()) == [1] * POINTS


def test_a_refused_attempt_killed_before_its_journal_line_is_not_counted(lab, plan, tmp_path):
    plan.write_text(plan.read_text().replace("slip = 0.02   ", "slip = 1e-9   "))
    killed_run(plan, tmp_path / "data", KILLED_AT_AN_EXCLUSION)
    assert not counted(tmp_path / "data")


def stopped_run(lab, plan, data, *, after):
    control = Control()
    stop = lab.StopAfter(after, lambda: control.stop.request(StopCategory.SAFE, "planted"))
    lab.run(plan, data, watcher=stop, control=control)


def test_points_of_another_rig_are_not_taken_for_points_of_this_one(lab, plan, tmp_path):
    data = tmp_path / "data"
    stopped_run(lab, plan, data, after=3)
    for run in find_runs(data):
        file = run / MANIFEST_FILE
        file.write_text(file.read_text().replace('"sim:rig"', '"real"'))
    journal = (data / JOURNAL_FILE).read_bytes()
    with pytest.raises(SettingsError, match=r"measured on 'real', and this rig is 'sim:rig'"):
        lab.run(plan, data, resume=True)
    assert (data / JOURNAL_FILE).read_bytes() == journal


def test_a_damaged_run_does_not_keep_an_experiment_from_going_on(lab, plan, tmp_path):
    data = tmp_path / "data"
    stopped_run(lab, plan, data, after=3)
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
