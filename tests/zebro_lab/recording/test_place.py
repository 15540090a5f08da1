# SPDX-License-Identifier: MIT
"""A run folder that is removed or renamed while it is written."""

import shutil
import threading
import time

import pytest

from rig.device import Sample
from rig.zebro.profile import load_leg_profile
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.mcap.stream_views import LegsView
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.recorder import RunDescription, RunRecorder
from zebro_lab.runs.folder import read_manifest

PROFILE = "zebro-100-serial"


def recorder(data, *, label="test", **changes):
    description = RunDescription(
        kind="walk", label=label, source="sim:test",
        profiles={"legs": (PROFILE, profile_text(PROFILE))}, sources={"legs": "sim:test"},
    )  # fmt: skip
    view = LegsView("legs", profile=load_leg_profile(PROFILE))
    return RunRecorder(data, description=description, views={"legs": view}, **changes)


def some(first, count):
    now = time.monotonic()
    return [Sample(now, n / 100, n, (n % 100,) * 6) for n in range(first, first + count)]


def until(holds, limit=5.0):
    end = time.monotonic() + limit
    while not holds() and time.monotonic() < end:
        time.sleep(0.01)
    assert holds()


def count_in(run):
    found = read_raw_log(run.folder / "log.mcap").streams
    return len(found["/legs/raw"]) if found else 0


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
