# SPDX-License-Identifier: MIT
"""Whichever call of the disk fails: no experiment is completed with a point lost, and all agree."""

import errno
import json
from itertools import count

import pytest

from rig.experiment.sink import RunStart, SinkFailed
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict
from rig.slip_rig.decode import Zero
from support.failing_disks import ERRORS, KINDS, FailingDisk
from zebro_lab.experiment.folder import ExperimentFolder
from zebro_lab.experiment.journal import JOURNAL_FILE, read_journal
from zebro_lab.experiment.points import finished_points
from zebro_lab.recording.devices import profile_text
from zebro_lab.runs.folder import find_runs, read_slip_rig_run
from zebro_lab.runs.manifest import RunManifest, read_manifest


@pytest.fixture
def fails(short, tmp_path, run_command):
    """Return what runs an experiment whose n-th call of a kind fails, and resumes it.

    It returns whether the call came, after it has checked all that the experiment says of itself.
    """

    def run(kind, number, error, **more):
        data = tmp_path / f"{kind}{number}{error}"
        told = "rig", "run", short, "--rig", "sim", "--fast", "--data", data
        with pytest.MonkeyPatch.context() as patch:
            disk = FailingDisk(patch, data, kind, number, error, **more)
            ended = run_command(*told)
        last = (ended.out + ended.err).splitlines()[-1]
        journal = data / JOURNAL_FILE
        lines = journal.read_bytes().split(b"\n") if journal.exists() else [b""]
        events = [json.loads(line) for line in lines[:-1]]
        ends = [each["text"] for each in events if each["kind"] == "end"]
        if ended.code == 0:
            assert last.startswith("completed: 2 points finished")
            assert ends == ["completed"]
            assert finished_points(data, read_journal(data)).numbers == {2, 3}
            assert {read_manifest(run).exit_status for run in find_runs(data)} == {"completed"}
        else:
            assert ended.code == 1
            assert last.startswith("error"), last
            assert "completed" not in (*ends, last)
        again = run_command(*told, *(["--resume"] if events else []))
        assert again.code == 0, again.err
        assert len([r for r in find_runs(data) if read_manifest(r).excluded is None]) == 2
        assert all(not read_slip_rig_run(r).notes for r in find_runs(data)
                   if read_manifest(r).excluded is None)  # fmt: skip
        return disk.failed

    return run


@pytest.mark.parametrize(
    ("kind", "number", "name"),
    [("fsync", 1, "log.mcap"), ("fsync", 2, "log.mcap"), ("write", 3, "log.mcap"),
     ("replace", 4, "run.json"), ("fsync", 1, JOURNAL_FILE), ("write", 7, JOURNAL_FILE)],
)  # fmt: skip
def test_a_disk_that_fails_completes_no_experiment_with_a_point_lost(fails, kind, number, name):
    assert fails(kind, number, errno.EIO, name=name)


def test_a_last_run_whose_end_fails_after_the_plan_is_complete_completes_nothing(
    tmp_path, monkeypatch
):
    profiles = {"rig": ("rig-board-serial", profile_text("rig-board-serial"))}
    manifest = RunManifest(kind="slip-rig", label="x", source="sim:rig", sources={"board": "sim"})
    good = PointVerdict((), 20, 0.05, 0.3, 8.0)
    folder = ExperimentFolder(tmp_path, manifest=manifest, profiles=profiles)
    FailingDisk(monkeypatch, tmp_path, "fsync", 1, name="log.mcap")

    def complete():
        with folder:
            folder.open_run(RunStart(Point(1, 8.0, (0.05,)), 1, 0.0, Zero(0.0, 0.0, 0.0)))
            folder.close_run(good, reason="completed")
            folder.event("end", "completed")

    with pytest.raises(SinkFailed, match="Input/output error"):
        complete()
    point, end = map(json.loads, (tmp_path / JOURNAL_FILE).read_text().splitlines())
    assert not point["accepted"]
    assert "Input/output error" in end["text"]


@pytest.mark.long
@pytest.mark.parametrize("error", ERRORS, ids=errno.errorcode.get)
@pytest.mark.parametrize("kind", KINDS)
def test_no_call_that_fails_loses_a_point_of_a_completed_experiment(fails, kind, error):
    assert next(number for number in count(1) if not fails(kind, number, error)) > 4
