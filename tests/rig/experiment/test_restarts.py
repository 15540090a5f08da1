# SPDX-License-Identifier: MIT
"""A device restarts at any instant of an experiment: the discs stop, and stay so."""

import numpy as np
import pytest

from rig.errors import DeviceFault, RigError, RigTimeout, UnreliableRecords

KINDS = pytest.mark.parametrize("kind", ["board", "drives"])
ARMED, ENDED = 0.7, 6.0
"""Times between which the discs of the short plan are energised, watchdogs proved [s]."""


def restart_at(twin, at, restart):
    """Let the twin restart at a host time."""
    sleep, done = twin.clock.sleep, []

    def passing(duration):
        sleep(duration)
        if twin.clock.now() >= at and not done:
            twin.rig.advance(twin.clock.now())
            done.append(twin.rig.elapsed(twin.clock.now()))
            restart()

    twin.clock.sleep = passing
    return done


SEEN = 0.12
"""Longest time until a restart of what turns the discs is seen: drives send 20 states a second."""
RESTARTS = {
    "board": (lambda twin: twin.board.restart(), SEEN),
    "drives": (lambda twin: twin.board.restart(), SEEN),
    # Nobody has asked it for records, and it is silent.
    "cell": (lambda twin: setattr(twin.bench.streams[1]._link, "_client", None), 0.25 + SEEN),
    "bridge": (lambda twin: setattr(twin.bench.motors._link, "reconnected", 1), SEEN),
}
"""What restarts a device, and the time within which the experiment has stopped [s]."""


def require_stop(lab, kind, at, *, seed=0):
    """Run the short plan with a restart at a time, and check that it stops discs and run."""
    twin = lab["twin"](seed, kind="board" if kind == "board" else "drives")
    restart, within = RESTARTS[kind]
    done = restart_at(twin, at, lambda: restart(twin))
    with pytest.raises((DeviceFault, RigTimeout, UnreliableRecords)):
        twin.run()
    assert twin.clock.now() < at + within
    assert twin.at_rest()
    truth = twin.rig.truth(done[0])
    since = done[0] + within - SEEN  # a cell's silence counts after a while
    for omega in (truth.omega_leg, truth.omega_ground):
        later = abs(omega[truth.time >= since])
        assert later.max() <= 1.02 * later[0] + 0.01  # none spins up; they wander a little
    assert all(run.readings.t[-1] <= at for run in twin.sink.accepted)
    others = [run for run in twin.sink.runs if run not in twin.sink.accepted]
    assert kind == "cell" or all(run.verdict is None for run in others)
    return twin.bench.motors.counters


@pytest.mark.parametrize("kind", RESTARTS)
@pytest.mark.parametrize("at", [0.75, 1.37, 2.222, 4.0])
def test_a_restart_is_a_stop_and_nothing_turns_again(lab, kind, at):
    counters = require_stop(lab, kind, at)
    assert (counters.restarted, counters.lost) == (int(kind == "board"), 0)


@pytest.mark.long
@pytest.mark.parametrize("kind", RESTARTS)
def test_a_restart_at_any_instant_is_a_stop_and_nothing_turns_again(lab, kind):
    rng = np.random.default_rng(2)
    for seed, at in enumerate(rng.uniform(ARMED, ENDED, 200)):
        require_stop(lab, kind, at, seed=seed)


@KINDS
@pytest.mark.parametrize("at", np.linspace(0.01, ARMED, 8))
def test_a_restart_while_the_watchdogs_are_proved_turns_nothing(lab, kind, at):
    twin = lab["twin"](kind=kind)
    twin.rig.command("leg", 0.0)
    restart_at(twin, at, twin.board.restart)
    acquire = twin.acquisition(lab["plan"]())
    with twin.bench:
        try:
            acquire.arm()
        except RigError:
            assert not acquire.energised
    twin.rig.advance(twin.clock.now() + 0.5)
    assert abs(twin.rig.truth().omega_leg).max() == 0.0


def test_a_board_that_takes_speeds_after_a_restart_is_stopped_at_once(lab):
    twin = lab["twin"]()

    def obey():
        twin.board.restart()
        twin.board._status = 0  # not as its firmware should

    restart_at(twin, 2.0, obey)
    with pytest.raises(UnreliableRecords, match=r"'board'.* numbering"):
        twin.run()
    assert twin.clock.now() < 2.02
    assert twin.at_rest()
