# SPDX-License-Identifier: MIT
"""A bus that is missing, fails and comes back; the times of its frames."""

import time

import can
import numpy as np
import pytest

from rig.clock import ManualClock
from rig.errors import LinkError, RigTimeout
from rig.links.can import CanLink


@pytest.mark.parametrize("channel", ["no-such-interface:0", "socketcan:no-such-bus"])
def test_a_missing_bus_is_an_error_that_names_it(channel):
    with pytest.raises(LinkError, match=channel):
        CanLink(channel).open()


def test_a_bus_that_fails_comes_back():
    class Failing(can.BusABC):
        def __init__(self):
            self.channel_info = "failing"
            super().__init__(channel="x")

        def send(self, msg, timeout=None):
            raise can.CanOperationError("bus off")

        def _recv_internal(self, timeout):
            raise can.CanOperationError("bus off")

    link = CanLink("virtual:back-again")
    link.open()
    link._bus.shutdown()
    link._bus = Failing()
    with pytest.raises(RigTimeout, match="bus off"):
        link.write(1, b"")
    assert link.read(0.01) == []
    assert link.read(0.0) == []
    assert link.read(0.5) == []
    assert link.reconnected == 1
    link.close()


def frame(age):
    return can.Message(arbitration_id=1, timestamp=time.time() - age)


def test_frames_are_dated_by_their_arrival_and_not_by_when_they_were_read():
    clock = ManualClock(100.0)
    link = CanLink("virtual:dated", clock=clock)
    clock.sleep(0.4)
    dated = link.arrivals([frame(0.3), frame(0.2), frame(0.05)])
    np.testing.assert_allclose(dated, [100.1, 100.2, 100.35], atol=0.02)
    assert link.arrivals([]) == []


def test_a_frame_that_waited_for_seconds_is_not_dated_as_new(monkeypatch):
    clock = ManualClock(100.0)
    link = CanLink("virtual:dated", clock=clock)
    link.open()
    assert link.read(0.0) == []
    waited = can.Message(arbitration_id=1, timestamp=time.time())
    monkeypatch.setattr("rig.links.can.time.time", lambda: waited.timestamp + 2.0)
    clock.sleep(2.0)
    np.testing.assert_allclose(link.arrivals([waited]), [100.0], atol=0.02)
    link.close()


@pytest.mark.parametrize("age", [-3600.0, 3600.0, 1.7e9], ids=["ahead", "behind", "from zero"])
def test_a_stamp_of_another_clock_dates_no_frame(age):
    link = CanLink("virtual:dated", clock=ManualClock(100.0))
    assert link.arrivals([frame(age)]) == [100.0]


def test_frames_without_a_stamp_are_spread_over_the_time_since_the_bus_was_empty():
    clock = ManualClock(100.0)
    link = CanLink("slcan:/x", clock=clock)
    clock.sleep(0.4)
    np.testing.assert_allclose(link.arrivals(4 * [frame(0.0)]), [100.1, 100.2, 100.3, 100.4])


def test_dates_of_frames_never_run_back():
    clock = ManualClock(100.0)
    link = CanLink("virtual:dated", clock=clock)
    clock.sleep(1.0)
    first = link.arrivals([frame(0.1)])
    assert link.arrivals([frame(0.9), frame(0.0)])[0] == first[0]
