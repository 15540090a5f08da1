# SPDX-License-Identifier: MIT
"""Orientation comes back from counts; profiles that cannot be followed are refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from rig.clock import ManualClock
from rig.device import Sample, iterate
from rig.errors import ProfileError
from rig.imu.profile import decode_orientation, encode_orientation, load_imu_profile
from rig.imu.simulated import SimulatedImu
from rig.imu.stream import ImuStream
from rig.links.byte_link import MemoryLink
from rig.profile import shipped_file
from support.malformed_profiles import require_refused

PROFILE = load_imu_profile("imu-quaternion-serial")
angles = st.floats(-1.4, 1.4)


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


def test_a_quaternion_that_is_no_rotation_is_refused():
    assert not PROFILE.possible((0,) * 10)
    assert not PROFILE.possible((16384, 16384, 0, 0, 0, 0, 0, 0, 0, 0))
    assert not PROFILE.possible((16384, 0, 0, 0, 0, 0, 0, 0, 0, np.nan))


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("imu-quaternion-serial", "quaternion = [1.0,", "quaternion = [2.0,", "expected length 1"),
        ("imu-quaternion-serial", "quaternion = 16384", "quaternion = 0", "above 0"),
        ("imu-quaternion-serial", "baudrate", "boudrate", "boudrate"),
    ],
)  # fmt: skip
def test_a_malformed_profile_is_refused_and_the_place_named(tmp_path, name, old, new, said):
    require_refused(load_imu_profile, tmp_path, name, old, new, said)


EULER = """
schema = 1
device = "imu"
[link]
kind = "serial"
baudrate = 921600
[frame]
byte_order = "big"
record = ["unused:uint16", "pitch:float32", "roll:float32", RECORD "specific_force_x:int32",
          "specific_force_y:int32", "specific_force_z:int32"]
[scale]
angle = 57.29578
specific_force = 1000
[mounting]
quaternion = [1.0, 0.0, 0.0, 0.0]
[stream]
rate = 200.0
"""


@pytest.mark.parametrize("has_yaw", [True, False])
def test_a_record_of_another_layout_is_read_by_its_profile_alone(tmp_path, has_yaw):
    path = tmp_path / "euler.toml"
    path.write_text(EULER.replace("RECORD", '"yaw:float32",' * has_yaw))
    profile = load_imu_profile(str(path))
    clock = ManualClock()
    twin = SimulatedImu(
        profile=profile, attitude=lambda t: (0.1 * t, -0.2 * t, 0.3), rng=np.random.default_rng(0)
    )
    with ImuStream(MemoryLink(twin, clock=clock), profile=profile, clock=clock) as stream:
        samples = list(iterate(stream, duration=1.0, clock=clock))
    found = decode_orientation(profile, samples)
    assert len(samples) > 150
    np.testing.assert_allclose(found.roll, 0.1 * found.device_time, atol=1e-6)
    np.testing.assert_allclose(found.pitch, -0.2 * found.device_time, atol=1e-6)
    np.testing.assert_allclose(found.yaw, 0.3 if has_yaw else np.nan, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(found.specific_force, axis=1), 9.81, atol=2e-3)
    assert np.isnan(found.angular_rate).all()


@pytest.mark.parametrize(
    ("record", "said"),
    [
        ('"roll", "yaw"', "no orientation"),
        ('"roll", "pitch", "pitch"', "found 'pitch'.* once at most"),
        ('"roll", "pitch:int8"', "found 'int8'"),
        ('"roll", "pitsh"', "found 'pitsh'"),
        ('"roll", "pitch"' + ', "unused:int32"' * 50, "longer than 200 bytes"),
    ],
)
def test_a_record_without_sense_is_refused(tmp_path, record, said):
    path = tmp_path / "mine.toml"
    path.write_text(EULER[: EULER.index("record")] + f"record = [{record}]\n")
    with pytest.raises(ProfileError, match=said):
        load_imu_profile(str(path))


def test_a_profile_that_states_no_record_has_ten_counts_of_16_bits(tmp_path):
    text = shipped_file("imu-quaternion-serial.toml").read_text()
    begin, end = text.index("record ="), text.index("[scale]")
    (tmp_path / "earlier.toml").write_text(text[:begin] + text[end:])
    assert load_imu_profile(str(tmp_path / "earlier.toml")).record == PROFILE.record
