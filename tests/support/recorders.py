# SPDX-License-Identifier: MIT
"""Recorders of a robot's legs, and what they wrote."""

import time
from contextlib import contextmanager
from pathlib import Path

from model.file_lock import try_lock
from rig.device import Sample
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.runs.manifest import RunManifest

PROFILE = "zebro-100-serial"


def recorder(data, *, label="test", **changes):
    manifest = RunManifest(
        kind="walk", label=label, source="sim:test", sources={"legs": "sim:test"}
    )
    profiles = {"legs": (PROFILE, profile_text(PROFILE))}
    return RunRecorder(data, manifest=manifest, profiles=profiles, **changes)


@contextmanager
def being_recorded(folder):
    """Lock the log of a run folder, as its recorder does."""
    with (folder / "log.mcap").open("rb") as log:
        assert try_lock(log.fileno())
        yield


def some(first, count):
    now = time.monotonic()
    return [Sample(now, n / 100, n, (n % 100,) * 6) for n in range(first, first + count)]


def until(holds, limit=20.0):
    end = time.monotonic() + limit
    while not holds() and time.monotonic() < end:
        time.sleep(0.01)
    assert holds()


def growing(data: Path) -> Path:
    """Wait for a run that holds samples, and return its folder."""
    end = time.monotonic() + 60  # in a fresh clone numba may compile first
    while time.monotonic() < end:
        for log in data.glob("*/log.mcap"):
            if (log.parent / "run.json").is_file() and read_raw_log(log).streams:
                return log.parent
        time.sleep(0.05)
    raise AssertionError("nothing was recorded")


def count_in(run):
    found = read_raw_log(run.folder / "log.mcap").streams
    return len(found["/legs/raw"]) if found else 0
