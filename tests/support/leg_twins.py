# SPDX-License-Identifier: MIT
"""Drivers of a robot's legs over their twins, on a clock turned by hand."""

import numpy as np

from model.gait.reference import SampledReference
from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.device import iterate
from rig.links.byte_link import MemoryLink
from rig.links.faults import PERFECT_LINE
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile

TIMES = np.linspace(0, 200, 4001)
GAIT = SampledReference(TIMES, np.outer(TIMES, np.full(6, 4.0)) + np.arange(6))
"""All legs turn at 4 rad/s."""
STANDING = SampledReference(np.array([0.0, 1.0]), np.tile(np.linspace(0.2, 1.2, 6), (2, 1)))
SERIAL = load_leg_profile("zebro-100-serial")


def stream_of(profile=SERIAL, faults=PERFECT_LINE, *, gait=GAIT, truth=None, twin=None):
    """Return a driver, its clock and the twin, which is wired as `truth` if that is given."""
    clock = ManualClock()
    twin = twin or robot_twin(
        truth or profile, gait, faults=faults, rng=np.random.default_rng(0)
    )  # fmt: skip
    return leg_driver(profile, MemoryLink(twin, clock=clock), clock=clock), clock, twin


def standing(name="zebro-100-serial", *, truth=None, gait=STANDING):
    """Return a driver of a robot that stands, or follows `gait`, and its clock."""
    return stream_of(load_leg_profile(name), gait=gait, truth=truth)[:2]


def read(faults, duration=20.0, profile=SERIAL):
    """Return the samples of a walk over a line with faults, and the counters."""
    stream, clock, _ = stream_of(profile, faults)
    with stream:
        return list(iterate(stream, duration=duration, clock=clock)), stream.counters
