# SPDX-License-Identifier: MIT
"""Whatever part of an experiment fails, the discs stop, and the run does not count as completed."""

import contextlib
import json
import queue
import threading
import time
from contextlib import contextmanager

import pytest

from rig.errors import RigError
from rig.experiment.control import Control
from rig.experiment.sink import SinkFailed
from rig.experiment.supervision import supervised
from zebro_lab.experiment import folder as experiment_folder
from zebro_lab.experiment.folder import ExperimentFolder
from zebro_lab.experiment.journal import JOURNAL_FILE, JournalWriter
from zebro_lab.runs.folder import find_runs
from zebro_lab.runs.manifest import RunManifest, read_manifest

PATIENCE = 30.0
"""Longest time that a run of the small plan may take on a busy machine [s]."""


def fail_once(append, kind):
    """Make a journal's append that raises at the first event of a kind."""
    planted = []

    def failing(self, found, text, **more):
        if found == kind and not planted:
            planted.append(found)
            raise RuntimeError("planted")
        return append(self, found, text, **more)

    return failing


def ends(data):
    lines = (data / JOURNAL_FILE).read_bytes().split(b"\n")
    entries = [json.loads(line) for line in lines if line]
    return [entry["text"] for entry in entries if entry["kind"] == "end"]


@pytest.mark.timeout(PATIENCE, method="signal")
def test_whatever_ends_the_writer_stops_the_experiment(lab, plan, tmp_path, monkeypatch):
    monkeypatch.setattr(JournalWriter, "append", fail_once(JournalWriter.append, "note"))
    data, control = tmp_path / "data", Control()
    note = lab.StopAfter(2, lambda: control.execute("note hello", who="test"))
    with pytest.raises(SinkFailed, match="RuntimeError: planted"):
        lab.run(plan, data, watcher=note, control=control)
    assert "RuntimeError: planted" in ends(data)[-1]
    assert 2 <= len(find_runs(data)) < 6
    assert all(read_manifest(run).exit_status != "recording" for run in find_runs(data))


@pytest.mark.timeout(PATIENCE, method="signal")
def test_a_run_whose_opening_met_a_failure_is_ended(lab, plan, tmp_path, monkeypatch):
    enter = ExperimentFolder._enter

    def fail_then(self, description):
        recorder = enter(self, description)
        self._fail(RuntimeError("planted"))
        return recorder

    monkeypatch.setattr(ExperimentFolder, "_enter", fail_then)
    data = tmp_path / "data"
    with pytest.raises(SinkFailed, match="RuntimeError: planted"):
        lab.run(plan, data)
    assert "RuntimeError: planted" in ends(data)[-1]
    (run,) = find_runs(data)
    assert read_manifest(run).exit_status != "recording"


class WaitsOn(Exception):
    """Nothing has come of a wait for far too long."""


@contextmanager
def folder_without_writer(data, monkeypatch, *, in_step):
    """Make an experiment's folder whose writing thread has ended by itself."""
    get = queue.Queue.get

    def fail(self, *args, **kwargs):
        if threading.current_thread().name == "writer":
            raise MemoryError("planted")
        return get(self, *args, **kwargs)

    monkeypatch.setattr(queue.Queue, "get", fail)
    manifest = RunManifest(kind="slip-rig", label="test", source="sim:rig")
    with (
        supervised(Control()),
        ExperimentFolder(data, manifest=manifest, profiles={}, in_step=in_step) as folder,
    ):
        folder._thread.join(PATIENCE)
        assert not folder._thread.is_alive()
        yield folder


def test_the_journal_says_how_it_ended_although_the_writer_is_dead(tmp_path, monkeypatch):
    with (
        contextlib.suppress(SinkFailed),
        folder_without_writer(tmp_path, monkeypatch, in_step=False) as folder,
    ):
        folder.event("end", "writer failed")
    assert ends(tmp_path) == ["writer failed"]


def test_nobody_waits_for_a_writer_that_is_dead(tmp_path, monkeypatch):
    with (
        contextlib.suppress(SinkFailed),  # which leaving the folder raises too
        folder_without_writer(tmp_path, monkeypatch, in_step=True) as folder,
    ):
        require_well, looks = folder._require_working, iter(range(20))

        def look():
            if next(looks, None) is None:
                raise WaitsOn
            require_well()

        monkeypatch.setattr(folder, "_require_working", look)
        with pytest.raises(SinkFailed, match="the thread that writes has ended unexpectedly"):
            folder.close_run(None, reason="failed")
        monkeypatch.undo()


@pytest.mark.timeout(PATIENCE, method="signal")
def test_a_note_of_undecodable_bytes_is_kept_and_stops_nothing(lab, plan, tmp_path):
    data, control = tmp_path / "data", Control()
    typed = b"note caf\xe9".decode("utf-8", "surrogateescape")
    note = lab.StopAfter(2, lambda: control.execute(typed, who="keyboard"))
    assert lab.run(plan, data, watcher=note, control=control).completed
    assert b"caf" in (data / JOURNAL_FILE).read_bytes()


@pytest.mark.timeout(PATIENCE, method="signal")
def test_a_thread_that_cannot_be_started_stops_the_experiment(lab, plan, tmp_path, monkeypatch):
    start = threading.Thread.start

    def refuse(self):
        if self.name == "recorder":
            raise RuntimeError("can't start new thread")
        start(self)

    def plant():
        monkeypatch.setattr(threading.Thread, "start", refuse)

    data = tmp_path / "data"
    with pytest.raises(SinkFailed, match="can't start new thread"):
        lab.run(plan, data, watcher=lab.StopAfter(1, plant))
    monkeypatch.undo()
    assert "can't start new thread" in ends(data)[-1]
    assert lab.run(plan, data, resume=True).finished == 6


@pytest.mark.timeout(PATIENCE, method="signal")
def test_an_exception_in_any_thread_stops_the_experiment(lab, plan, tmp_path):
    def fail():
        thread = threading.Thread(target=lambda: 1 / 0, name="helper")
        thread.start()
        thread.join()

    data = tmp_path / "data"
    with pytest.raises(RigError, match="helper failed: ZeroDivisionError"):
        lab.run(plan, data, watcher=lab.StopAfter(2, fail))
    assert "helper failed: ZeroDivisionError" in ends(data)[-1]
    assert len(find_runs(data)) < 6


@pytest.mark.timeout(PATIENCE, method="signal")
def test_a_full_queue_cannot_block_the_stop(tmp_path, monkeypatch):
    entered, go_on = threading.Event(), threading.Event()

    def hang(*_, **__):
        entered.set()
        go_on.wait(0.5 * PATIENCE)

    monkeypatch.setattr(JournalWriter, "append", hang)
    monkeypatch.setattr(experiment_folder, "MOST_WAITING", 4)
    monkeypatch.setattr(experiment_folder, "JOIN_LIMIT", 0.2)
    manifest = RunManifest(kind="slip-rig", label="test", source="sim:rig")

    def overfill():
        with ExperimentFolder(tmp_path, manifest=manifest, profiles={}) as folder:
            for number in range(10):
                folder.event("note", str(number))
                assert entered.wait(PATIENCE)

    began = time.monotonic()
    try:
        with pytest.raises(SinkFailed, match="too slow"):
            overfill()
        assert time.monotonic() - began < 0.3 * PATIENCE
    finally:
        go_on.set()
