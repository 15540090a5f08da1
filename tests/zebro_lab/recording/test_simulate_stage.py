# SPDX-License-Identifier: MIT
"""Twins at ports that the drivers of their profile open."""

import numpy as np
import pytest

from rig.backends import open_imu, open_rig
from rig.openers import legs_at
from zebro_lab.recording.devices import default_gait
from zebro_lab.recording.request import ImuTwinRequest, RigTwinRequest, ZebroTwinRequest
from zebro_lab.recording.simulate_stage import serve


def first(stream):
    with stream:
        for _ in range(400):
            if samples := stream.read(0.05):
                return samples
    raise AssertionError("no sample")


def test_an_imu_is_read_at_its_address():
    with serve(ImuTwinRequest()) as served:
        assert served.source == "sim:imu"
        assert first(open_imu(served.address))


@pytest.mark.parametrize("profile", ["zebro-100-serial", "zebro-100-can"])
def test_a_robot_is_read_at_its_address_and_on_can_behind_an_adapter(profile):
    with serve(ZebroTwinRequest(profile)) as served:
        assert ("slcan:" in served.address) == profile.endswith("can")
        rng = np.random.default_rng(0)
        with legs_at(served.address, default_gait(), rng=rng) as legs:
            assert first(legs)


@pytest.mark.parametrize("profile", ["rig-board-serial", "rig-odrive-netft"])
def test_every_device_of_a_rig_is_read_at_its_address(profile):
    with serve(RigTwinRequest(profile)) as served:
        assert served.source == "sim:rig"
        for stream in open_rig(served.address).streams:
            assert first(stream)
