# SPDX-License-Identifier: MIT
"""A serial port that goes and comes back, and ports that are not there."""

import time

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.backends import leg_driver, leg_link
from rig.device import iterate
from rig.errors import LinkError
from rig.links.serial import SerialLink
from rig.links.serve import PortServer
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
