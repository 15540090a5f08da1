# SPDX-License-Identifier: MIT
"""Real ports of this machine with twins behind them: pseudo-terminal, loopback socket, bus."""

import time

import can
import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.backends import leg_driver, leg_link
from rig.clock import ManualClock
from rig.device import iterate
from rig.errors import LinkError, RigTimeout
from rig.links.can import CanLink
from rig.links.serial import SerialLink
from rig.links.serve import PortServer, Ticker
from rig.links.udp import UdpLink
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile

PROFILE = load_leg_profile("zebro-100-serial")
TIMES = np.linspace(0, 60, 601)
GAIT = SampledReference(TIMES, np.outer(TIMES, np.full(6, 4.0)))


def server(**options):
    return PortServer(robot_twin(PROFILE, GAIT, rng=np.random.default_rng(0)), **options)


@pytest.mark.parametrize("as_socket", [False, True])
def test_a_device_unplugged_and_back_is_a_counted_gap_and_the_reading_goes_on(as_socket, take):
    with server(as_socket=as_socket) as port:
        link = leg_link(PROFILE, port.port, source="sim:zebro")
        with leg_driver(PROFILE, link) as stream:
            before = take(stream, 20)
            port.unplug()
            during = list(iterate(stream, duration=0.3))
            port.plug_in()
            after = take(stream, 20)
        counters = stream.counters
    assert port.failure is None
    assert len(during) < 10
    assert counters.reconnected == 1
    assert counters.lost > 15
    assert counters.received + counters.lost == after[-1].sequence - before[0].sequence + 1
    assert counters.restarted == 0


def test_a_lost_port_makes_reads_wait_no_longer_than_they_may():
    with server() as port, leg_driver(PROFILE, leg_link(PROFILE, port.port)) as stream:
        stream.read(0.1)
        port.unplug()
        stream.read(0.1)
        for wait in (0.0, 0.05, 0.4):
            began = time.monotonic()
            assert stream.read(wait) == []
            assert time.monotonic() - began < wait + 0.1
        assert stream.stop() is False


def test_a_missing_port_is_an_error_that_names_it():
    with pytest.raises(LinkError, match="/dev/no-such-port"):
        SerialLink("/dev/no-such-port", baudrate=9600).open()


def test_a_port_has_one_reader_only():
    with server() as port, SerialStream(port.port), pytest.raises(LinkError, match="no other"):
        SerialLink(port.port, baudrate=9600).open()


class SerialStream(SerialLink):
    def __init__(self, port):
        super().__init__(port, baudrate=9600)

    def __enter__(self):
        self.open()
        return self

    def __exit__(self, *_):
        self.close()


def test_closing_twice_is_no_fault():
    with server() as port:
        link = SerialLink(port.port, baudrate=9600)
        link.open()
        link.close()
        link.close()


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


def test_a_name_without_address_is_an_error_that_names_it():
    with pytest.raises(LinkError, match="no such host"):
        UdpLink("no such host", 1).open()


def test_nobody_at_a_udp_port_is_silence_within_the_limit():
    link = UdpLink("127.0.0.1", 9)
    link.open()
    link.write(b"hello")
    began = time.monotonic()
    assert link.read(0.1) == []
    assert time.monotonic() - began < 0.3
    link.close()


def test_a_twin_that_raises_is_kept_for_its_owner_to_see(wait_until):
    def fail(now):
        raise RuntimeError("broken")

    with Ticker(fail) as ticker:
        wait_until(lambda: ticker.failure)
    assert isinstance(ticker.failure, RuntimeError)
