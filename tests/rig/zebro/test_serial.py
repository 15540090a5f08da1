# SPDX-License-Identifier: MIT
"""Legs by packets: doubled, late and damaged frames are counted and refused."""

import numpy as np

from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.device import iterate
from rig.links.memory import MemoryLink
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile
from support.leg_twins import GAIT


def test_counts_beyond_the_circle_are_refused():
    clock = ManualClock()
    fine = load_leg_profile("zebrobus-uart")
    twin = robot_twin(fine, GAIT, rng=np.random.default_rng(0))
    coarse = load_leg_profile("zebrobus-uart")
    object.__setattr__(coarse, "counts_per_revolution", 100)
    with leg_driver(coarse, MemoryLink(twin, clock=clock), clock=clock) as stream:
        list(iterate(stream, duration=5.0, clock=clock))
    assert stream.counters.refused > 100
