# SPDX-License-Identifier: MIT
"""Live devices into run folders: real drivers over twins, and what goes wrong with them."""

import os
import threading
import time
from contextlib import contextmanager

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.acquisition import Acquisition, Device, acquiring
from rig.backends import leg_driver, leg_link
from rig.clock import ManualClock
from rig.device import Counters, Sample
from rig.errors import DeviceMismatch
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.links.serve import PortServer
from rig.replay import ReplayStream
from rig.sample_queue import LossyTap
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile
from support.watchers import RecordWatcher
from zebro_lab.files.errors import DataError, RecordingError
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording import stage as module
from zebro_lab.recording import status
from zebro_lab.recording.devices import OpenDevices, default_gait, profile_text
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.recording.request import RecordRequest, ZebroTwinRequest
from zebro_lab.recording.simulate_stage import serve_zebro
from zebro_lab.recording.stage import record
from zebro_lab.robot.gait_player import LEAD_IN
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import RunManifest, profile_file
from zebro_lab.runs.stage import list_runs

LEGS = load_leg_profile("zebro-100-serial")
ENOUGH = {"legs": 120, "imu1": 120, "imu2": 120, "drives": 240, "load_cell": 8000}
"""Samples of each simulated device that a run of all waits for: about 1.2 s of each."""


def events(folder):
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    with (folder / "log.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [d.msg for *_, d in reader.iter_decoded_messages(topics=["/events"])]


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    """Return a run of all simulated devices together, and who looked on.

    It ends when enough has come: how long that takes is the machine's affair.
    """
    watcher = RecordWatcher(samples=ENOUGH)
    request = RecordRequest(
        "all", tmp_path_factory.mktemp("data"), zebro="sim", imus=("sim", "sim"), rig="sim",
        duration=30.0, material="POM", operator="a",
    )  # fmt: skip
    return record(request, watcher), watcher


def test_all_devices_are_recorded_and_nothing_is_lost(everything):
    recorded, watcher = everything
    manifest = recorded.manifest
    assert (manifest.kind, manifest.exit_status) == ("slip-rig", "stopped: key")
    assert manifest.source == "sim:zebro+imu+rig"
    assert set(manifest.counters) == set(ENOUGH)
    for name, counters in manifest.counters.items():
        shown = watcher.seen[-1].streams[name].counters.received
        assert counters["received"] == manifest.streams[f"/{name}/raw"] >= shown >= ENOUGH[name]
        assert sum(counters.values()) == counters["received"]


def test_clocks_of_devices_that_tell_time_are_compared(everything):
    clocks = everything[0].manifest.clocks
    assert set(clocks) == {"legs", "imu1", "imu2", "load_cell"}
    assert abs(clocks["legs"]["offset"]) < 0.2


def test_the_imus_of_a_robot_that_walks_straight_do_not_turn(everything):
    folder = everything[0].folder
    streams = read_raw_log(folder / "log.mcap").streams
    profile = load_imu_profile(str(profile_file(folder, "imu1")))
    for name in ("imu1", "imu2"):
        seen = decode_orientation(profile, streams[f"/{name}/raw"])
        assert np.ptp(seen.yaw) < np.radians(0.2)
        assert np.ptp(seen.pitch) < np.radians(1)


def test_the_twins_truth_is_in_the_record(everything):
    assert everything[0].manifest.truth["rig"]["law"] == "magic-formula"


def test_a_recorded_rig_is_data_for_a_calibration(everything):
    folder = everything[0].folder
    run = read_slip_rig_run(folder)
    assert not any("is incomplete" in note for note in run.notes)
    table = run.table
    assert len(table) > 50  # at the drives' 100 Hz, forces averaged about them
    assert np.all(np.diff(table.t) > 0)
    assert np.median(table.omega_leg) == pytest.approx(12.0, abs=0.1)
    assert np.all(table.normal_force > 0)


def test_recorded_samples_replay_through_the_drivers_interface(everything):
    stream = read_raw_log(everything[0].folder / "log.mcap").streams["/load_cell/raw"]
    samples = stream
    clock = ManualClock()
    replay = ReplayStream(samples, name="load_cell", source="replay:RUN", clock=clock)
    with replay:
        clock.sleep(1e3)
        again = replay.read(0.1)
    assert [s[1:] for s in again] == [s[1:] for s in samples]


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """Return a run whose robot was sent the set-points of a gait, and the gait."""
    t = np.arange(0, 2.4, 0.01)
    gait = SampledReference(t, default_gait().angles(t))
    folder = tmp_path_factory.mktemp("walked")
    rows = [",".join(map(repr, row)) for row in np.column_stack([t, gait.theta]).tolist()]
    (folder / "legs.csv").write_text(
        "\n".join([",".join(["t", *(f"theta{leg}" for leg in range(1, 7))]), *rows])
    )
    request = RecordRequest("walk", folder, zebro="sim", play=folder / "legs.csv")
    return record(request, RecordWatcher()), gait


def test_a_played_gait_is_followed_and_ends_the_run(walked):
    recorded, gait = walked
    assert recorded.manifest.kind == "walk"
    log = read_leg_log(recorded.folder)
    assert log.source == "sim:zebro"
    # Each pose of six legs is one of the gait's, whenever: a busy machine delays it.
    played = log.reference.theta[log.reference.t > log.reference.t[0] + LEAD_IN]
    apart = np.remainder(played[:, None] - gait.theta + np.pi, 2 * np.pi) - np.pi
    away = np.abs(apart).max(axis=-1)
    assert np.median(away.min(axis=1)) < 2 * LEGS.quantisation
    assert np.mean(played[-1] - played[0]) > 0.2 * np.mean(gait.theta[-1] - gait.theta[0])


def test_a_wrong_zero_found_later_is_repaired_in_the_runs_own_profile(walked):
    folder = walked[0].folder
    before = read_leg_log(folder).reference
    file = profile_file(folder, "legs")
    text = file.read_text()
    file.write_text(text.replace("zero_counts = [0,", "zero_counts = [-5,"))
    after = read_leg_log(folder).reference
    file.write_text(text)
    moved = after.theta - before.theta
    np.testing.assert_allclose(np.remainder(moved[:, 0], 2 * np.pi), np.radians(18), atol=1e-9)
    np.testing.assert_allclose(moved[:, 1:], 0.0, atol=1e-9)


def test_a_run_without_legs_is_no_leg_log(everything, tmp_path):
    request = RecordRequest("imu", tmp_path, imus=("sim",), duration=0.2)
    folder = record(request, RecordWatcher()).folder
    with pytest.raises((DataError, FileNotFoundError), match="leg"):
        read_leg_log(folder)


def test_a_wish_to_stop_is_the_reason(tmp_path):
    recorded = record(RecordRequest("x", tmp_path, imus=("sim",)), RecordWatcher(looks=3))
    assert recorded.manifest.exit_status == "stopped: key"
    assert recorded.manifest.log_sha256 is not None


def test_a_display_that_raises_ends_no_run(tmp_path):
    watcher = RecordWatcher(error=RuntimeError("screen"))
    found = record(RecordRequest("x", tmp_path, imus=("sim",), duration=2.0), watcher)
    assert found.manifest.exit_status == "completed"
    assert found.manifest.streams["/imu/raw"] > 40
    assert len(watcher.seen) == 3
    said = [text for text in events(found.folder) if "display" in text]
    assert said == [
        "the display failed, the recording continues without it: RuntimeError('screen')"
    ]


def test_a_watcher_that_cannot_say_whether_to_stop_ends_the_run_with_its_record(tmp_path):
    watcher = RecordWatcher()
    watcher.stop_reason = lambda: 1 / 0
    with pytest.raises(ZeroDivisionError):
        record(RecordRequest("x", tmp_path, imus=("sim",)), watcher)
    (listed,) = list_runs(tmp_path)
    assert listed.state == "failed: ZeroDivisionError: division by zero"


def test_swapped_devices_end_the_run_with_a_line_that_says_so(tmp_path):
    with serve_zebro(ZebroTwinRequest("zebro-100-serial")) as served:
        address = f"imu-quaternion-serial@{served.places['robot']}"
        with pytest.raises(RecordingError, match="are two ports swapped"):
            record(RecordRequest("x", tmp_path, imus=(address,), duration=5.0), RecordWatcher())
    (listed,) = list_runs(tmp_path)
    assert listed.state.startswith(f"failed: imu: {DeviceMismatch.__name__}")


def wait_until(met, limit=20.0):
    end = time.monotonic() + limit
    while not met():
        assert time.monotonic() < end, f"still waiting after {limit} s"
        time.sleep(0.01)


def test_an_unplugged_robot_is_a_gap_that_is_counted_and_the_run_goes_on(tmp_path):
    twin = robot_twin(LEGS, default_gait(), rng=np.random.default_rng(0))
    manifest = RunManifest(kind="walk", label="gap", source=twin.source)
    with PortServer(twin) as server:
        legs = leg_driver(LEGS, leg_link(LEGS, server.port, source=twin.source))
        profiles = {"legs": (LEGS.name, profile_text(LEGS.name))}
        recorder = RunRecorder(tmp_path, manifest=manifest, profiles=profiles)
        with (
            legs,
            recorder,
            acquiring([Device(legs)], sink=recorder, start=recorder.start) as readers,
        ):
            wait_until(lambda: readers["legs"].counters.received > 20)
            server.unplug()
            time.sleep(1.3)
            server.plug_in()
            before = readers["legs"].counters.received
            wait_until(lambda: readers["legs"].counters.received > before + 50)
    counters = readers["legs"].counters
    assert counters.reconnected == 1
    assert counters.lost > 50
    found = " ".join(events(recorder.folder))
    for part in ("legs: silent", "legs: samples arrive again", "legs: reconnected", "samples lost"):
        assert part in found
    stream = read_raw_log(recorder.folder / "log.mcap").streams["/legs/raw"]
    assert np.diff(stream.host_time).max() > 1.2
    assert len(stream) == counters.received


def test_a_viewer_that_hangs_slows_nobody(tmp_path):
    twin = robot_twin(LEGS, default_gait(), rng=np.random.default_rng(0))
    with PortServer(twin) as server:
        legs = leg_driver(LEGS, leg_link(LEGS, server.port))
        taken = []

        class Sink:
            def write(self, stream, samples):
                taken.extend(samples)
                return True

            def event(self, text, *, level=20):
                pass

        reader = Acquisition(Device(legs), sink=Sink(), start=0.0)
        reader.tap = LossyTap(limit=10)
        with legs:
            reader.start()
            wait_until(lambda: len(taken) > 30)  # the viewer sleeps
            reader.stop()
    newest = reader.tap.take()
    assert newest == taken[-10:]


class Legs:
    """A stream of legs at 100 Hz that can begin late, raise, or stand still in a read."""

    source = "sim:test"

    def __init__(self, name="legs", *, late=0.0, error=None, hang=None):
        self.name = name
        self.closed = False
        self.fails = threading.Event()
        self._late, self._error, self._hang = late, error, hang
        self._number = 0

    @property
    def counters(self):
        return Counters(received=self._number)

    def read(self, timeout):
        time.sleep(0.01)
        if self.fails.is_set():
            raise self._error
        if time.monotonic() < self._begins:
            return []
        self._number += 1
        now = time.monotonic()
        return [Sample(now, now - self._begins, self._number, (self._number % 100,) * 6)]

    def __enter__(self):
        self._begins = time.monotonic() + self._late
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


def ended(act, limit):
    """Run something beside the test; return what it returned, or fail after a limit."""
    outcome = []
    thread = threading.Thread(target=lambda: outcome.append(act()), daemon=True)
    thread.start()
    thread.join(limit)
    assert not thread.is_alive(), f"has not ended within {limit} s"
    return outcome[0]


def test_the_duration_counts_from_the_first_sample_of_the_stream_that_begins_last(tmp_path, given):
    given(Legs("legs"), Legs("late", late=0.6))
    found = record(RecordRequest("x", tmp_path, zebro="sim", duration=0.5), RecordWatcher())
    assert spans(found.folder)["late"] >= 0.48
    assert spans(found.folder)["legs"] >= 1.0
    assert found.manifest.exit_status == "completed"
    assert found.manifest.duration["asked"] == 0.5
    assert 0.5 < found.manifest.duration["from"] < 5.0


def test_a_device_without_a_first_sample_ends_a_run_with_a_duration(tmp_path, given, monkeypatch):
    monkeypatch.setattr(status, "FIRST_SAMPLE", 0.3)
    given(Legs("legs"), Legs("silent", late=1e6))
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


def test_a_display_that_hangs_holds_up_nothing(tmp_path):
    watcher, released = RecordWatcher(), threading.Event()
    watcher.show = lambda _status: released.wait(60)
    request = RecordRequest("x", tmp_path, imus=("sim",), duration=0.5)
    try:
        found = ended(lambda: record(request, watcher), limit=8.0)
    finally:
        released.set()
    assert found.manifest.exit_status == "completed"
    assert 0.48 < spans(found.folder)["imu"] < 2.0
    assert any("display hung" in text for text in events(found.folder))


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
