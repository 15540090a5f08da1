# SPDX-License-Identifier: MIT
"""What ends a recording, when, and with which record; and what does not end it."""

import os
import threading
import time
from contextlib import contextmanager

import numpy as np
import pytest

from rig.acquisition import Device
from rig.device import Counters, Sample
from rig.errors import DeviceMismatch
from rig.zebro.profile import load_leg_profile
from support.logs import events
from support.watchers import RecordWatcher
from zebro_lab.files.errors import RecordingError
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording import stage as module
from zebro_lab.recording import status
from zebro_lab.recording.devices import OpenDevices, profile_text
from zebro_lab.recording.request import RecordRequest, ZebroTwinRequest
from zebro_lab.recording.simulate_stage import serve
from zebro_lab.recording.stage import record
from zebro_lab.runs.stage import list_runs

LEGS = load_leg_profile("zebro-100-serial")


class Legs:
    """A stream of legs at 100 Hz that begins when told so, and can raise in a read."""

    source = "sim:test"

    def __init__(self, name="legs", *, begins=lambda: True, error=None):
        self.name = name
        self.closed = False
        self.fails = threading.Event()
        self._begins, self._error = begins, error
        self._number = 0

    @property
    def counters(self):
        return Counters(received=self._number)

    def read(self, timeout):
        time.sleep(0.01)
        if self.fails.is_set():
            raise self._error
        if self._number == 0 and not self._begins():
            return []
        self._number += 1
        now = time.monotonic()
        return [Sample(now, now - self._opened, self._number, (self._number % 100,) * 6)]

    def __enter__(self):
        self._opened = time.monotonic()
        return self

    def __exit__(self, *_):
        self.closed = True


@pytest.fixture
def given(monkeypatch):
    """Return a way to let the next recording open streams of this test."""

    def give(*streams, **changes):
        devices = [Device(s, **changes) for s in streams]
        profiles = {s.name: (LEGS.name, profile_text(LEGS.name)) for s in streams}

        @contextmanager
        def opened(_request):
            for device in devices:
                device.stream.__enter__()
            try:
                yield OpenDevices(devices, profiles)
            finally:
                for device in devices:
                    device.stream.__exit__(None, None, None)

        monkeypatch.setattr(module, "open_devices", opened)

    return give


def spans(folder):
    """Return the time from the first to the last sample of each stream [s]."""
    streams = read_raw_log(folder / "log.mcap").streams
    return {name.split("/")[1]: np.ptp(found.host_time) for name, found in streams.items()}


def test_a_wish_to_stop_is_the_reason(tmp_path):
    recorded = record(RecordRequest("x", tmp_path, imus=("sim",)), RecordWatcher(looks=3))
    assert recorded.manifest.exit_status == "stopped: key"
    assert recorded.manifest.log_sha256 is not None


def test_a_watcher_that_cannot_say_whether_to_stop_ends_the_run_with_its_record(tmp_path):
    watcher = RecordWatcher()
    watcher.stop_reason = lambda: 1 / 0
    with pytest.raises(ZeroDivisionError):
        record(RecordRequest("x", tmp_path, imus=("sim",)), watcher)
    (listed,) = list_runs(tmp_path)
    assert listed.state == "failed: ZeroDivisionError: division by zero"


def test_swapped_devices_end_the_run_with_a_line_that_says_so(tmp_path):
    with serve(ZebroTwinRequest("zebro-100-serial")) as served:
        address = f"imu-quaternion-serial@{served.places['robot']}"
        with pytest.raises(RecordingError, match="are two ports swapped"):
            record(RecordRequest("x", tmp_path, imus=(address,), duration=5.0), RecordWatcher())
    (listed,) = list_runs(tmp_path)
    assert listed.state.startswith(f"failed: imu: {DeviceMismatch.__name__}")


def test_the_duration_counts_from_the_first_sample_of_the_stream_that_begins_last(tmp_path, given):
    legs = Legs("legs")
    given(legs, Legs("late", begins=lambda: legs.counters.received >= 60))
    found = record(RecordRequest("x", tmp_path, zebro="sim", duration=0.5), RecordWatcher())
    assert spans(found.folder)["late"] >= 0.48
    assert spans(found.folder)["legs"] >= 0.59 + 0.48
    assert found.manifest.exit_status == "completed"
    assert found.manifest.duration["asked"] == 0.5
    assert found.manifest.duration["from"] > 0.59


def test_a_device_without_a_first_sample_ends_a_run_with_a_duration(tmp_path, given, monkeypatch):
    monkeypatch.setattr(status, "FIRST_SAMPLE", 0.3)
    given(Legs("legs"), Legs("silent", begins=lambda: False))
    with pytest.raises(RecordingError, match=r"no sample of silent within 0\.3 s"):
        record(RecordRequest("x", tmp_path, zebro="sim", duration=0.2), RecordWatcher())
    (listed,) = list_runs(tmp_path)
    assert "no sample of silent" in listed.state


def test_a_slow_disk_falsifies_neither_duration_nor_clocks(tmp_path, monkeypatch):
    real = os.fsync
    monkeypatch.setattr(os, "fsync", lambda file: (time.sleep(0.7), real(file))[1])
    found = record(RecordRequest("x", tmp_path, zebro="sim", duration=1.0), RecordWatcher())
    assert 0.98 < spans(found.folder)["legs"] < 1.5
    assert set(found.manifest.clocks) == {"legs"}
    assert found.manifest.counters["legs"]["lost"] == 0


@pytest.mark.parametrize("which", ["first", "second"])
def test_a_thread_that_cannot_be_started_ends_the_run_with_its_record(
    tmp_path, given, monkeypatch, which
):
    before = set(threading.enumerate())
    first, second = Legs("first"), Legs("second")
    stopped = []
    given(first, second, at_end=lambda: stopped.append(True))
    start = threading.Thread.start

    def fail(thread):
        if thread.name == which:
            raise RuntimeError("can't start new thread")
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", fail)
    with pytest.raises(RecordingError, match="can't start new thread"):
        record(RecordRequest("x", tmp_path, zebro="sim", duration=0.2), RecordWatcher())
    assert first.closed
    assert stopped == [True, True]
    (listed,) = list_runs(tmp_path)
    assert listed.state.startswith("failed: ")
    assert set(threading.enumerate()) <= before


@pytest.mark.parametrize("error", [SystemExit("over"), GeneratorExit("over")])
def test_whatever_ends_a_reader_ends_the_run(tmp_path, given, error):
    legs = Legs(error=error)
    given(legs)
    watcher = RecordWatcher()
    watcher.stop_reason = lambda: legs.fails.set()
    with pytest.raises(RecordingError, match="over"):
        record(RecordRequest("x", tmp_path, zebro="sim", duration=2.0), watcher)
    (listed,) = list_runs(tmp_path)
    assert "over" in listed.state


def test_a_fault_in_the_last_read_is_not_completed(tmp_path, given):
    legs = Legs(error=OSError("link lost"))
    given(legs)
    watcher = RecordWatcher(looks=3)
    asked = watcher.stop_reason

    def stop_reason():
        reason = asked()
        if reason is not None:
            legs.fails.set()
        return reason

    watcher.stop_reason = stop_reason
    with pytest.raises(RecordingError, match="link lost"):
        record(RecordRequest("x", tmp_path, zebro="sim"), watcher)


def test_all_streams_end_together(tmp_path, given):
    given(*[Legs(f"legs{k}") for k in range(3)], pause=0.3)
    found = record(RecordRequest("x", tmp_path, zebro="sim", duration=1.0), RecordWatcher())
    streams = read_raw_log(found.folder / "log.mcap").streams.values()
    assert np.ptp([stream.host_time[-1] for stream in streams]) < 0.15
    assert min(stream.host_time[0] for stream in streams) < 0.2


def test_a_display_that_cannot_be_started_ends_no_run(tmp_path, given, monkeypatch):
    given(Legs())
    start = threading.Thread.start

    def fail(thread):
        if thread.name == "display":
            raise RuntimeError("can't start new thread")
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", fail)
    found = record(RecordRequest("x", tmp_path, zebro="sim", duration=0.2), RecordWatcher())
    assert found.manifest.exit_status == "completed"
    assert any("display cannot start" in text for text in events(found.folder))


@pytest.mark.parametrize("pause", [0.0, 0.05])
def test_a_loop_that_is_held_up_ends_no_recording_late(tmp_path, given, pause):
    given(Legs(), pause=pause)
    watcher = RecordWatcher()
    looks = iter([0.0] * 4)
    watcher.stop_reason = lambda: time.sleep(next(looks, 0.7))
    found = record(RecordRequest("x", tmp_path, zebro="sim", duration=0.5), watcher)
    assert 0.48 < spans(found.folder)["legs"] < 0.65
