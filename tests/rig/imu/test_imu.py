# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from rig.clock import ManualClock
from rig.device import Sample, iterate
from rig.errors import ProfileError, ProtocolError
from rig.imu.profile import decode_orientation, encode_orientation, load_imu_profile
from rig.imu.simulated import GRAVITY, ImuImperfections, SimulatedImu, rocking
from rig.imu.stream import ImuStream
from rig.links.faults import Faults
from rig.links.memory import MemoryLink
from rig.profile import shipped_file

PROFILE = load_imu_profile("imu-quaternion-serial")
angles = st.floats(-1.4, 1.4)


def read(twin, profile=PROFILE, duration=5.0):
    clock = ManualClock()
    stream = ImuStream(MemoryLink(twin, clock=clock), profile=profile, clock=clock)
    with stream:
        return list(iterate(stream, duration=duration, clock=clock)), stream.counters


@given(angles, angles, angles, st.floats(-np.pi, np.pi))
def test_roll_pitch_and_yaw_come_back_whatever_the_mounting(roll, pitch, yaw, turned):
    mounted = replace(PROFILE, mounting=(np.cos(turned / 2), 0.0, np.sin(turned / 2), 0.0))
    rotation = Rotation.from_euler("ZYX", [yaw, pitch, roll])
    rate, force = np.array([0.1, -0.2, 0.3]), np.array([1.0, 2.0, 9.0])
    counts = encode_orientation(mounted, rotation, rate, force)
    assert mounted.possible(counts)
    found = decode_orientation(mounted, [Sample(0.0, 0.0, 0, counts)])
    back = Rotation.from_euler("ZYX", [found.yaw[0], found.pitch[0], found.roll[0]])
    assert (back * rotation.inv()).magnitude() < 5e-4
    np.testing.assert_allclose(found.angular_rate[0], rate, atol=2e-3)
    np.testing.assert_allclose(found.specific_force[0], force, atol=2e-2)


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


def test_a_quaternion_that_is_no_rotation_is_refused():
    assert not PROFILE.possible((0,) * 10)
    assert not PROFILE.possible((16384, 16384, 0, 0, 0, 0, 0, 0, 0, 0))


def test_a_negative_noise_is_refused():
    with pytest.raises(ProtocolError, match="rate_noise is -1"):
        ImuImperfections(rate_noise=-1.0)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("quaternion = [1.0,", "quaternion = [2.0,", "expected length 1"),
        ("quaternion = 16384", "quaternion = 0", "above 0"),
        ("baudrate", "boudrate", "did you mean|missing"),
    ],
)
def test_a_malformed_profile_is_refused(tmp_path, old, new, said):
    path = tmp_path / "mine.toml"
    text = shipped_file("imu-quaternion-serial.toml").read_text()
    path.write_text(text.replace(old, new))
    with pytest.raises(ProfileError, match=said):
        load_imu_profile(str(path))
