# SPDX-License-Identifier: MIT
"""A program that is held up is told from a device that is silent or whose readings are old."""

from dataclasses import replace

import numpy as np
import pytest

from rig.errors import DeviceFault, RigTimeout, StaleReading
from rig.experiment.acquire import LONGEST_STEP
from rig.experiment.plan import WATCHDOG_PROOF

KINDS = pytest.mark.parametrize("kind", ["board", "drives"])
PATIENT = 3.0
"""Of watchdogs that a late program does not meet [s]."""


def patient_plan(lab, kind):
    limits = {"temperature_celsius": 80.0} if kind == "drives" else {}
    plan = lab["plan"](limits=limits)
    return replace(plan, limits=replace(plan.limits, guards_off=(WATCHDOG_PROOF,)))


@KINDS
@pytest.mark.parametrize("held", [0.15, 0.26, 0.4, 1.5])
def test_a_program_that_finds_samples_waiting_after_it_was_held_up_goes_on(lab, kind, held):
    twin = lab["twin"](kind=kind, watchdog=PATIENT)
    sink = twin.sink = lab["At"](10, lambda: twin.clock.sleep(held))
    assert twin.run(patient_plan(lab, kind)).completed
    assert sink.written > 10


def test_what_a_buffer_lost_while_the_program_was_held_up_is_no_fault_of_the_stream(
    lab, monkeypatch
):
    twin = lab["twin"](watchdog=PATIENT)
    frames = twin.board._frames
    monkeypatch.setattr(twin.board, "_frames", lambda due: frames(due)[:100])
    twin.sink = lab["At"](10, lambda: twin.clock.sleep(0.4))
    assert twin.run(patient_plan(lab, "board")).completed
    assert twin.bench.motors.counters.lost == pytest.approx(300, abs=30)


@KINDS
def test_a_stream_that_is_silent_after_the_program_was_held_up_is_silent(lab, kind, monkeypatch):
    twin = lab["twin"](kind=kind, watchdog=PATIENT)
    silent = {"board": ("_frames", []), "drives": ("_send", None)}[kind]

    def silence():
        monkeypatch.setattr(twin.board, silent[0], lambda *_: silent[1])
        twin.clock.sleep(0.4)
        held.append(twin.clock.now())

    held = []
    twin.sink = lab["At"](10, silence)
    with pytest.raises(RigTimeout, match="sent nothing"):
        twin.run(patient_plan(lab, kind))
    assert twin.clock.now() - held[0] < 0.3
    assert twin.at_rest()


@KINDS
def test_a_program_that_is_later_than_the_watchdog_says_so(lab, kind):
    twin = lab["twin"](kind=kind)
    twin.sink = lab["At"](10, lambda: twin.clock.sleep(0.4))
    with pytest.raises(DeviceFault, match=r"watchdog.*this program .* late by 0\.3 s"):
        twin.run()
    assert twin.at_rest()


def test_readings_that_come_ever_later_stop_a_program_that_is_often_late(lab, lagging):
    twin = lab["twin"](watchdog=PATIENT)
    link, acquire = lagging(twin, patient_plan(lab, "board"))
    with twin.bench:
        twin.turn(acquire)
        link.growth, began = 0.5, twin.clock.now()
        sleep = twin.clock.sleep
        twin.clock.sleep = lambda duration: sleep(max(duration, 0.14))
        with pytest.raises(StaleReading):
            acquire.until(lambda _: False, 5.0)
        assert twin.clock.now() - began < 2.0


@pytest.mark.parametrize("held", [0.02, 0.15, 0.5])
def test_a_program_that_is_held_up_in_a_ramp_does_not_step_to_where_it_should_be(lab, held):
    twin, sent = lab["twin"](watchdog=PATIENT), []
    command = twin.rig.command
    twin.rig.command = lambda disc, omega: (sent.append((disc, omega)), command(disc, omega))
    plan = patient_plan(lab, "board")
    acquire = twin.acquisition(plan)
    with twin.bench:
        acquire.arm()
        for leg in (12.0, 0.0):
            acquire.start_ramp(leg, 0.2)
            acquire.until(lambda _: False, 0.1)
            twin.clock.sleep(held)
            acquire.until(lambda _: not acquire.ramping, 3.0)
            assert acquire.wanted[0] == leg
    omega = np.array([speed for disc, speed in sent if disc == "leg"])
    assert omega.max() == 12.0
    assert abs(np.diff(omega)).max() <= 1.01 * plan.limits.acceleration * LONGEST_STEP * 0.01
