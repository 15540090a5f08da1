# SPDX-License-Identifier: MIT
"""Legs on CAN: their layouts and their clock frame."""

import can
import cantools
import numpy as np

from model.gait.reference import SampledReference
from rig.backends import leg_driver
from rig.links.can import CanLink
from rig.profile import shipped_file
from rig.twins import simulated_legs
from rig.zebro.can import CLOCK, POSITIONS, SET_POINTS
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated_legs import SimulatedLegs

STANDING = SampledReference(np.array([0.0, 1.0]), np.tile(np.linspace(0.2, 1.2, 6), (2, 1)))


def test_legs_on_can_go_to_their_set_points_and_stop(take):
    profile = load_leg_profile("zebro-100-can")
    rng = np.random.default_rng(0)
    twin = SimulatedLegs(STANDING, profile=profile)
    with simulated_legs(twin, rng=rng) as stream, stream:
        targets = (10, 20, 30, 40, 50, 60)
        assert stream.set_points(targets, 0.1)
        assert take(stream, 50)[-1].counts == targets
        stream.set_points((60,) * 6, 10.0)
        take(stream, 10)
        stream.stop()
        held = [s.counts for s in take(stream, 60)[-20:]]
    assert len(set(held)) == 1
    assert held[0] != (60,) * 6


def test_leaving_the_driver_stops_legs_on_can_that_it_moved():
    profile = load_leg_profile("zebro-100-can")
    channel = "left"
    with can.Bus(interface="virtual", channel=channel) as bus:
        for moved in (False, True):
            with leg_driver(profile, CanLink(f"virtual:{channel}")) as stream:
                if moved:
                    stream.set_points((1,) * 6, 1.0)
            sent = [message.arbitration_id for message in iter(lambda: bus.recv(0.0), None)]
            assert sent == [profile.can_ids.set_points, profile.can_ids.stop] * moved


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
