# SPDX-License-Identifier: MIT
"""An experiment on disk: run folders, journal, resume, and what is left after a kill."""

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import contextmanager, nullcontext
from pathlib import Path

import numpy as np
import pytest

from rig.errors import InUse, RigError
from rig.experiment.control import Control
from rig.links.serve import PortServer
from rig.safety import StopCategory
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.experiment.journal import read_journal
from zebro_lab.experiment.say_stage import command_run
from zebro_lab.files.errors import DataError, NotFound, SettingsError, ZebroLabError
from zebro_lab.runs.folder import find_runs, read_slip_rig_run
from zebro_lab.runs.manifest import read_manifest

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="needs abstract Unix sockets")
WATCHDOG = 2.0
"""Ten times a real one's [s]: a busy machine holds a process up for longer than that."""


@pytest.mark.parametrize(
    "content",
    ["", "[]", "{", "\xff", '{"port": 1}', '{"port": 70000, "token": "t"}', "[" * 100_000],
)
def test_a_damaged_address_of_an_experiment_is_one_line(tmp_path, content):
    (tmp_path / "control.json").write_bytes(content.encode("latin-1"))
    with pytest.raises(DataError, match=r"control\.json") as caught:
        command_run(tmp_path, "status")
    assert "\n" not in str(caught.value)


def test_no_address_means_that_no_experiment_runs(tmp_path):
    with pytest.raises(NotFound, match="no experiment is running here"):
        command_run(tmp_path, "status")


def test_a_stopped_experiment_is_resumed_where_it_was(lab, plan, tmp_path):
    data, control = tmp_path / "data", Control()
    stop = lab.StopAfter(3, lambda: control.stop.request(StopCategory.SAFE, "planted"))
    first = lab.run(plan, data, watcher=stop, control=control)
    assert (first.reason, first.finished) == ("safe stop: planted", 3)
    finished = read_journal(data).accepted
    assert len(finished) == 3
    again = lab.run(plan, data, resume=True)
    assert (again.completed, again.finished, again.attempts) == (True, 6, 3)
    assert read_rig_data([data]).samples.n_runs == 6


def shorten(plan):
    """Leave two equal points of a plan."""
    text = plan.read_text().replace("slips = [0.02, 0.1, 0.6]", "slips = [0.6, 0.6]")
    plan.write_text(text.replace("loads = [4.0, 8.0]", "loads = [4.0]"))


def forces_of(data):
    return [read_slip_rig_run(run).table.traction_force for run in find_runs(data)]


def test_a_second_run_on_a_simulated_rig_has_its_own_noise_on_the_same_rig(lab, plan, tmp_path):
    shorten(plan)
    folders = [tmp_path / "data", tmp_path / "again" / "data", tmp_path / "further"]
    for data in folders:
        lab.run(plan, data, seed=3)
    first, again, further = map(forces_of, folders)
    np.testing.assert_array_equal(np.concatenate(first), np.concatenate(again))
    assert not np.array_equal(first[0][:20], further[0][:20])
    rigs = [read_manifest(find_runs(data)[0]).truth["rig"]["imperfections"] for data in folders]
    assert rigs[0] == rigs[1] == rigs[2]


def test_a_resumed_run_does_not_repeat_the_noise_of_what_was_measured_before(lab, plan, tmp_path):
    shorten(plan)
    data, control = tmp_path / "data", Control()
    stop = lab.StopAfter(1, lambda: control.stop.request(StopCategory.SAFE, "planted"))
    lab.run(plan, data, watcher=stop, control=control)
    lab.run(plan, data, resume=True)
    before, after, *_ = forces_of(data)
    assert not np.array_equal(before[:20], after[:20])


def test_a_plan_beyond_a_limit_leaves_nothing_behind(lab, plan, tmp_path):
    plan.write_text(plan.read_text().replace("omega_leg = 12.0", "omega_leg = 50.0"))
    with pytest.raises(SettingsError, match=r"plan\.toml: .* 50 rad/s; its limit is 40 rad/s"):
        lab.run(plan, tmp_path / "data")
    assert not (tmp_path / "data").exists()


@pytest.mark.parametrize("link", [Path.symlink_to, Path.hardlink_to])
@pytest.mark.parametrize(
    "name",
    [
        ".experiment.lock",
        ".experiment.reserve",
        ".control.json.new",
        "control.json",
        "emergency-latch",
        "experiment.jsonl",
    ],
)
def test_a_link_in_place_of_an_experiments_file_changes_nothing_elsewhere(
    lab, plan, tmp_path, name, link
):
    shorten(plan)
    data, elsewhere, control = tmp_path / "data", tmp_path / "elsewhere", Control()
    stop = lab.StopAfter(1, lambda: control.stop.request(StopCategory.SAFE, "planted"))
    lab.run(plan, data, watcher=stop, control=control)
    place = data / name
    before = place.read_bytes() + b'{"cut' if place.exists() else b"precious\n"
    place.unlink(missing_ok=True)
    elsewhere.write_bytes(before)
    link(place, elsewhere)
    refused = name in {"emergency-latch", "experiment.jsonl"}
    with pytest.raises(ZebroLabError, match=name) if refused else nullcontext():
        lab.run(plan, data, resume=True, reset_emergency=True)
    assert elsewhere.read_bytes() == before


@LINUX
def test_an_experiment_has_one_owner_whatever_files_are_deleted(lab, plan, tmp_path):
    data = tmp_path / "data"

    def intrude():
        for file in data.glob(".*"):
            file.unlink()
        with pytest.raises(InUse, match=f"the experiment in .* is in use by process {os.getpid()}"):
            lab.run(plan, data, resume=True)

    assert lab.run(plan, data, watcher=lab.StopAfter(2, intrude)).completed


class Rig:
    """A board's twin at a real port, and an operator who follows prompts through the socket."""

    def __init__(self, data):
        profile = load_rig_profile("rig-board-serial")
        rng = np.random.default_rng(0)
        self.data = data
        self.rig = SimulatedRig(
            plan=SweepPlan(), imperfections=TYPICAL_RIG, dynamics=RigDynamics(), rng=rng
        )
        self.rig.load = 1e-3
        twin = SimulatedBoard(self.rig, profile=profile.board, rng=rng, watchdog=WATCHDOG)
        # A socket holds bytes back while a busy machine delays their reader; a terminal drops them.
        self.server = PortServer(twin, as_socket=True)

    def arguments(self, plan):
        rig = f"rig-board-serial@{self.server.port}"
        run = ["rig", "run", str(plan), "--rig", rig, "--data", str(self.data)]
        return [*run, "--no-watchdog-proof"]  # this one's is a patient one

    def start(self, plan):
        main = "from zebro_lab.main import main; main()"
        command = [sys.executable, "-c", main, *self.arguments(plan)]
        return subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )

    @contextmanager
    def operated(self):
        """Do what the prompts say, in a thread, while the body runs."""
        done = threading.Event()
        operator = threading.Thread(target=self.serve, args=[done.is_set])
        operator.start()
        try:
            yield
        finally:
            done.set()
            operator.join()

    def serve(self, until, *, longest=60.0):
        """Do what the prompts say until something holds."""
        end, before = time.monotonic() + longest, None
        while time.monotonic() < end and not until():
            try:
                status = command_run(self.data, "status")
                again, before = status == before, status
                if status.startswith("remove all load"):
                    self.rig.load = 1e-3
                elif status.startswith("set the normal force"):
                    self.rig.load = float(status.split()[5])
                if status.endswith("then confirm") and not again:  # the next prompt would take it
                    command_run(self.data, "confirm")
            except (NotFound, RigError, ValueError):
                pass
            time.sleep(0.05)

    def closed(self):
        try:
            return len(read_journal(self.data).accepted)
        except NotFound:
            return 0

    def at_rest(self):
        end = time.monotonic() + WATCHDOG + 3.0
        while time.monotonic() < end:
            if all(abs(omega) < 0.1 for _, omega in self.rig.speeds().values()):
                return True
            time.sleep(0.02)
        return False


@pytest.mark.parametrize(
    ("signals", "reason"),
    [
        ([signal.SIGKILL], None),
        ([signal.SIGTERM], "safe stop: SIGTERM"),
        pytest.param([signal.SIGHUP], "safe stop: SIGHUP", marks=pytest.mark.long),
        ([signal.SIGINT, signal.SIGINT], "safe stop: Ctrl-C"),
        ([signal.SIGINT, signal.SIGINT, signal.SIGINT], "emergency stop: Ctrl-C"),
    ],
)
def test_a_signal_leaves_motors_at_rest_valid_runs_and_a_run_to_resume(
    lab, plan, run_command, tmp_path, signals, reason
):
    plan.write_text(plan.read_text().replace("loads = [4.0, 8.0]", "loads = [8.0]"))
    rig = Rig(tmp_path / "data")
    with rig.server:
        process = rig.start(plan)
        try:
            rig.serve(lambda: rig.closed() >= 1 or process.poll() is not None)
            assert process.poll() is None, process.communicate()[0]
            for number in signals:
                os.kill(process.pid, number)
                time.sleep(0.03)
            output, _ = process.communicate(timeout=60)
        finally:
            process.kill()
            process.wait()
        assert rig.at_rest()
        events = [e["text"] for e in lab.journal(rig.data) if e["kind"] == "end"]
        assert events == ([] if reason is None else [reason]), output
        for folder in find_runs(rig.data):
            read_slip_rig_run(folder)  # whole, or salvaged
        assert 1 <= rig.closed() < 3
        if reason is not None and reason.startswith("safe stop"):
            return  # it leaves more than SIGKILL, which is resumed below
        options = ["--resume"] + ["--reset-emergency"] * (len(signals) == 3)
        with rig.operated():
            resumed = run_command(*rig.arguments(plan), *options)
        assert resumed.code == 0, resumed
        assert rig.closed() == 3
        assert read_rig_data([rig.data]).samples.n_runs == 3
