# SPDX-License-Identifier: MIT
"""What viewers are shown of each device is in SI and continuous."""

import math

import numpy as np
import pytest

from rig.device import Sample
from rig.zebro.profile import decode_angles
from support.logs import LEGS, VIEWS, by_topic, log_of
from zebro_lab.mcap.stream_views import UnwrappedAngles


def test_joint_states_wrenches_and_imu_are_in_si():
    found = {}
    for stream in VIEWS:
        found |= by_topic(log_of(stream)[0])
    legs = found["/legs/joint_states"][0][1]
    assert legs.name == [f"leg_{n}" for n in range(1, 7)]
    np.testing.assert_allclose(legs.position, 2 * np.pi * np.array([-1, 1, 2, 3, 4, 5]) / 100)
    disc = found["/drives/joint_states"][0][1]
    assert (disc.name, disc.velocity) == (["ground_disc"], [pytest.approx(np.pi)])
    force = found["/load_cell/wrench"][0][1].wrench.force
    assert (force.x, force.z) == (1.0, 6.0)
    assert math.isnan(force.y)
    unit = found["/imu/data"][0][1]
    assert (unit.orientation.w, unit.header.frame_id) == (1.0, "body")
    assert unit.angular_velocity.x == pytest.approx(0.1)
    assert unit.linear_acceleration.z == pytest.approx(9.81)
    board = found["/board/joint_states"][0][1]
    assert board.velocity == [12.0, 3.0]


def test_shown_angles_go_on_where_the_batch_before_ended():
    turning = [
        Sample(0.01 * n, 0.01 * n, n, tuple((7 * n + leg) % 100 for leg in range(6)))
        for n in range(60)
    ]
    unwrapped = UnwrappedAngles(LEGS)
    shown = [unwrapped(turning[first : first + 7]) for first in range(0, 60, 7)]
    np.testing.assert_allclose(np.vstack(shown), decode_angles(LEGS, turning).theta)
