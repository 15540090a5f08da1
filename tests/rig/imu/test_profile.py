# SPDX-License-Identifier: MIT
"""Orientation comes back from counts; profiles that cannot be followed are refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from rig.device import Sample
from rig.errors import ProfileError
from rig.imu.profile import decode_orientation, encode_orientation, load_imu_profile
from rig.profile import shipped_file

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
