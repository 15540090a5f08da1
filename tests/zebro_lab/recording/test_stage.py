# SPDX-License-Identifier: MIT
"""Live devices into run folders: real drivers over twins, and gaps in what they send."""

import threading
import time

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.acquisition import Device, acquiring
from rig.backends import leg_driver, leg_link
from rig.links.serve import PortServer
from rig.twins import robot_twin
from rig.zebro.commands import LEAD_IN
from rig.zebro.profile import load_leg_profile
from support.leg_motions import T, tripod
from support.leg_tables import table_of
from support.logs import events
from support.recorders import until
from support.watchers import Onlooker, RecordWatcher
from zebro_lab.mcap.log_writer import WARNING
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording.devices import default_gait, open_devices, profile_text
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.recording.request import RecordRequest
from zebro_lab.recording.stage import Display, record
from zebro_lab.runs.folder import read_slip_rig_run
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import RunManifest, profile_file

LEGS = load_leg_profile("zebro-100-serial")
ENOUGH = {"legs": 120, "imu1": 120, "imu2": 120, "drives": 240, "load_cell": 8000}
"""Samples of each simulated device that a run of all waits for: about 1.2 s of each."""


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    """Return a run of all simulated devices together, and who looked on.

    It ends when enough has come: how long that takes is the machine's affair.
    """
    watcher = RecordWatcher(samples=ENOUGH)
    request = RecordRequest(
        "all", tmp_path_factory.mktemp("data"), zebro="sim", imus=("sim", "sim"), rig="sim",
        duration=30.0, material="POM", operator="a", seed=0,
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
    legs = read_raw_log(everything[0].folder / "log.mcap").streams["/legs/raw"]
    late = legs.host_time - legs.device_time - clocks["legs"]["offset"]
    assert -0.01 < np.percentile(late, 10) < 0.02  # a busy machine reads others later


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


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """Return a run whose robot was sent the set-points of a gait, and the gait."""
    t = np.arange(0, 2.4, 0.01)
    gait = SampledReference(t, default_gait().angles(t))
    folder = tmp_path_factory.mktemp("walked")
    table_of(t, gait.theta).to_csv(folder / "legs.csv", index=False)
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


def test_suspected_legs_are_told_before_they_are_played_and_kept_in_the_log(tmp_path):
    reversed_legs = tripod().angles(T) * [1, 1, -1, 1, 1, 1]
    table_of(T, reversed_legs).to_csv(tmp_path / "legs.csv", index=False)
    watcher = RecordWatcher()
    request = RecordRequest(
        "x", tmp_path, zebro="sim", play=tmp_path / "legs.csv", duration=0.2
    )  # fmt: skip
    folder = record(request, watcher).folder
    lines, shown_before = zip(*watcher.notes, strict=True)
    assert lines[0].startswith("WARNING: leg log: leg 3 turns backwards")
    assert "robot.toml" in lines[1]
    assert set(shown_before) == {0}
    assert events(folder, level=WARNING) == list(lines)


def test_legs_without_a_fault_are_played_without_a_note(walked):
    assert events(walked[0].folder, level=WARNING) == []


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


def test_every_run_of_a_twin_has_noise_of_its_own_unless_its_seed_is_given(tmp_path, monkeypatch):
    drawn = []

    def opened(wanted):
        drawn.append(wanted.seed)
        return open_devices(wanted)

    monkeypatch.setattr("zebro_lab.recording.stage.open_devices", opened)
    noted = [
        record(RecordRequest(label, tmp_path, imus=("sim",), duration=0.1, seed=seed), Onlooker())
        for label, seed in (("one", None), ("other", None), ("zero", 0))
    ]
    assert [run.manifest.seed for run in noted] == drawn
    assert drawn[0] != drawn[1]
    assert drawn[2] == 0


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
            until(lambda: readers["legs"].counters.received > 20)
            server.unplug()
            time.sleep(1.3)
            server.plug_in()
            before = readers["legs"].counters.received
            until(lambda: readers["legs"].counters.received > before + 50)
    counters = readers["legs"].counters
    assert counters.reconnected == 1
    assert counters.lost > 50
    found = " ".join(events(recorder.folder))
    for part in ("legs: silent", "legs: samples arrive again", "legs: reconnected", "samples lost"):
        assert part in found
    stream = read_raw_log(recorder.folder / "log.mcap").streams["/legs/raw"]
    assert np.diff(stream.host_time).max() > 1.2
    assert len(stream) == counters.received


def test_the_last_status_is_shown_before_the_end():
    seen, gave_up = [], []
    display = Display(seen.append, give_up=gave_up.append)
    for number in range(100):
        display.show(number)
    display.close()
    assert seen[-1] == 99
    assert seen == sorted(seen)
    assert gave_up == []


def test_a_display_that_raises_is_given_up_once_and_says_why():
    gave_up, shown = [], []

    def show(status):
        shown.append(status)
        raise ValueError("torn")

    display = Display(show, give_up=gave_up.append)
    display.show(1)
    until(lambda: gave_up)
    display.show(2)
    display.close()
    assert shown == [1]
    assert len(gave_up) == 1
    assert "torn" in gave_up[0]


def test_a_display_that_hangs_is_given_up_and_holds_up_nothing(monkeypatch):
    monkeypatch.setattr("zebro_lab.recording.stage.PATIENCE", 0.05)
    gave_up, free = [], threading.Event()
    display = Display(lambda status: free.wait(20), give_up=gave_up.append)
    try:
        until(lambda: display.show(1) or gave_up, limit=10)
        began = time.monotonic()
        display.close()
        assert time.monotonic() - began < 10
    finally:
        free.set()
    assert len(gave_up) == 1
