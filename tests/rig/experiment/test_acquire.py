# SPDX-License-Identifier: MIT
"""Watchdogs are proved before motion, and rest before a person is asked to touch the rig."""

import math
from dataclasses import replace

import pytest

from rig.errors import RigError, RigTimeout
from rig.experiment.acquire import WATCHDOG_LIMIT
from rig.experiment.load import HandShaft
from rig.experiment.plan import WATCHDOG_PROOF
from rig.experiment.sink import ExperimentWatcher
from rig.safety import StopCategory


def keep_turning(twin, monkeypatch, slowest):
    """Let the leg disc turn with at least some speed, whatever is commanded [rad/s]."""
    command = twin.rig.command
    monkeypatch.setattr(
        twin.rig,
        "command",
        lambda disc, omega: command(disc, max(omega, slowest) if disc == "leg" else omega),
    )


def test_empty_reads_are_not_rest(lab, monkeypatch):
    twin = lab["twin"]()
    acquire = twin.acquisition(lab["plan"](limits={"silence": 0.9}))
    with twin.bench:
        twin.turn(acquire)
        monkeypatch.setattr(twin.board, "_frames", lambda due: [])
        with pytest.raises(RigError, match="leg disc did not come to rest"):
            acquire.come_to_rest(0.3)
        assert twin.at_rest()  # de-energised


@pytest.mark.parametrize("slowest", [0.3, 3.0])
def test_a_disc_that_creeps_within_the_tracking_limit_is_not_at_rest(lab, monkeypatch, slowest):
    twin = lab["twin"]()
    keep_turning(twin, monkeypatch, slowest)
    acquire = twin.acquisition(lab["plan"]())
    with twin.bench:
        twin.turn(acquire)
        with pytest.raises(RigError, match=rf"leg disc .* {slowest:.1g}.* rad/s; .* 0\.1 rad/s"):
            acquire.come_to_rest(1.0)
        assert not acquire.energised


def test_nobody_is_asked_to_turn_the_shaft_while_a_disc_turns(lab, monkeypatch):
    twin = lab["twin"]()
    keep_turning(twin, monkeypatch, 3.0)

    class Bystander(ExperimentWatcher):
        def doing(self, what, *, done, of, left):
            pass

        def prompt(self, text, *, normal):
            raise AssertionError(f"asked to {text!r} while a disc turns")

    with pytest.raises(RigError, match="leg disc did not come to rest"):
        twin.run(load=HandShaft(twin.control, tolerance=0.3), watcher=Bystander())
    assert "prompt" not in [kind for kind, _ in twin.sink.events]
    assert twin.sink.events[-1][1].startswith("NotAtRest")


def fastest(twin):
    """Return the largest true speed of either disc in the latest two seconds [rad/s]."""
    twin.rig.advance(twin.clock.now())
    truth = twin.rig.truth()
    return max(abs(truth.omega_leg).max(), abs(truth.omega_ground).max())


KINDS = pytest.mark.parametrize("kind", ["board", "drives"])


@KINDS
@pytest.mark.parametrize("watchdog", [0.1, 0.2, 0.25])
def test_a_watchdog_is_proved_at_standstill_before_the_discs_may_turn(lab, kind, watchdog):
    twin = lab["twin"](kind=kind, watchdog=watchdog)
    twin.rig.command("leg", 0.0)
    acquire = twin.acquisition(lab["plan"]())
    with twin.bench:
        acquire.arm()
        assert watchdog < twin.clock.now() < 1.0
        assert fastest(twin) == 0.0
        acquire.start_ramp(12.0, 0.2)
        acquire.until(lambda _: False, 1.0)
        assert fastest(twin) > 10.0
    assert twin.at_rest()


@KINDS
@pytest.mark.parametrize("watchdog", [math.inf, 5.0, WATCHDOG_LIMIT + 0.1])
def test_without_a_watchdog_in_time_nothing_turns(lab, kind, watchdog):
    twin = lab["twin"](kind=kind, watchdog=watchdog)
    twin.rig.command("leg", 0.0)
    acquire = twin.acquisition(lab["plan"]())
    with twin.bench:
        with pytest.raises(
            RigTimeout, match=r"of the (board|drive).* within 0\.[56]\d* s; expected"
        ):
            acquire.arm()
        assert not acquire.energised
    twin.rig.advance(twin.clock.now() + 0.5)
    assert fastest(twin) == 0.0


def test_one_drive_without_a_watchdog_is_found_and_named(lab, monkeypatch):
    twin = lab["twin"](kind="drives")
    axis = next(axis for axis in twin.board._axes.values() if axis.disc == "ground")
    fail = twin.board._fail
    monkeypatch.setattr(
        twin.board, "_fail", lambda failed, error: failed is axis or fail(failed, error)
    )
    with twin.bench, pytest.raises(RigTimeout, match=r"ground disc \(axis state 8") as caught:
        twin.acquisition(lab["plan"]()).arm()
    assert "leg disc" not in str(caught.value)


@KINDS
def test_a_drive_that_falls_out_for_another_reason_has_proved_nothing(lab, kind, monkeypatch):
    twin = lab["twin"](kind=kind, watchdog=math.inf)
    acquire, pause = twin.acquisition(lab["plan"]()), []
    sleep = twin.clock.sleep

    def trip(duration):
        sleep(duration)
        if not twin.bench.motors.feeding and not pause:
            pause.append(True)
            if kind == "board":
                twin.board._status = 2
            else:
                twin.board.trip("leg", 0x40)
                twin.board.trip("ground", 0x40)

    monkeypatch.setattr(twin.clock, "sleep", trip)
    with twin.bench, pytest.raises(RigTimeout, match=r"(status|error) 0x(2|40)"):
        acquire.arm()


@KINDS
def test_an_emergency_stop_does_not_wait_for_the_proof(lab, kind, monkeypatch):
    twin, asked = lab["twin"](kind=kind, watchdog=math.inf), []
    sleep = twin.clock.sleep

    def push(duration):
        sleep(duration)
        if not twin.bench.motors.feeding and not asked:
            asked.append(twin.clock.now())
            twin.control.stop.request(StopCategory.EMERGENCY, "planted")

    monkeypatch.setattr(twin.clock, "sleep", push)
    assert twin.run().reason == "emergency stop: planted"
    assert twin.clock.now() - asked[0] < 0.05
    assert twin.sink.latched


@KINDS
def test_the_proof_can_be_left_out(lab, kind):
    twin = lab["twin"](kind=kind, watchdog=math.inf)
    limits = lab["plan"]().limits
    plan = replace(lab["plan"](), limits=replace(limits, guards_off=(WATCHDOG_PROOF,)))
    assert twin.run(plan).completed
    assert ("guards off", WATCHDOG_PROOF) in twin.sink.events
    assert twin.sink.runs[0].start.guards_off == WATCHDOG_PROOF
