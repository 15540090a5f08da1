# SPDX-License-Identifier: MIT
"""Each point is a run folder; whatever fails, the discs stop and the journal says why."""

import contextlib
import itertools
import json
import queue
import threading
import time
from collections import Counter
from contextlib import contextmanager
from dataclasses import asdict

import numpy as np
import pytest

from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.device import Counters
from rig.errors import RigError
from rig.experiment.control import Control
from rig.experiment.sink import SinkFailed
from rig.experiment.supervision import supervised
from rig.slip_rig.simulated_board import SimulatedBoard
from support.experiment_plans import short_plan
from support.logs import by_topic
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.experiment import folder as experiment_folder
from zebro_lab.experiment.folder import ExperimentFolder
from zebro_lab.experiment.journal import JOURNAL_FILE, JournalWriter
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.runs.folder import find_runs
from zebro_lab.runs.manifest import RunManifest, read_manifest


def test_each_point_is_a_run_that_a_calibration_reads(lab, plan, tmp_path):
    data = tmp_path / "data"
    outcome = lab.run(plan, data)
    assert outcome.completed
    found = read_rig_data([data])
    assert found.samples.n_runs == 6
    assert found.source == "sim:rig"
    for index in range(6):
        chosen = found.samples.run == index
        expected = THESIS_LAW.force(
            found.samples.slip[chosen], found.samples.normal_force[chosen], THESIS_VALUES
        )
        assert found.samples.traction_force[chosen].mean() == pytest.approx(
            expected.mean(), abs=0.3
        )
    assert lab.journal(data)[-1]["text"] == "completed"
    assert not (data / "control.json").exists()


def test_a_run_keeps_raw_counts_profile_and_zero(lab, plan, tmp_path):
    data = tmp_path / "data"
    lab.run(plan, data)
    manifest = read_manifest(find_runs(data)[0])
    assert manifest.profiles == {"rig": "rig-board-serial"}
    assert {"zero_normal", "zero_traction", "radius_leg", "radius_ground"} <= set(
        manifest.constants
    )
    assert manifest.label.startswith("point-0002 Fn 4 N slip 0.0200")
    assert "magic-formula" in json.dumps(dict(manifest.truth))


def test_refused_attempts_are_kept_and_left_out(lab, plan, tmp_path):
    plan.write_text(plan.read_text().replace("slip = 0.02   ", "slip = 1e-9   "))
    outcome = lab.run(plan, tmp_path / "data")
    assert len(outcome.refused) == 6
    runs = find_runs(tmp_path / "data")
    assert len(runs) == 18
    assert all("off its set-point" in read_manifest(r).excluded["why"] for r in runs)


class Bridge(SimulatedBoard):
    """A board whose line loses, repeats and exchanges frames, and that notes which."""

    def __init__(self, *args, shares, **options):
        super().__init__(*args, **options)
        self.lost, self.repeated = [], []
        self._shares, self._draws = shares, np.random.default_rng(5)

    def _frames(self, due):
        first, out = self._number + 1, []
        for number, frame in enumerate(super()._frames(due), first):
            drop, twice, late = map(int, self._draws.random(3) < self._shares)
            numbers = [number for number, _ in out[-2:]]
            if drop:
                self.lost.append(number)
            elif late and numbers in ([number - 1], [number - 2, number - 1]):
                out.insert(-1, (number, frame))  # so that the one before comes after it
                self.lost.append(number - 1)
                self.repeated.append(number - 1)
            else:
                out += [(number, frame)] * (1 + twice)
                self.repeated += [number] * twice
        return [frame for _, frame in out]


@pytest.mark.parametrize(
    "shares", [(0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.3, 0.0, 0.0), (0.02, 0.05, 0.05)]
)
def test_a_run_counts_what_the_bridge_lost_repeated_and_exchanged(
    lab, tmp_path, monkeypatch, shares
):
    bridges = []

    def bridge(*args, **options):
        bridges.append(Bridge(*args, shares=shares, **options))
        return bridges[-1]

    monkeypatch.setattr("zebro_lab.experiment.opened_rig.SimulatedBoard", bridge)
    plan = short_plan(tmp_path, duration="2.5")
    assert lab.run(plan, tmp_path / "data").completed
    (sent,) = bridges
    for run in find_runs(tmp_path / "data"):
        numbers = read_raw_log(run / "log.mcap").streams["/board/raw"].sequence
        missed = set(sent.lost)
        before = next(n for n in itertools.count(numbers[0] - 1, -1) if n not in missed)
        during = Counter(lost=0, repeated=0)
        for what in ("lost", "repeated"):
            during[what] = sum(before < number <= numbers[-1] for number in getattr(sent, what))
        counters = read_manifest(run).counters["board"]
        assert counters == asdict(Counters(received=len(numbers), **during)) | {"dropped": 0}
        with (run / "log.mcap").open("rb") as log:
            told = [found for _, found in by_topic(log)["/board/counters"]]
        assert len(told) >= 3
        assert [told[-1].received, told[-1].lost] == [len(numbers), during["lost"]]
        assert 0 < told[0].received < len(numbers) / 2


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


def failing_writer(lab, monkeypatch):
    monkeypatch.setattr(JournalWriter, "append", fail_once(JournalWriter.append, "note"))
    control = Control()
    note = lab.StopAfter(2, lambda: control.execute("note hello", who="test"))
    return {"watcher": note, "control": control}


def failing_opening(lab, monkeypatch):
    enter = ExperimentFolder._enter

    def fail_then(self, description):
        recorder = enter(self, description)
        self._fail(RuntimeError("planted"))
        return recorder

    monkeypatch.setattr(ExperimentFolder, "_enter", fail_then)
    return {}


def no_more_threads(lab, monkeypatch):
    start = threading.Thread.start

    def refuse(self):
        if self.name == "recorder":
            raise RuntimeError("can't start new thread")
        start(self)

    plant = lab.StopAfter(1, lambda: monkeypatch.setattr(threading.Thread, "start", refuse))
    return {"watcher": plant}


def failing_helper(lab, monkeypatch):
    def fail():
        thread = threading.Thread(target=lambda: 1 / 0, name="helper")
        thread.start()
        thread.join()

    return {"watcher": lab.StopAfter(2, fail)}


def full_disk(lab, monkeypatch):
    def full(self, least):
        raise SinkFailed("room for data is 0 MB; its limit is 100 MB")

    fill = lab.StopAfter(2, lambda: monkeypatch.setattr(ExperimentFolder, "require_room", full))
    return {"watcher": fill}


def failing_disk(lab, monkeypatch):
    def fail(self, stream, samples):
        raise OSError(28, "No space left on device")

    plant = lab.StopAfter(1, lambda: monkeypatch.setattr(RunRecorder, "write", fail))
    return {"watcher": plant}


FAULTS = {
    "writer": (failing_writer, SinkFailed, "RuntimeError: planted"),
    "opening of a run": (failing_opening, SinkFailed, "RuntimeError: planted"),
    "no more threads": (no_more_threads, SinkFailed, "can't start new thread"),
    "any thread": (failing_helper, RigError, "helper failed: ZeroDivisionError"),
    "full disk": (full_disk, SinkFailed, "room for data is 0 MB"),
    "failing disk": (failing_disk, RigError, "No space left on device"),
}


@pytest.mark.timeout(PATIENCE, method="signal")
@pytest.mark.parametrize(("plant", "error", "said"), FAULTS.values(), ids=FAULTS)
def test_whatever_fails_stops_the_experiment_and_is_its_end(
    lab, plan, tmp_path, monkeypatch, plant, error, said
):
    data = tmp_path / "data"
    with pytest.raises(error, match=said):
        lab.run(plan, data, **plant(lab, monkeypatch))
    monkeypatch.undo()
    assert said in ends(data)[-1]
    assert len(find_runs(data)) < 6
    assert all(read_manifest(run).exit_status != "recording" for run in find_runs(data))
    assert lab.run(plan, data, resume=True).finished == 6


def turn_the_link(data):
    data.unlink()
    (data.parent / "foreign").mkdir()
    data.symlink_to(data.parent / "foreign")


MEDDLING = {
    "journal gone": (lambda data: (data / JOURNAL_FILE).unlink(), "it has 0 bytes"),
    "journal saved": (lambda data: (data / JOURNAL_FILE).write_text("{}\n"), "it has 3 bytes"),
    "link turned": (turn_the_link, "was removed or replaced"),
}


@pytest.mark.timeout(PATIENCE, method="signal")
@pytest.mark.parametrize(("meddle", "said"), MEDDLING.values(), ids=MEDDLING)
def test_files_that_another_program_changes_stop_the_experiment_and_nothing_foreign_is_written(
    lab, plan, tmp_path, monkeypatch, meddle, said
):
    monkeypatch.setattr(experiment_folder, "DISK_PERIOD", 0.01)
    real, data = tmp_path / "real", tmp_path / "data"
    real.mkdir()
    data.symlink_to(real)

    with pytest.raises(SinkFailed, match=said):
        lab.run(plan, data, watcher=lab.StopAfter(2, lambda: meddle(data)))
    assert len(find_runs(real)) < 6
    assert not (tmp_path / "foreign").exists() or not any((tmp_path / "foreign").iterdir())


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
