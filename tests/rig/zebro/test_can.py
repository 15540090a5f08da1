# SPDX-License-Identifier: MIT
"""Legs on CAN: their layouts and their clock frame."""

import can
import cantools

from rig.backends import leg_driver
from rig.links.can import CanLink
from rig.profile import shipped_file
from rig.zebro.can import CLOCK, POSITIONS, SET_POINTS
from rig.zebro.profile import load_leg_profile


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
