# SPDX-License-Identifier: MIT
"""The driver of a board: limits, and discs that stop when it is left."""

import pytest

from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.device import iterate
from rig.errors import LimitExceeded
from rig.slip_rig.board import WATCHDOG_EXPIRED
from rig.slip_rig.decode import decode_board, measured_slip
from support.board_twins import PROFILE, board, world


def test_a_board_turns_and_weighs():
    stream, clock = board(world())
    with stream:
        stream.leg.arm(1.0)
        stream.ground.arm(1.0)
        stream.leg.set_speed(12.0)
        stream.ground.set_speed(3.0)
        samples = list(iterate(stream, duration=1.0, clock=clock))
    forces, speeds = decode_board(PROFILE.board, samples)
    assert speeds.leg[-1] == pytest.approx(12.0, rel=1e-3)
    assert speeds.ground[-1] == pytest.approx(3.0, rel=1e-3)
    expected = THESIS_LAW.force(
        measured_slip(speeds.leg, speeds.ground, PROFILE)[-1], forces.normal[-1], THESIS_VALUES
    )
    assert forces.traction[-1] == pytest.approx(float(expected), rel=1e-2)


def test_leaving_a_board_stops_the_discs():
    rig = world()
    stream, clock = board(rig)
    with stream:
        stream.leg.arm(1.0)
        stream.leg.set_speed(12.0)
        list(iterate(stream, duration=0.5, clock=clock))
    rig.advance(clock.now() + 0.5)
    assert abs(rig.speeds()["leg"][1]) < 0.01


def test_a_board_refuses_a_speed_beyond_the_limit():
    stream, _ = board(world())
    with stream, pytest.raises(LimitExceeded, match="ground disc is 99 rad/s"):
        stream.ground.set_speed(99.0)


def test_only_a_watchdog_that_expired_since_arming_is_a_proof(monkeypatch):
    stream, clock = board(world())
    twin = stream._link._twin

    def hear(duration):
        list(iterate(stream, duration=duration, clock=clock))
        return stream.unexpired()

    with stream, monkeypatch.context() as held:
        held.setattr(twin, "_execute", lambda packet, now: None)  # on the way for long
        twin._status = WATCHDOG_EXPIRED
        stream.leg.arm(1.0)
        assert "no sample" in stream.unexpired()
        assert "no status" in hear(0.1)
        held.undo()
        stream.leg.disarm()
        stream.leg.arm(1.0)
        assert "status 0x0" in hear(0.5)
        stream.feeding = False
        assert hear(0.25) == ""
