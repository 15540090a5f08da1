# SPDX-License-Identifier: MIT
"""Legs by packets: doubled, late and damaged frames are counted and refused."""

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.device import iterate
from rig.links.faults import Faults
from rig.links.memory import MemoryLink
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile

TIMES = np.linspace(0, 200, 4001)
GAIT = SampledReference(TIMES, np.outer(TIMES, np.full(6, 4.0)) + np.arange(6))
SERIAL = load_leg_profile("zebro-100-serial")


def stream_of(profile, faults, seed=0, twin=None):
    clock = ManualClock()
    twin = twin or robot_twin(profile, GAIT, faults=faults, rng=np.random.default_rng(seed))
    return leg_driver(profile, MemoryLink(twin, clock=clock), clock=clock), clock, twin


def read(faults, duration=20.0, profile=SERIAL):
    stream, clock, _ = stream_of(profile, faults)
    with stream:
        return list(iterate(stream, duration=duration, clock=clock)), stream.counters


def test_doubled_frames_are_refused_as_repeated():
    samples, counters = read(Faults(duplicate=1.0), duration=2.0)
    assert counters.repeated == len(samples)
    assert counters.lost == 0


def test_a_late_frame_is_counted_as_lost_and_as_repeated():
    _, counters = read(Faults(delay=0.1))
    assert counters.lost == pytest.approx(counters.repeated, abs=2)
    assert counters.lost > 50


def test_counts_beyond_the_circle_are_refused():
    clock = ManualClock()
    fine = load_leg_profile("zebrobus-uart")
    twin = robot_twin(fine, GAIT, rng=np.random.default_rng(0))
    coarse = load_leg_profile("zebrobus-uart")
    object.__setattr__(coarse, "counts_per_revolution", 100)
    with leg_driver(coarse, MemoryLink(twin, clock=clock), clock=clock) as stream:
        list(iterate(stream, duration=5.0, clock=clock))
    assert stream.counters.refused > 100
