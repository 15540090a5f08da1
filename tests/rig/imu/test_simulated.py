# SPDX-License-Identifier: MIT
"""The simulated unit reports the motion of its body, over a bad line too."""

import numpy as np
from scipy.spatial.transform import Rotation

from rig.clock import ManualClock
from rig.device import iterate
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.imu.simulated import GRAVITY, SimulatedImu
from rig.imu.stream import ImuStream
from rig.links.byte_link import MemoryLink

PROFILE = load_imu_profile("imu-quaternion-serial")


def rocking(time):
    """Compute roll, pitch and yaw [rad] of a body that oscillates at 1 Hz as it turns left."""
    swing = 2 * np.pi * time
    return 0.08 * float(np.sin(swing)), 0.05 * float(np.cos(swing)), 0.1 * time


def read(twin, profile=PROFILE, duration=5.0):
    clock = ManualClock()
    stream = ImuStream(MemoryLink(twin, clock=clock), profile=profile, clock=clock)
    with stream:
        return list(iterate(stream, duration=duration, clock=clock)), stream.counters


def test_the_twin_reports_the_motion_of_its_body():
    samples, _ = read(SimulatedImu(profile=PROFILE, attitude=rocking, rng=np.random.default_rng(0)))
    found = decode_orientation(PROFILE, samples)
    truth = np.array([rocking(t) for t in found.device_time])
    measured = np.column_stack([found.roll, found.pitch, found.yaw])
    np.testing.assert_allclose(measured, truth, atol=1e-3)
    slope = np.gradient(found.roll, found.device_time)
    assert np.corrcoef(slope, found.angular_rate[:, 0])[0, 1] > 0.99
    np.testing.assert_allclose(np.linalg.norm(found.specific_force, axis=1), GRAVITY, atol=0.02)


def test_the_angular_rate_integrates_to_the_rotation():
    samples, _ = read(SimulatedImu(profile=PROFILE, attitude=rocking, rng=np.random.default_rng(0)))
    found = decode_orientation(PROFILE, samples)
    turned = Rotation.identity()
    for rate in found.angular_rate[1:]:
        turned = turned * Rotation.from_rotvec(rate / PROFILE.rate)
    first, last = (
        Rotation.from_euler("ZYX", [found.yaw[i], found.pitch[i], found.roll[i]]) for i in (0, -1)
    )
    assert (turned.inv() * first.inv() * last).magnitude() < 0.01


def test_a_unit_on_a_body_at_rest_is_still():
    samples, _ = read(SimulatedImu(profile=PROFILE, rng=np.random.default_rng(0)))
    assert len({sample.counts for sample in samples}) == 1
    found = decode_orientation(PROFILE, samples)
    assert not np.any([found.roll, found.pitch, found.yaw])
    assert not found.angular_rate.any()
