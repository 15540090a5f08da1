# SPDX-License-Identifier: MIT
"""Profiles are found by name or path; addresses name profile and port."""

import pytest

from rig.errors import ProfileError, WrongDevice
from rig.profile import open_profile, split_address


def test_an_unknown_profile_is_named_with_its_nearest():
    with pytest.raises(ProfileError, match="did you mean 'zebro-100-serial'"):
        open_profile("zebro-100-serail", device="legs")


@pytest.mark.parametrize("address", ["zebro-100-serial", "@/dev/ttyUSB0", "profile@"])
def test_half_an_address_is_refused(address):
    with pytest.raises(ProfileError, match="PROFILE@PORT"):
        split_address(address)


def test_a_profile_of_another_device_is_refused_with_the_kind_that_it_describes():
    with pytest.raises(WrongDevice, match=r"found 'imu'; expected .* device 'legs'$") as raised:
        open_profile("imu-quaternion-serial", device="legs")
    assert raised.value.found == "imu"
