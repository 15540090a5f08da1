# SPDX-License-Identifier: MIT
"""Twins served at a port."""

import os

import pytest
import serial

from rig.links.serve import PortServer, Ticker


class Echo:
    """A twin that sends every byte back, in upper case."""

    source = "sim:echo"

    def poll(self, now, received):
        return received.upper()


def answer(port: str, request: bytes) -> bytes:
    """Send bytes to a port as any program does, and return as many as come back."""
    with serial.serial_for_url(port, timeout=5.0) as client:
        client.write(request)
        return client.read(len(request))


@pytest.mark.parametrize("as_socket", [False, True])
def test_any_program_reaches_a_twin_at_its_port(as_socket):
    raw = b"\x03\x04\r\n\x11\x13abc"  # a terminal that is not raw changes or swallows these
    with PortServer(Echo(), as_socket=as_socket) as server:
        assert server.port.startswith("socket://127.0.0.1:") == as_socket
        assert answer(server.port, raw) == raw.upper()
        assert answer(server.port, b"again") == b"AGAIN"
        assert server.failure is None


@pytest.mark.parametrize("as_socket", [False, True])
def test_a_port_comes_back_under_its_name(as_socket):
    with PortServer(Echo(), as_socket=as_socket) as server:
        port = server.port
        server.unplug()
        with pytest.raises(serial.SerialException):
            serial.serial_for_url(port, timeout=0.1)
        server.plug_in()
        assert server.port == port
        assert answer(port, b"back") == b"BACK"
    assert not os.path.lexists(port)


def test_a_twin_that_raises_is_kept_for_its_owner_to_see(wait_until):
    def fail(now):
        raise RuntimeError("broken")

    with Ticker(fail) as ticker:
        wait_until(lambda: ticker.failure)
    assert isinstance(ticker.failure, RuntimeError)
