# SPDX-License-Identifier: MIT
"""The simulated unit reports the motion of its body, with the errors that were asked for."""

import numpy as np
import pytest

from rig.clock import ManualClock
from rig.device import iterate
from rig.errors import ProtocolError
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.imu.simulated import GRAVITY, ImuImperfections, SimulatedImu, rocking
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


def test_noise_and_drift_are_as_asked():
    imperfections = ImuImperfections(angle_noise=0.01, rate_noise=0.05, yaw_drift=0.02)
    still = SimulatedImu(
        lambda _: (0.0, 0.0, 0.0),
        profile=PROFILE,
        imperfections=imperfections,
        rng=np.random.default_rng(0),
    )
    found = decode_orientation(PROFILE, read(still, duration=20.0)[0])
    assert found.roll.std() == pytest.approx(0.01, rel=0.1)
    assert np.polyfit(found.device_time, found.yaw, 1)[0] == pytest.approx(0.02, rel=0.05)


def test_a_bad_line_hands_on_nothing_wrong():
    faults = Faults(flip=1e-3, drop=0.05, truncate=0.05, duplicate=0.05, delay=0.05)
    samples, counters = read(
        SimulatedImu(profile=PROFILE, faults=faults, rng=np.random.default_rng(0)), duration=20.0
    )
    perfect, _ = read(SimulatedImu(profile=PROFILE, rng=np.random.default_rng(0)), duration=20.1)
    sent = {sample.sequence: sample.counts for sample in perfect}
    assert all(sent[sample.sequence] == sample.counts for sample in samples)
    assert counters.damaged > 50


def test_a_negative_noise_is_refused():
    with pytest.raises(ProtocolError, match="rate_noise is -1"):
        ImuImperfections(rate_noise=-1.0)
