# SPDX-License-Identifier: MIT
"""Which runs an experiment takes for its own, and what it does to those of others."""

import os
from datetime import UTC, datetime
from pathlib import Path

import pytest

from zebro_lab.experiment.journal import JOURNAL_FILE
from zebro_lab.files.errors import AlreadyExists
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


def killed_recording(data: Path, *, kind: str, label: str) -> Path:
    """Write a run folder that a kill left behind, as `record` leaves one."""
    folder = data / f"20200101T000000Z_{kind}_{label}"
    folder.mkdir(parents=True)
    (folder / LOG_FILE).write_bytes(b"")
    os.utime(folder / LOG_FILE, (0, 0))
    start = datetime(2020, 1, 1, tzinfo=UTC).isoformat()
    write_manifest(folder, RunManifest(
        kind=kind, label=label, material="", operator="", source="sim:x", start=start, stop=None,
        exit_status=RECORDING, software={}, constants={}, streams={},
    ))  # fmt: skip
    return folder


@pytest.mark.parametrize(("kind", "label"), [("walk", "left turn"), ("slip-rig", "by hand")])
def test_recordings_beside_an_experiment_are_left_alone(lab, plan, tmp_path, kind, label):
    data = tmp_path / "data"
    recording = killed_recording(data, kind=kind, label=label)
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
