# SPDX-License-Identifier: MIT
"""Every fault planted once in a whole experiment, in real time: rest, a reason, and resume."""

import contextlib
import re
import time
from functools import partial

import pytest

from rig.errors import DeviceFault, LimitExceeded, RigTimeout
from rig.experiment.control import Control
from rig.experiment.sink import ExperimentWatcher, SinkFailed
from rig.links.can import CanLink
from rig.slip_rig.load_cell import SATURATED
from rig.slip_rig.simulated import SimulatedRig
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from support.experiment_plans import LENIENT, short_plan
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.experiment.folder import ExperimentFolder
from zebro_lab.experiment.journal import JOURNAL_FILE, read_journal
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.experiment.stage import run_experiment
from zebro_lab.runs.folder import find_runs
from zebro_lab.runs.manifest import read_manifest

pytestmark = pytest.mark.long

WATCHDOG = 1.0
"""Five times a real one's [s]: a busy machine holds a process up for longer than that."""
GUARDED = (
    "2.0\nreading_age = 2.0\ntemperature_celsius = 80.0\ntorque = 1.0\n"
    'guards_off = ["silence", "reading_age", "speed_error_time"]'
)
"""Value of `silence`, and limits on what drives and load cell tell beside it."""


class PlantAt(ExperimentWatcher):
    """Plants a fault when the second point begins, on the acquiring thread."""

    def __init__(self, plant):
        self.plant = plant

    def doing(self, what, *, done, of, left):
        if done == 1 and what.startswith("point"):
            self.plant()


@pytest.fixture(name="twins")
def _twins(monkeypatch):
    """Return the simulated devices of the experiment that runs, by class."""
    found = {}
    for kind in (SimulatedDrives, SimulatedLoadCell, SimulatedRig):
        start = kind.__init__

        def keep(self, *args, _start=start, _kind=kind, **options):
            if _kind is SimulatedDrives:
                options["watchdog"] = WATCHDOG
            _start(self, *args, **options)
            found[_kind] = self

        monkeypatch.setattr(kind, "__init__", keep)
    return found


def fail():
    raise ZeroDivisionError("planted")


def overload(twins, patch):
    twins[SimulatedRig].load = 60.0


def silence_cell(twins, patch):
    patch.setattr(twins[SimulatedLoadCell], "_emit", lambda record: None)


def saturate_cell(twins, patch):
    twins[SimulatedLoadCell].status = SATURATED


def twist_cell(twins, patch):
    twins[SimulatedLoadCell].torque = 2.0


def kill_bus(twins, patch):
    patch.setattr(CanLink, "read", lambda self, timeout: [])
    patch.setattr(CanLink, "write", lambda self, can_id, data: False)
    patch.setattr(CanLink, "request", lambda self, can_id, length: False)


def trip_drive(twins, patch):
    twins[SimulatedDrives].trip("ground", 0x40)


def lose_drive(twins, patch):
    drives = twins[SimulatedDrives]
    send = drives._send

    def only_leg(axis, command, data):
        if axis.disc == "leg":
            send(axis, command, data)

    patch.setattr(drives, "_send", only_leg)


def heat_drive(twins, patch):
    twins[SimulatedDrives].temperature = 95.0


def fill_disk(twins, patch):
    def full(self, least):
        raise SinkFailed("room for data is 1 MB; its limit is 100 MB")

    patch.setattr(ExperimentFolder, "require_room", full)


FAULTS = [
    (overload, LimitExceeded, r"normal force is .* N; its limit is 25 N"),
    (twist_cell, LimitExceeded, "torque on the load cell is 2 N m; its limit is 1 N m"),
    (heat_drive, LimitExceeded, "temperature of a drive or its motor is 95 degC"),
    (silence_cell, RigTimeout, "stream 'load cell' sent nothing"),
    (saturate_cell, DeviceFault, "transducer saturated"),
    (kill_bus, RigTimeout, "drive' sent nothing"),
    (trip_drive, DeviceFault, "motor failed"),
    (lose_drive, RigTimeout, "ground drive' sent nothing"),
    (fill_disk, SinkFailed, "room for data"),
    (lambda twins, patch: fail(), ZeroDivisionError, "planted"),
]


def come_to_rest(rig):
    """Tell whether both discs stand before the drives' watchdogs and a ramp have passed."""
    end = time.monotonic() + WATCHDOG + 1.0
    while time.monotonic() < end:
        if all(abs(omega) < 0.1 for _, omega in rig.speeds().values()):
            return True
        time.sleep(0.01)
    return False


@pytest.mark.parametrize(("plant", "error", "said"), FAULTS)
def test_after_a_fault_the_discs_rest_the_reason_is_kept_and_resume_ends_the_plan(
    tmp_path, monkeypatch, twins, plant, error, said
):
    plan = short_plan(tmp_path, loads="[4.0]", slips="[0.1, 0.3, 0.6]", silence=GUARDED, **LENIENT)
    data = tmp_path / "data"
    request = partial(RigRunRequest, plan, "rig-odrive-netft@sim", data, no_watchdog_proof=True)
    rested = []
    leave = CanLink.close

    def watch(self):
        if not rested and SimulatedRig in twins:
            rested.append(come_to_rest(twins[SimulatedRig]))
        leave(self)

    with contextlib.ExitStack() as stack, pytest.MonkeyPatch.context() as patch:
        stack.enter_context(pytest.raises(error, match=said))
        patch.setattr(CanLink, "close", watch)  # the twin is still served then
        run_experiment(request(), PlantAt(lambda: plant(twins, patch)), Control())
    assert rested == [True]
    ends = [line for line in (data / JOURNAL_FILE).read_text().splitlines() if '"end"' in line]
    assert len(ends) == 1
    assert re.search(said, ends[0])
    assert 1 <= len(read_journal(data).accepted) < 3
    for folder in find_runs(data):
        assert read_manifest(folder).stop is not None, folder
    outcome = run_experiment(request(resume=True), ExperimentWatcher(), Control())
    assert outcome.completed
    assert outcome.finished == 3
    assert read_rig_data([data]).samples.n_runs == 3
