# SPDX-License-Identifier: MIT
"""Drives on a bus and a load cell by UDP, in real time: the bench, and faults planted in it."""

import time
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from rig.clock import SYSTEM_CLOCK
from rig.errors import DeviceFault, LimitExceeded, RigTimeout, UnreliableRecords
from rig.experiment.acquire import GuardedAcquisition
from rig.experiment.bench import make_bench
from rig.experiment.control import Control
from rig.experiment.plan import WATCHDOG_PROOF
from rig.links.can import CanLink
from rig.slip_rig.can_simple import AxisState, Command, split_id
from rig.slip_rig.decode import measured_slip
from rig.slip_rig.load_cell import SATURATED
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.twins import simulated_rig_devices
from support.board_twins import world
from support.memory_sink import MemorySink

PROFILE = load_rig_profile("rig-odrive-netft")
WATCHDOG = 1.0
"""Several times a real one's [s]: a busy machine holds a process up for longer than that."""
PATIENT = {"silence": 0.8, "speed_error_time": 1.0}


@contextmanager
def standing(lab, monkeypatch, **limits):
    """Yield an acquisition with nothing energised, the rig, the drives' twin and the cell's."""
    found = {}
    for kind in (SimulatedDrives, SimulatedLoadCell):
        start = kind.__init__

        def keep(self, *args, _start=start, _kind=kind, **options):
            _start(self, *args, **options)
            found[_kind] = self

        monkeypatch.setattr(kind, "__init__", keep)
    rig = world()
    rig.load = 5.0
    rng = np.random.default_rng(1)
    with (
        simulated_rig_devices(PROFILE, rig, rng=rng, watchdog=WATCHDOG) as devices,
        make_bench(devices) as bench,
    ):
        wanted = lab["plan"](limits=PATIENT | limits).limits
        acquire = GuardedAcquisition(
            bench, limits=replace(wanted, guards_off=(WATCHDOG_PROOF,)), control=Control(),
            sink=MemorySink(), clock=SYSTEM_CLOCK,
        )  # fmt: skip
        yield acquire, rig, found[SimulatedDrives], found[SimulatedLoadCell]


@contextmanager
def turning(lab, monkeypatch, *, speed=12.0, slip=0.2, **limits):
    """Yield what `standing` does, after the discs have been energised and turn."""
    with standing(lab, monkeypatch, **limits) as twins:
        acquire, *_ = twins
        acquire.arm()
        acquire.start_ramp(speed, slip)
        acquire.until(lambda _: not acquire.ramping, 2.0)
        acquire.until(lambda _: False, 0.2)
        yield twins


def stands(drives):
    """Tell whether both drives come to be de-energised well before their watchdogs would."""
    return soon(lambda: not drives.turning())


def soon(holds):
    """Wait for a condition, for half of the watchdogs' time; return whether it holds."""
    end = time.monotonic() + WATCHDOG / 2
    while not holds() and time.monotonic() < end:
        time.sleep(0.001)
    return holds()


def test_a_drive_that_does_not_energise_leaves_the_other_one_de_energised(lab, monkeypatch):
    with standing(lab, monkeypatch) as (acquire, _, drives, _):
        execute = drives._execute

        def only_leg(axis, *message):
            if axis.disc == "leg":
                execute(axis, *message)

        monkeypatch.setattr(drives, "_execute", only_leg)
        with pytest.raises(RigTimeout, match="ground disc did not enter closed-loop control"):
            acquire.arm()
        assert not acquire.energised
        assert soon(lambda: all(axis.state == AxisState.IDLE for axis in drives._axes.values()))


def test_forces_and_speeds_are_lined_up(lab, monkeypatch):
    with turning(lab, monkeypatch) as (acquire, _, drives, _):
        parts = []
        acquire.until(lambda batch: parts.append(batch.readings), 0.3)
        slip = np.concatenate(
            [measured_slip(part.omega_leg, part.omega_ground, PROFILE) for part in parts]
        )
        t = np.concatenate([part.t for part in parts])
        assert slip.mean() == pytest.approx(0.2, abs=0.01)
        assert len(t) > 100
        assert np.all(np.diff(t) >= 0)
        assert drives.turning()


def test_a_force_beyond_its_limit_is_answered_in_the_same_look(lab, monkeypatch):
    reactions = []
    for _ in range(3):
        with turning(lab, monkeypatch) as (acquire, rig, drives, _):
            rig.load = 60.0
            with pytest.raises(LimitExceeded, match="normal force is"):
                acquire.until(lambda _: False, 0.5)
            reactions.append(acquire.reaction)
            assert stands(drives)
    assert min(reactions) < 0.02  # usual: 0.2 ms (docs/experiments.md)


def silent_cell(monkeypatch, drives, cell):
    monkeypatch.setattr(cell, "_emit", lambda record: None)


def random_numbers(monkeypatch, drives, cell):
    send, rng = cell._send, np.random.default_rng(0)

    def anyhow(reading, values):
        cell._number = int(rng.integers(1 << 32))
        send(reading, values)

    monkeypatch.setattr(cell, "_send", anyhow)


def silent_drive(monkeypatch, drives, cell):
    send = drives._send

    def only_leg(axis, command, data):
        if axis.disc == "leg":
            send(axis, command, data)

    monkeypatch.setattr(drives, "_send", only_leg)


def is_set(**values):
    """Return a fault that gives attributes of the cell, or the drives' temperature, a value."""

    def plant(monkeypatch, drives, cell):
        for name, value in values.items():
            setattr(drives if name == "temperature" else cell, name, value)

    return plant


HOT = {"temperature_celsius": 80.0}
FAULTS = {
    "silent load cell": (
        silent_cell, {}, RigTimeout, "stream 'load cell' sent nothing within"),
    "records numbered at random": (
        random_numbers, {}, UnreliableRecords, "'load_cell' restarted its numbering"),
    "saturated load cell": (
        is_set(status=SATURATED), {}, DeviceFault, "transducer saturated"),
    "lateral force": (
        is_set(lateral_force=3.0), {"lateral_force": 2.0}, LimitExceeded,
        "third axis is 3 N; its limit is 2 N"),
    "torque": (
        is_set(torque=3.0), {"torque": 2.0}, LimitExceeded,
        "torque on the load cell is 3 N m; its limit is 2 N m"),
    "hot drive": (
        is_set(temperature=81.5), HOT, LimitExceeded, r"is 81.5 degC; .* 80 degC"),
    "temperature that is not told": (
        is_set(temperature=float("nan")), HOT, RigTimeout,
        "temperature of the leg drive' sent nothing within"),
    "silent drive": (silent_drive, {}, RigTimeout, "stream 'ground drive' sent nothing"),
    "error of a drive": (
        lambda _, drives, __: drives.trip("ground", 0x40), {}, DeviceFault,
        "ground disc reports motor failed"),
}  # fmt: skip


@pytest.mark.parametrize(("plant", "limits", "error", "message"), FAULTS.values(), ids=FAULTS)
def test_a_fault_of_a_device_stops_both_discs(lab, monkeypatch, plant, limits, error, message):
    with turning(lab, monkeypatch, **limits) as (acquire, _, drives, cell):
        plant(monkeypatch, drives, cell)
        with pytest.raises(error, match=message):
            acquire.until(lambda _: False, 3.0)
        assert stands(drives)


def test_a_host_that_was_held_up_less_long_than_the_watchdogs_goes_on(lab, monkeypatch):
    with turning(lab, monkeypatch, reading_age=0.3) as (acquire, _, drives, _):
        time.sleep(0.4)
        acquire.until(lambda _: False, 0.3)
        assert drives.turning()


def test_a_dead_bus_stops_the_discs_by_their_watchdog(lab, monkeypatch):
    with turning(lab, monkeypatch) as (acquire, _, drives, _):
        monkeypatch.setattr(CanLink, "read", lambda self, timeout: [])
        monkeypatch.setattr(CanLink, "write", lambda self, can_id, data: False)
        with pytest.raises(RigTimeout, match="drive' sent nothing within"):
            acquire.until(lambda _: False, 3.0)
        time.sleep(1.5 * WATCHDOG)  # no command can arrive
        assert not drives.turning()


def test_standstill_is_commanded_before_closed_loop(lab, monkeypatch):
    seen = []
    write = CanLink.write

    def spy(self, can_id, data):
        seen.append((*split_id(can_id), data))
        return write(self, can_id, data)

    monkeypatch.setattr(CanLink, "write", spy)
    with turning(lab, monkeypatch):
        pass
    for node in (0, 1):
        own = [(command, data) for n, command, data in seen if n == node]
        loop = next(k for k, (command, _) in enumerate(own) if command == Command.SET_AXIS_STATE)
        speeds = [data for command, data in own[:loop] if command == Command.SET_INPUT_VELOCITY]
        assert speeds
        assert all(data == bytes(8) for data in speeds)


def test_watchdogs_are_fed_at_fifty_hertz_while_all_is_well(lab, monkeypatch):
    seen = []
    with turning(lab, monkeypatch) as (acquire, *_):
        write = CanLink.write

        def spy(self, can_id, data):
            if can_id >> 5 == 0:
                seen.append(time.monotonic())
            return write(self, can_id, data)

        monkeypatch.setattr(CanLink, "write", spy)
        acquire.until(lambda _: False, 1.0)
        assert len(seen) <= 1.0 * 50 + 2
        assert np.median(np.diff(seen)) < 0.05  # 0.02, where the machine is not busy
