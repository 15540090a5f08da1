# SPDX-License-Identifier: MIT
"""The simulated unit reports the motion of its body, over a bad line too."""

import numpy as np

from rig.clock import ManualClock
from rig.device import iterate
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.imu.simulated import GRAVITY, SimulatedImu, rocking
from rig.imu.stream import ImuStream
from rig.links.faults import Faults
from rig.links.memory import MemoryLink

PROFILE = load_imu_profile("imu-quaternion-serial")


def read(twin, profile=PROFILE, duration=5.0):
    clock = ManualClock()
    stream = ImuStream(MemoryLink(twin, clock=clock), profile=profile, clock=clock)
    with stream:
        return list(iterate(stream, duration=duration, clock=clock)), stream.counters


def test_the_twin_reports_the_motion_of_its_body():
    samples, _ = read(SimulatedImu(profile=PROFILE, rng=np.random.default_rng(0)))
    found = decode_orientation(PROFILE, samples)
    truth = np.array([rocking(t) for t in found.device_time])
    measured = np.column_stack([found.roll, found.pitch, found.yaw])
    np.testing.assert_allclose(measured, truth, atol=1e-3)
    slope = np.gradient(found.roll, found.device_time)
    assert np.corrcoef(slope, found.angular_rate[:, 0])[0, 1] > 0.99
    np.testing.assert_allclose(np.linalg.norm(found.specific_force, axis=1), GRAVITY, atol=0.02)


def test_a_bad_line_hands_on_nothing_wrong():
    faults = Faults(flip=1e-3, drop=0.05, truncate=0.05, duplicate=0.05, delay=0.05)
    samples, counters = read(
        SimulatedImu(profile=PROFILE, faults=faults, rng=np.random.default_rng(0)), duration=20.0
    )
    perfect, _ = read(SimulatedImu(profile=PROFILE, rng=np.random.default_rng(0)), duration=20.1)
    sent = {sample.sequence: sample.counts for sample in perfect}
    assert all(sent[sample.sequence] == sample.counts for sample in samples)
    assert counters.damaged > 50
