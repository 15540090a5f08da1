# SPDX-License-Identifier: MIT
"""SLCAN: every frame comes back, every other line is refused, and python-can's own host agrees."""

import time
from collections import deque
from types import SimpleNamespace

import can
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.gait.reference import SampledReference
from rig.errors import ProtocolError
from rig.links.can import CanLink
from rig.links.serve import PortServer, Ticker
from rig.links.slcan import LONGEST, OBEYED, REFUSED, SlcanAdapter, decode_frame, encode_frame
from rig.zebro.can import CanLegs
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated import CanRobot
from rig.zebro.simulated_legs import SimulatedLegs


@st.composite
def frames(draw):
    extended = draw(st.booleans())
    number = draw(st.integers(0, (1 << (29 if extended else 11)) - 1))
    if draw(st.booleans()):
        return can.Message(arbitration_id=number, is_extended_id=extended, is_remote_frame=True,
                           dlc=draw(st.integers(0, 8)))  # fmt: skip
    data = draw(st.binary(max_size=8))
    return can.Message(arbitration_id=number, is_extended_id=extended, data=data)


@given(frames())
def test_a_frame_comes_back_as_it_was(frame):
    line = encode_frame(frame)
    assert line.endswith(b"\r")
    assert len(line) <= LONGEST
    assert decode_frame(line[:-1]).equals(frame, timestamp_delta=None)


@given(st.binary(max_size=40) | st.from_regex(rb"[tTrR][0-9a-fA-F]{0,30}", fullmatch=True))
def test_any_line_is_a_frame_or_a_protocol_error(line):
    try:
        again = encode_frame(decode_frame(line))
    except ProtocolError:
        return
    assert again[:-1] == line.upper().replace(b"T", line[:1], 1).replace(b"R", line[:1], 1)


@pytest.fixture
def bus():
    """Return two ends of one in-process bus: the adapter's, and a device's."""
    with (
        can.Bus(interface="virtual", channel="slcan-test") as near,
        can.Bus(interface="virtual", channel="slcan-test") as far,
    ):
        yield near, far


def test_frames_pass_both_ways_while_the_channel_is_open_and_only_then(bus):
    near, far = bus
    adapter = SlcanAdapter(near, source="sim:x")
    frame = can.Message(arbitration_id=0x121, data=b"\x01", is_extended_id=False)
    far.send(frame)
    assert adapter.poll(0.0, b"S8\rt1210\r") == OBEYED + REFUSED
    assert adapter.poll(0.0, b"O\r") == OBEYED
    far.send(frame)
    assert adapter.poll(0.0, b"") == b"t121101\r"
    assert adapter.poll(0.0, b"t12120") == b""  # half a line waits for its rest
    assert adapter.poll(0.0, b"1FF\r") == b"z\r"
    assert bytes(far.recv(0).data) == b"\x01\xff"
    assert adapter.poll(0.0, b"C\r") == OBEYED
    far.send(frame)
    assert adapter.poll(0.0, b"") == b""


def test_what_is_no_command_is_refused_and_noise_does_not_fill_the_memory(bus):
    adapter = SlcanAdapter(bus[0], source="sim:x")
    assert adapter.poll(0.0, b"V\rN\rF\r") == b"V0101\rNSIM1\rF00\r"
    assert adapter.poll(0.0, b"t9\rq\rO7\r") == 3 * REFUSED
    assert adapter.refused == 3
    for _ in range(100):
        assert adapter.poll(0.0, bytes(range(14, 255))) == b""
    assert len(adapter._inbox) <= LONGEST
    assert adapter.poll(0.0, b"\rO\r") == REFUSED + OBEYED


class Spoiling:
    """A bus whose interface hands on, as python-can's slcan does, what damaged lines make of it."""

    def __init__(self, answers):
        self.answers = list(answers)

    def recv(self, timeout):
        answer = self.answers.pop(0) if self.answers else None
        if isinstance(answer, Exception):
            raise answer
        return answer


def test_damaged_lines_of_an_adapter_are_counted_and_the_bus_is_read_on():
    good = can.Message(arbitration_id=0x121, data=bytes(8), is_extended_id=False)
    cut = can.Message(arbitration_id=0x121, data=b"\x01", dlc=8, is_extended_id=False)
    link = CanLink("slcan:/x")
    spoiled = (ValueError("no hex"), IndexError(), KeyError(), cut)
    link._bus = Spoiling([*spoiled, good])
    assert link.read(0.0) == [good]
    assert (link.damaged, link.reconnected) == (4, 0)


def test_a_byte_of_noise_costs_its_line_alone():
    with can.Bus(interface="slcan", channel="loop://", sleep_after_open=0.0) as bus:
        link = CanLink(bus)
        link.open()
        bus.flush()  # what opening wrote comes back
        bus.serialPortOrig.write(b"t1211\xb7\r")
        assert link.read(0.0) == []
        bus.serialPortOrig.write(b"t121101\r")
        assert [message.data for message in link.read(0.0)] == [b"\x01"]
        assert (link.damaged, link.reconnected) == (1, 0)


def test_acknowledgements_between_frames_hold_no_frame_back():
    with can.Bus(interface="slcan", channel="loop://", sleep_after_open=0.0) as bus:
        link = CanLink(bus)
        link.open()
        bus.flush()  # what opening wrote comes back
        bus.serialPortOrig.write(b"z\rt121101\rz\rz\rt121102\r\rt121103\rz\r")
        assert [message.data[0] for message in link.read(0.0)] == [1, 2, 3]


def test_a_robot_behind_an_adapter_is_read_and_commanded_by_python_cans_own_slcan(monkeypatch):
    at_once = SimpleNamespace(sleep=lambda _: None, time=time.time)  # it waits 2 s for a real one
    monkeypatch.setattr("can.interfaces.slcan.time", at_once)
    profile = load_leg_profile("zebro-100-can")
    times = np.linspace(0, 60, 601)
    gait = SampledReference(times, np.outer(times, np.full(6, 4.0)))
    legs = SimulatedLegs(gait, profile=profile)
    with (
        can.Bus(interface="virtual", channel="slcan-legs") as near,
        can.Bus(interface="virtual", channel="slcan-legs") as far,
        PortServer(SlcanAdapter(far, source="sim:zebro")) as server,
        Ticker(CanRobot(legs, near, rng=np.random.default_rng(0)).poll),
        CanLegs(CanLink(f"slcan:{server.port}"), profile=profile) as stream,
    ):
        samples, end = [], time.monotonic() + 20
        while len(samples) < 20 and time.monotonic() < end:
            samples += stream.read(0.1)
        assert len(samples) >= 20
        assert all(sample.device_time is not None for sample in samples[1:])
        assert stream.counters.rejected == 0
        assert stream.stop()
        held = deque([(), (1,)], maxlen=5)
        while len(set(held)) > 1 and time.monotonic() < end:
            held.extend(sample.counts for sample in stream.read(0.1))
        assert len(set(held)) == 1
