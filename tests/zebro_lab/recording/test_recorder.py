# SPDX-License-Identifier: MIT
"""A run folder is readable at every instant and always ends with its reason."""

import errno
import io
import json
import os
import threading
import time
from datetime import datetime, timedelta

import pytest

from rig.clock import ManualClock
from rig.device import Counters
from rig.errors import RigError
from support.recorders import PROFILE, count_in, recorder, some, until
from zebro_lab.files.errors import AlreadyExists, RecordingError
from zebro_lab.files.provenance import file_hash
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording import recorder as module
from zebro_lab.recording import run_files
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.runs.folder import run_state
from zebro_lab.runs.manifest import RunManifest, profile_file, read_manifest


def test_a_run_ends_with_a_complete_record(tmp_path):
    with recorder(tmp_path) as run:
        run.write("legs", some(0, 50))
        run.count("legs", Counters(received=50, lost=2))
        run.compare_clocks({"legs": {"offset": 1.0, "drift": 0.0, "delay": 0.0}})
        run.end("stopped: key")
        run.end("too late")
    manifest = read_manifest(run.folder)
    assert manifest.exit_status == "stopped: key"
    assert manifest.streams == {"/legs/raw": 50}
    assert manifest.counters["legs"]["lost"] == 2
    assert manifest.counters["legs"]["dropped"] == 0
    assert manifest.clocks["legs"]["offset"] == 1.0
    assert manifest.profiles == {"legs": PROFILE}
    assert datetime.fromisoformat(manifest.stop) >= datetime.fromisoformat(manifest.start)
    assert profile_file(run.folder, "legs").read_text() == profile_text(PROFILE)
    assert sorted(p.name for p in run.folder.iterdir()) == ["log.mcap", "profiles", "run.json"]
    assert read_raw_log(run.folder / "log.mcap").damage is None


def test_the_first_of_two_ends_dates_the_stop(tmp_path):
    clock = ManualClock()
    with recorder(tmp_path, clock=clock) as run:
        clock.sleep(1.0)
        run.end()
        clock.sleep(9.0)
        run.end("failed: the port does not close")
    manifest = read_manifest(run.folder)
    assert manifest.exit_status == "failed: the port does not close"
    assert datetime.fromisoformat(manifest.stop) - manifest.began == timedelta(seconds=1)


def test_a_run_can_be_read_while_it_grows(tmp_path):
    with recorder(tmp_path) as run:
        for first in range(0, 30, 10):
            run.write("legs", some(first, 10))
            until(lambda wanted=first + 10: count_in(run) == wanted, limit=2.0)
        assert run_state(run.folder, read_manifest(run.folder)) == "recording"
    assert run_state(run.folder, read_manifest(run.folder)) == "completed"


def test_an_exception_is_the_reason_and_goes_on(tmp_path):
    run = recorder(tmp_path)

    def watched():
        with run:
            run.write("legs", some(0, 5))
            raise RuntimeError("the viewer fell over")

    with pytest.raises(RuntimeError, match="viewer"):
        watched()
    assert read_manifest(run.folder).exit_status == "failed: RuntimeError: the viewer fell over"
    assert count_in(run) == 5


def test_a_full_queue_is_a_failure_that_says_so_and_what_is_dropped_is_counted(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(module, "FLUSH_EVERY", 10.0)
    with recorder(tmp_path, limit=100) as run:
        assert run.write("legs", some(0, 60))
        assert not run.write("legs", some(60, 60))
        assert "too slow" in run.failure
        assert run.dropped("legs") == 60
    manifest = read_manifest(run.folder)
    assert "too slow" in manifest.exit_status
    assert manifest.counters["legs"]["dropped"] == 60


def test_a_run_that_cannot_begin_leaves_no_new_folder_for_runs(tmp_path):
    (tmp_path / "old").mkdir()
    for data in ("new", "old/new/newer", "old"):
        with pytest.raises(RecordingError, match="MB free; expected at least"):
            recorder(tmp_path / data, least_free=1 << 62).__enter__()
    assert [path.name for path in tmp_path.rglob("*")] == ["old"]


def test_a_place_that_takes_no_folder_is_named(tmp_path):
    (tmp_path / "data").write_text("a file")
    with pytest.raises(RecordingError, match="Not a directory; choose another folder with --data"):
        recorder(tmp_path / "data").__enter__()
    with pytest.raises(RecordingError, match="cannot write to"):
        recorder(tmp_path / "data" / "below").__enter__()


def test_a_run_is_never_overwritten(tmp_path, monkeypatch):
    class Stopped(datetime):
        @classmethod
        def now(cls, tz=None):
            return datetime(2026, 1, 2, 3, 4, 5, tzinfo=tz)

    monkeypatch.setattr(module, "datetime", Stopped)
    with recorder(tmp_path) as run:
        pass
    before = (run.folder / "run.json").read_text()
    with pytest.raises(AlreadyExists, match="another name with --label"):
        recorder(tmp_path).__enter__()
    assert (run.folder / "run.json").read_text() == before
    assert json.loads(before)["exit_status"] == "completed"


def test_the_end_of_a_run_reads_nothing_of_its_log_and_knows_its_checksum(tmp_path, monkeypatch):
    real = io.open

    def opened(file, mode="r", *args, **more):
        assert not (str(file).endswith("log.mcap") and "r" in mode)
        return real(file, mode, *args, **more)

    with recorder(tmp_path) as run:
        for first in range(0, 5000, 100):
            run.write("legs", some(first, 100))
        monkeypatch.setattr(io, "open", opened)
    monkeypatch.undo()
    assert run.failure is None
    assert read_manifest(run.folder).log_sha256 == file_hash(run.folder / "log.mcap")


def test_no_step_of_the_wall_clock_shows_in_the_log(tmp_path, monkeypatch):
    with recorder(tmp_path) as run:
        run.write("legs", some(0, 1))
        monkeypatch.setattr(time, "time", lambda: 0.0)
        run.write("legs", some(1, 1))
    monkeypatch.undo()
    host = read_raw_log(run.folder / "log.mcap").streams["/legs/raw"].host_time
    assert 0 <= host[0] <= host[1] < 1.0


FAULTS = {
    "disk that is not synchronised": (os, "fsync", OSError(errno.EIO, "Input/output error")),
    "memory for the disk": (os, "fsync", MemoryError("full")),
    "end of the writer": (module.LogWriter, "flush", SystemExit("over")),
    "end of the log": (module.LogWriter, "finish", ValueError("no such chunk")),
    "end of the thread that ends the log": (module.LogWriter, "finish", SystemExit("over")),
}


@pytest.mark.parametrize(("where", "name", "error"), FAULTS.values(), ids=FAULTS)
def test_whatever_a_thread_of_the_recorder_raises_is_the_reason_in_the_end_record(
    tmp_path, monkeypatch, where, name, error
):
    monkeypatch.setattr(module, "SYNC_EVERY", 0.05)
    planted = []

    def fail(_):
        planted.append(monkeypatch.undo())
        raise error

    with recorder(tmp_path) as run:
        run.write("legs", some(0, 10))
        monkeypatch.setattr(where, name, fail)
        if name != "finish":
            until(lambda: run.failure is not None, limit=2.0)
    assert planted
    assert str(error) in run.failure
    assert read_manifest(run.folder).exit_status == f"failed: {run.failure}"


def test_an_end_record_that_cannot_be_written_is_a_failure_that_says_so(tmp_path, monkeypatch):
    def fail(_folder, _manifest):
        raise OSError(errno.ENOSPC, "No space left on device")

    with recorder(tmp_path) as run:
        monkeypatch.setattr(run_files, "write_manifest", fail)
    assert "run.json cannot be completed" in run.failure
    assert "No space left on device" in run.failure


@pytest.mark.parametrize("starts", [0, 1, 2])
def test_a_writer_that_cannot_be_started_leaves_nothing(tmp_path, monkeypatch, starts):
    left, before = [starts], set(threading.enumerate())
    start = threading.Thread.start

    def few(thread):
        if not left[0]:
            raise RuntimeError("can't start new thread")
        left[0] -= 1
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", few)
    with pytest.raises(RecordingError, match="can't start new thread"):
        recorder(tmp_path).__enter__()
    assert list(tmp_path.iterdir()) == []
    assert set(threading.enumerate()) <= before


def test_a_profile_that_is_invalid_leaves_no_run_folder(tmp_path):
    manifest = RunManifest(kind="walk", label="x", source="sim:test", sources={"legs": "sim:test"})
    run = RunRecorder(tmp_path, manifest=manifest, profiles={"legs": ("mine", "device = 'legs'")})
    with pytest.raises(RigError, match="legs"):
        run.__enter__()
    assert list(tmp_path.iterdir()) == []


def test_the_beginning_of_a_run_waits_for_no_disk(tmp_path, monkeypatch):
    real = os.fsync
    monkeypatch.setattr(os, "fsync", lambda file: (time.sleep(0.5), real(file))[1])
    began = time.monotonic()
    with recorder(tmp_path) as run:
        assert time.monotonic() - began < 0.5
        assert read_manifest(run.folder).exit_status == "recording"
        time.sleep(0.1)
        ended = time.monotonic()
    manifest = read_manifest(run.folder)
    start, stop = map(datetime.fromisoformat, (manifest.start, manifest.stop))
    assert (stop - start).total_seconds() < ended - began + 0.1
