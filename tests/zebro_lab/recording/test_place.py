# SPDX-License-Identifier: MIT
"""A run folder that is removed or renamed while it is written."""

import shutil
import threading

import pytest

from support.recorders import count_in, recorder, some, until
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.manifest import read_manifest

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


def test_a_run_folder_renamed_while_recording_gets_its_end_record(tmp_path):
    with recorder(tmp_path) as run:
        run.write("legs", some(0, 10))
        until(lambda: count_in(run) == 10)
        there = run.folder.rename(tmp_path / "renamed")
        until(lambda: run.failure is not None, limit=1.0)
    assert "removed or renamed" in read_manifest(there).exit_status
    assert len(read_raw_log(there / "log.mcap").streams["/legs/raw"]) == 10
