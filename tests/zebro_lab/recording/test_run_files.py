# SPDX-License-Identifier: MIT
"""The files of a run are whole from the beginning; its end is written wherever it is by then."""

import os
import shutil
import threading

import pytest

from support.recorders import PROFILE, count_in, recorder, some, until
from zebro_lab.files.errors import RecordingError
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording import run_files
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.run_files import RunFiles, needing_threads
from zebro_lab.runs.manifest import RunManifest, read_manifest

MANIFEST = RunManifest(kind="walk", label="x", source="sim:test", start="2026-01-02T03:04:05+00:00")


@pytest.fixture
def folder(tmp_path):
    """Return an empty run folder."""
    (tmp_path / "run").mkdir()
    return tmp_path / "run"


def begun(folder):
    return RunFiles(folder, MANIFEST, profiles={"legs": profile_text(PROFILE)}, start=0.0)


def test_the_end_is_written_into_a_folder_that_was_renamed(folder):
    files, renamed = begun(folder), folder.with_name("renamed")
    folder.rename(renamed)
    with pytest.raises(RecordingError, match="removed or renamed"):
        files.require_place()
    files.finish_log()
    files.write_end(MANIFEST, whole=True)
    files.close()
    assert files.folder == renamed
    manifest = read_manifest(renamed)
    assert manifest.streams == {"/legs/raw": 0}
    assert len(manifest.log_sha256) == 64


def test_a_beginning_that_fails_leaves_no_open_file(folder, monkeypatch):
    def fail(_manifest):
        raise OSError("planted")

    monkeypatch.setattr(run_files, "manifest_text", fail)
    with pytest.raises(OSError, match="planted"):  # a file left open would fail the test
        begun(folder)


REMOVALS = {
    "the run folder removed": lambda folder: shutil.rmtree(folder),
    "the data folder removed": lambda folder: shutil.rmtree(folder.parent),
    "the run folder renamed": lambda folder: folder.rename(folder.with_name("renamed")),
    "the data folder renamed": lambda folder: folder.parent.rename(
        folder.parent.with_name("renamed")
    ),
    "another log in its place": lambda folder: (
        (folder / "copy").write_bytes(b"") or (folder / "copy").replace(folder / "log.mcap")
    ),
}


@pytest.mark.parametrize("remove", REMOVALS.values(), ids=REMOVALS)
def test_a_folder_that_goes_while_recording_is_a_failure_within_a_second(tmp_path, remove):
    before = set(threading.enumerate())
    with recorder(tmp_path / "data") as run:
        run.write("legs", some(0, 10))
        until(lambda: count_in(run) == 10)
        remove(run.folder)
        until(lambda: run.failure is not None, limit=1.0)
    assert "log.mcap" in run.failure
    assert "removed or renamed" in run.failure
    assert set(threading.enumerate()) <= before


def test_a_log_that_is_cut_while_recording_is_a_failure_whatever_is_written_after(tmp_path):
    with recorder(tmp_path) as run:
        run.write("legs", some(0, 10))
        until(lambda: count_in(run) == 10)
        os.truncate(run.folder / "log.mcap", 100)
        run.write("legs", some(10, 10))
        until(lambda: run.failure is not None, limit=1.0)
    assert "was cut to" in read_manifest(run.folder).exit_status


def test_a_run_folder_renamed_while_recording_gets_its_end_record(tmp_path):
    with recorder(tmp_path) as run:
        run.write("legs", some(0, 10))
        until(lambda: count_in(run) == 10)
        there = run.folder.rename(tmp_path / "renamed")
        until(lambda: run.failure is not None, limit=1.0)
    assert "removed or renamed" in read_manifest(there).exit_status
    assert len(read_raw_log(there / "log.mcap").streams["/legs/raw"]) == 10


def test_a_refused_thread_says_what_to_do():
    with pytest.raises(RecordingError, match=r"can't start new thread: .*ulimit") as caught:  # noqa: SIM117
        with needing_threads():
            raise RuntimeError("can't start new thread")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("error", [RuntimeError("torn"), ValueError("can't start new thread")])
def test_other_errors_pass_unchanged(error):
    with pytest.raises(type(error)) as caught, needing_threads():
        raise error
    assert caught.value is error
