# SPDX-License-Identifier: MIT
"""Order, signs, zeros and lift-off angle of a robot are found with a person who watches."""

import math
from dataclasses import replace

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.errors import DeviceFault, RigTimeout
from rig.links.byte_link import MemoryLink
from rig.zebro.check import (
    check_legs,
    find_lift_off,
    latest_counts,
    move_channel,
    zero_legs,
)
from rig.zebro.profile import load_leg_profile
from support.leg_twins import standing as robot


def test_the_check_finds_order_and_signs():
    believed = load_leg_profile("zebro-100-serial")
    truth = replace(believed, legs=(3, 1, 2, 6, 5, 4), sign=(1, -1, 1, 1, -1, -1))
    stream, clock = robot(truth=truth)

    def watch(channel):
        return truth.legs[channel], truth.sign[channel] == 1

    with stream:
        found = check_legs(stream, watch, clock=clock)
    assert (found.legs, found.sign) == (truth.legs, truth.sign)


def test_a_leg_seen_twice_ends_the_check():
    stream, clock = robot()
    with stream, pytest.raises(DeviceFault, match="leg 1 was seen to move for two channels"):
        check_legs(stream, lambda _: (1, True), clock=clock)


def test_zeros_are_what_is_read_with_the_toes_ahead():
    truth = replace(load_leg_profile("zebro-100-serial"), zero_counts=(3, 0, 98, 0, 50, 7))
    ahead = SampledReference(np.array([0.0, 1.0]), np.zeros((2, 6)))
    stream, clock = robot(truth=truth, gait=ahead)
    with stream:
        assert zero_legs(stream, clock=clock).zero_counts == truth.zero_counts


def test_a_channel_that_does_not_follow_is_named():
    stream, clock = robot()
    with stream:
        stream.set_points = lambda counts, duration: True
        with pytest.raises(DeviceFault, match="channel 2 moved by 0, expected 10"):
            move_channel(stream, 1, clock=clock)


def test_a_silent_robot_ends_the_check_in_time():
    class Silent:
        source = "sim:zebro"

        def poll(self, now, received):
            return b""

    clock = ManualClock()
    profile = load_leg_profile("zebro-100-serial")
    stream = leg_driver(profile, MemoryLink(Silent(), clock=clock), clock=clock)
    with stream, pytest.raises(RigTimeout, match="sent nothing within 2 s"):
        latest_counts(stream, clock=clock)


@pytest.mark.parametrize("touchdown_deg", [20, 35, 50, 65])
def test_the_lift_off_of_a_half_circular_leg_is_that_of_equation_2_17(touchdown_deg):
    asked = []

    def hip_height(theta):
        asked.append(theta)
        return 1 + math.sin(theta) if theta < math.pi / 2 else 2 * math.sin(theta)

    touchdown = math.radians(touchdown_deg)
    found = find_lift_off(hip_height, touchdown, counts_per_revolution=100)
    exact = math.pi - math.asin((1 + math.sin(touchdown)) / 2)
    assert abs(found.theta - exact) <= math.pi / 100 * 1.5
    assert len(asked) < 12
    count = found.theta * 100 / (2 * math.pi)
    assert count == pytest.approx(round(count))
