# SPDX-License-Identifier: MIT
"""The simulated board stops by itself, and its bad line passes nothing wrong."""

import pytest

from rig.device import iterate
from rig.errors import DeviceFault
from rig.links.faults import Faults
from support.board_twins import PROFILE, board, world


def test_a_board_that_hears_nothing_stops_and_stays_stopped_until_it_is_armed_again():
    rig = world()
    stream, clock = board(rig)
    with stream:
        stream.leg.arm(1.0)
        stream.leg.set_speed(12.0)
        list(iterate(stream, duration=1.0, clock=clock))
        stream.require_healthy()
        assert rig.speeds()["leg"][1] > 11
        clock.sleep(0.5)  # the host is held up, and comes back
        list(iterate(stream, duration=0.5, clock=clock))
        assert abs(rig.speeds()["leg"][1]) < 0.01
        with pytest.raises(DeviceFault, match="watchdog"):
            stream.require_healthy()
        stream.leg.disarm()
        stream.leg.arm(1.0)
        stream.leg.set_speed(12.0)
        list(iterate(stream, duration=0.5, clock=clock))
        stream.require_healthy()
        assert rig.speeds()["leg"][1] > 11


def test_a_board_that_is_switched_on_takes_no_speeds_until_a_stop_command():
    rig = world()
    rig.command("leg", 0.0)
    stream, clock = board(rig)
    with stream:
        for _ in range(2):
            stream.leg.set_speed(12.0)
            assert {s.status for s in iterate(stream, duration=0.3, clock=clock)} == {1}
            assert rig.speeds()["leg"][1] == pytest.approx(0.0, abs=0.01)
            stream.leg.disarm()
            stream.leg.arm(1.0)
            stream.leg.set_speed(12.0)
            list(iterate(stream, duration=0.5, clock=clock))
            assert rig.speeds()["leg"][1] > 11
            stream._link._twin.restart()
            list(iterate(stream, duration=0.5, clock=clock))
    assert (stream.counters.restarted, stream.counters.lost) == (2, 0)


def test_a_board_on_a_bad_line_hands_on_nothing_wrong():
    stream, clock = board(world(), faults=Faults(flip=1e-3, drop=0.02, duplicate=0.02, delay=0.02))
    with stream:
        samples = list(iterate(stream, duration=1.5, clock=clock))
    numbers = [sample.sequence for sample in samples]
    counters = stream.counters
    assert counters.received + counters.lost == numbers[-1] - numbers[0] + 1
    assert counters.damaged > 100
    limit = 25.0 * PROFILE.board.counts_per_force
    assert all(abs(sample.counts[0]) < limit for sample in samples)
