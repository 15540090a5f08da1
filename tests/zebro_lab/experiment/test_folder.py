# SPDX-License-Identifier: MIT
"""Each point is a run folder; a disk that fails stops the experiment."""

import json

import pytest

from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.errors import RigError
from rig.experiment.sink import SinkFailed
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.experiment.folder import ExperimentFolder
from zebro_lab.runs.folder import find_runs
from zebro_lab.runs.manifest import read_manifest


def test_each_point_is_a_run_that_a_calibration_reads(lab, plan, tmp_path):
    data = tmp_path / "data"
    outcome = lab.run(plan, data)
    assert outcome.completed
    found = read_rig_data([data])
    assert found.samples.n_runs == 6
    assert found.source == "sim:rig"
    for index in range(6):
        chosen = found.samples.run == index
        expected = THESIS_LAW.force(
            found.samples.slip[chosen], found.samples.normal_force[chosen], THESIS_VALUES
        )
        assert found.samples.traction_force[chosen].mean() == pytest.approx(
            expected.mean(), abs=0.3
        )
    assert lab.journal(data)[-1]["text"] == "completed"
    assert not (data / "control.json").exists()


def test_a_run_keeps_raw_counts_profile_and_zero(lab, plan, tmp_path):
    data = tmp_path / "data"
    lab.run(plan, data)
    manifest = read_manifest(find_runs(data)[0])
    assert manifest.profiles == {"rig": "rig-board-serial"}
    assert {"zero_normal", "zero_traction", "radius_leg", "radius_ground"} <= set(
        manifest.constants
    )
    assert manifest.label.startswith("point-0002 Fn 4 N slip 0.0200")
    assert "magic-formula" in json.dumps(dict(manifest.truth))


def test_refused_attempts_are_kept_and_left_out(lab, plan, tmp_path):
    plan.write_text(plan.read_text().replace("slip = 0.02   ", "slip = 1e-9   "))
    outcome = lab.run(plan, tmp_path / "data")
    assert len(outcome.refused) == 6
    runs = find_runs(tmp_path / "data")
    assert len(runs) == 18
    assert all("off its set-point" in read_manifest(r).excluded["why"] for r in runs)


def test_a_full_disk_stops_and_the_journal_says_why(lab, plan, tmp_path, monkeypatch):
    def full(self, least):
        raise SinkFailed("room for data is 0 MB; its limit is 100 MB")

    data, filled = tmp_path / "data", []

    def fill():
        filled.append(monkeypatch.setattr(ExperimentFolder, "require_room", full))

    with pytest.raises(SinkFailed, match="room for data is 0 MB"):
        lab.run(plan, data, watcher=lab.StopAfter(2, fill))
    assert "room for data is 0 MB" in lab.journal(data)[-1]["text"]
    monkeypatch.undo()
    assert lab.run(plan, data, resume=True).finished == 6


def test_a_disk_that_fails_while_writing_stops(lab, plan, tmp_path, monkeypatch):
    def fail(self, stream, samples):
        raise OSError(28, "No space left on device")

    def plant():
        monkeypatch.setattr("zebro_lab.recording.recorder.RunRecorder.write", fail)

    with pytest.raises(RigError, match="No space left on device"):
        lab.run(plan, tmp_path / "data", watcher=lab.StopAfter(1, plant))
