# SPDX-License-Identifier: MIT
"""A device is read by a thread of its own; what happens to it becomes events of its sink."""

import threading

import pytest

from rig.acquisition import Acquisition, Device, acquiring
from rig.clock import ManualClock
from rig.device import Counters, Sample
from rig.errors import LimitExceeded


class Stream:
    """Gives one sample a read, each 1 ms of its clock, until it is told to raise."""

    name, source = "legs", "sim:test"

    def __init__(self, *, gap_at=None):
        self.clock = ManualClock()
        self.number, self.lost, self.error, self._gap_at = 0, 0, None, gap_at

    @property
    def counters(self):
        return Counters(received=self.number, lost=self.lost)

    def read(self, timeout):
        self.clock.sleep(0.001)
        if self.error is not None:
            raise self.error
        self.number += 1
        self.lost += 3 * (self.number == self._gap_at)
        return [Sample(self.clock.now(), None, self.number, (self.number,))]


class Kept:
    """Keeps samples and events."""

    def __init__(self):
        self.samples, self.events, self.enough = [], [], threading.Event()

    def write(self, stream, samples):
        self.samples += samples
        if len(self.samples) >= 20:
            self.enough.set()
        return True

    def event(self, text, *, level=20):
        self.events.append(text)


def read(device, sink):
    with acquiring([device], sink=sink, start=0.0, clock=device.stream.clock) as readers:
        assert sink.enough.wait(20)
    return readers[device.name]


def test_every_sample_reaches_the_sink_in_order():
    stream, sink = Stream(), Kept()
    reader = read(Device(stream), sink)
    assert [s.sequence for s in sink.samples] == list(range(1, stream.number + 1))
    assert (reader.failure, reader.counters.received) == (None, stream.number)
    assert reader.first == sink.samples[0].host_time
    assert reader.tap.take() == sink.samples[-1000:]


def test_losses_are_events():
    sink = Kept()
    read(Device(Stream(gap_at=5)), sink)
    assert sink.events == ["legs: 3 samples lost"]


def test_commands_go_before_reads_and_the_end_is_called_once():
    order, sink = [], Kept()
    device = Device(Stream(), command=lambda now: order.append("command"),
                    at_end=lambda: order.append("end"))  # fmt: skip
    read(device, sink)
    assert order.count("end") == 1
    assert order[-1] == "end"
    assert len(order) >= 20


def test_reading_ends_by_itself_at_its_time():
    stream, sink = Stream(), Kept()
    reader = Acquisition(Device(stream), sink=sink, start=0.0, clock=stream.clock)
    reader.end_at(0.05)
    reader.start()
    reader._thread.join(20)
    assert not reader._thread.is_alive()
    assert stream.clock.now() == pytest.approx(0.05, abs=0.0011)


@pytest.mark.parametrize("where", ["check", "read"])
def test_an_error_ends_the_reading_and_is_kept(where):
    error = LimitExceeded("force", value=2.0, limit=1.0, unit="N")
    stream, sink = Stream(), Kept()

    def check(samples):
        if samples[0].sequence == 20:
            raise error

    device = Device(stream, check if where == "check" else None)
    with acquiring([device], sink=sink, start=0.0, clock=stream.clock) as readers:
        assert sink.enough.wait(20)
        if where == "read":
            stream.error = error
        readers["legs"]._thread.join(20)
    assert readers["legs"].failure is error
