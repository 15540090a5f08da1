# SPDX-License-Identifier: MIT
"""Simulated legs pause and jitter as asked."""

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated_legs import RobotImperfections, SimulatedLegs

TIMES = np.linspace(0, 200, 4001)
GAIT = SampledReference(TIMES, np.outer(TIMES, np.full(6, 4.0)) + np.arange(6))
SERIAL = load_leg_profile("zebro-100-serial")


def test_a_pause_holds_the_legs_and_the_gait_goes_on_after_it():
    cycle = np.array([0.0, 0.8, 1.0])
    turn = np.array([0.0, 1.0, 2 * np.pi])
    t = np.concatenate([cycle[:2] + k for k in range(20)])
    theta = np.concatenate([turn[:2] + 2 * np.pi * k for k in range(20)])
    gait = SampledReference(t, np.repeat(theta[:, None], 6, axis=1))
    pausing = RobotImperfections(pause_probability=1.0, pause=0.3)
    legs = SimulatedLegs(gait, profile=SERIAL, imperfections=pausing, rng=np.random.default_rng(0))
    frames = [f for k in range(1000) for f in legs.frames(k / 100)]
    behind = 10.0 - np.interp(legs.angles(10.0)[0], theta, t)
    pauses = round(behind / 0.3)
    assert len(frames) == 1000
    assert 6 <= pauses <= 8  # one a cycle of 1.3 s
    assert behind == pytest.approx(0.3 * pauses, abs=0.02 * pauses)


def test_jitter_moves_the_reading_and_leaves_the_order():
    legs = SimulatedLegs(
        GAIT,
        profile=SERIAL,
        imperfections=RobotImperfections(jitter=0.01, clock_rate_error=1e-4),
        rng=np.random.default_rng(0),
    )
    frames = [f for k in range(500) for f in legs.frames(k / 100)]
    taken = np.array([f.time for f in frames])
    assert np.all(np.diff(taken) > 0)
    assert np.std(taken - np.arange(len(taken)) / 100) > 0.002
    assert frames[-1].device_time / frames[-1].time == pytest.approx(1 + 1e-4)


def test_a_commanded_leg_stays_where_it_was_turned_when_the_robot_restarts():
    legs = SimulatedLegs(GAIT, profile=SERIAL, rng=np.random.default_rng(0))
    legs.frames(100.0)
    legs.command((500,) * 6, 1.0, 110.0)
    before = legs.frames(112.0)[-1].counts
    legs.restart()
    assert [frame.counts for frame in legs.frames(113.0)] == [before]
