# SPDX-License-Identifier: MIT
"""Simulated legs that were commanded stay where they were turned."""

from rig.zebro.simulated_legs import SimulatedLegs
from support.leg_twins import GAIT, SERIAL


def test_a_commanded_leg_stays_where_it_was_turned_when_the_robot_restarts():
    legs = SimulatedLegs(GAIT, profile=SERIAL)
    legs.frames(100.0)
    legs.command((500,) * 6, 1.0, 110.0)
    before = legs.frames(112.0)[-1].counts
    legs.restart()
    assert [frame.counts for frame in legs.frames(113.0)] == [before]
