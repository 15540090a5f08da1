# SPDX-License-Identifier: MIT
import math
from dataclasses import replace

import can
import cantools
import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.device import iterate
from rig.errors import DeviceFault, LimitExceeded, ProtocolError, RigTimeout
from rig.links.can import CanLink
from rig.links.memory import MemoryLink
from rig.profile import shipped_file
from rig.twins import robot_twin, simulated_legs
from rig.zebro.can import CLOCK, POSITIONS, SET_POINTS
from rig.zebro.check import (
    MovedLeg,
    check_legs,
    find_lift_off,
    latest_counts,
    move_channel,
    zero_legs,
)
from rig.zebro.commands import follow, milliseconds
from rig.zebro.profile import decode_angles, load_leg_profile

STANDING = SampledReference(np.array([0.0, 1.0]), np.tile(np.linspace(0.2, 1.2, 6), (2, 1)))


def robot(name="zebro-100-serial", truth=None, gait=STANDING):
    clock = ManualClock()
    profile = load_leg_profile(name)
    twin = robot_twin(truth or profile, gait, rng=np.random.default_rng(0))
    return leg_driver(profile, MemoryLink(twin, clock=clock), clock=clock), clock


@pytest.mark.parametrize("name", ["zebro-100-serial", "zebrobus-uart"])
def test_legs_go_to_their_set_points(name):
    stream, clock = robot(name)
    with stream:
        targets = (10, 20, 30, 40, 50, 60)
        assert stream.set_points(targets, 0.5)
        last = list(iterate(stream, duration=1.0, clock=clock))[-1]
    assert last.counts == targets


def test_legs_on_can_go_to_their_set_points_and_stop(take):
    profile = load_leg_profile("zebro-100-can")
    with simulated_legs(profile, STANDING, rng=np.random.default_rng(0)) as stream, stream:
        targets = (10, 20, 30, 40, 50, 60)
        assert stream.set_points(targets, 0.1)
        assert take(stream, 50)[-1].counts == targets
        stream.set_points((60,) * 6, 10.0)
        take(stream, 10)
        stream.stop()
        held = [s.counts for s in take(stream, 60)[-20:]]
    assert len(set(held)) == 1
    assert held[0] != (60,) * 6


@pytest.mark.parametrize("name", ["zebro-100-serial", "zebrobus-uart"])
def test_stop_holds_every_leg(name):
    walking = SampledReference(np.array([0.0, 60.0]), np.array([[0.0] * 6, [240.0] * 6]))
    stream, clock = robot(name, gait=walking)
    with stream:
        moving = list(iterate(stream, duration=1.0, clock=clock))
        stream.stop()
        list(iterate(stream, duration=0.2, clock=clock))
        held = list(iterate(stream, duration=1.0, clock=clock))
    assert len({s.counts for s in moving}) > 10
    assert len({s.counts for s in held}) == 1


def test_following_a_gait_walks_it():
    t = np.linspace(0, 10, 101)
    gait = SampledReference(t, np.outer(t, np.full(6, 3.0)) + np.linspace(0.2, 1.2, 6))
    stream, clock = robot()
    with stream:
        samples, start = [], clock.now()
        while clock.now() - start < 5.0:
            follow(stream, gait, start=start, now=clock.now(), horizon=0.05)
            samples += stream.read(0.02)
    angles = decode_angles(stream.profile, samples)
    error = angles.theta - gait.angles(angles.device_time)
    assert np.max(np.abs(error[20:])) < 3 * stream.profile.quantisation


def test_a_dump_refuses_set_points_and_says_that_it_cannot_stop():
    stream, _ = robot("vregs-dump")
    with stream:
        assert stream.stop() is False
        with pytest.raises(ProtocolError, match="takes no set-points"):
            stream.set_points((1,), 0.1)


@pytest.mark.parametrize("duration", [-0.1, 66.0, math.nan])
def test_a_motion_longer_than_the_protocol_can_say_is_refused(duration):
    with pytest.raises(LimitExceeded, match="s; its limit"):
        milliseconds(duration)


def test_the_shipped_dbc_agrees_with_the_layouts():
    database = cantools.database.load_string(shipped_file("zebro-100-can.dbc").read_text(), "dbc")
    ids = load_leg_profile("zebro-100-can").can_ids
    counts, number, ticks = (1, 2, 3, 40, 50, 100), 65_000, 4_000_000_000
    positions = database.decode_message(ids.positions, POSITIONS.pack(*counts, number))
    assert tuple(positions[f"Position{leg}"] for leg in range(1, 7)) == counts
    assert positions["Sequence"] == number
    clock = database.decode_message(ids.clock, CLOCK.pack(number, ticks))
    assert clock == {"ClockSequence": number, "DeviceTime": ticks}
    targets = database.decode_message(ids.set_points, SET_POINTS.pack(1, 2, 3, 4, 5, 99, 500))
    assert (targets["Target6"], targets["Duration"]) == (99, 500)
    assert database.get_message_by_frame_id(ids.stop).length == 0


def test_positions_without_their_clock_frame_have_no_time():
    profile = load_leg_profile("zebro-100-can")
    bus = can.Bus(interface="virtual", channel="no-clock")
    with bus, leg_driver(profile, CanLink("virtual:no-clock")) as stream:
        for number in range(3):
            data = POSITIONS.pack(*range(6), number)
            bus.send(can.Message(arbitration_id=0x121, data=data, is_extended_id=False))
        bus.send(can.Message(arbitration_id=0x121, data=b"short", is_extended_id=False))
        samples = stream.read(0.1)
    assert [sample.device_time for sample in samples] == [None] * 3
    assert stream.counters.refused == 1


def test_the_check_finds_order_and_signs():
    believed = load_leg_profile("zebro-100-serial")
    truth = replace(believed, legs=(3, 1, 2, 6, 5, 4), sign=(1, -1, 1, 1, -1, -1))
    stream, clock = robot(truth=truth)

    def watch(channel):
        return MovedLeg(truth.legs[channel], truth.sign[channel] == 1)

    with stream:
        found = check_legs(stream, watch, clock=clock)
    assert (found.legs, found.sign) == (truth.legs, truth.sign)


def test_a_leg_seen_twice_ends_the_check():
    stream, clock = robot()
    with stream, pytest.raises(DeviceFault, match="leg 1 was seen to move for two channels"):
        check_legs(stream, lambda _: MovedLeg(1, True), clock=clock)


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
        with pytest.raises(DeviceFault, match="channel 2 moved by 0 where 10"):
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
    def hip_height(theta):
        return 1 + math.sin(theta) if theta < math.pi / 2 else 2 * math.sin(theta)

    touchdown = math.radians(touchdown_deg)
    found = find_lift_off(hip_height, touchdown, counts_per_revolution=100)
    exact = math.pi - math.asin((1 + math.sin(touchdown)) / 2)
    assert abs(found.theta - exact) <= math.pi / 100 * 1.5
    assert found.measurements < 12
    count = found.theta * 100 / (2 * math.pi)
    assert count == pytest.approx(round(count))
