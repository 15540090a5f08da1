# SPDX-License-Identifier: MIT
"""A port is one program's, and a link stays with the USB device that it opened."""

import os
import sys
import time
from types import SimpleNamespace

import can
import pytest
from serial.tools import list_ports

from rig.errors import DeviceMismatch, LinkError
from rig.links import port_device
from rig.links.can import CanLink
from rig.links.port_device import usb_device
from rig.links.serial import SerialLink
from rig.links.serve import PortServer
from rig.links.slcan import SlcanAdapter

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="exclusive use is asked for on Linux")


class Chatter:
    """A twin that sends its name; satisfies `ByteTwin`."""

    source = "sim:chatter"

    def poll(self, now, received):
        return b"a"


def usb(device, serial="7", place="1-1", **others):
    known = {"vid": 0x10C4, "pid": 0xEA60, "serial_number": serial, "location": place}
    return SimpleNamespace(device=device, **known | others)


@pytest.fixture(name="plugged")
def _plugged(monkeypatch):
    """Return the list of USB devices that are plugged in, empty as yet."""
    found = []
    monkeypatch.setattr(list_ports, "comports", lambda: list(found))
    return found


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ({"serial": "7"}, {"serial": "8"}),
        ({"serial": None}, {"serial": None, "place": "1-2"}),
        ({}, {"pid": 0x6001}),
    ],
)
def test_another_device_at_the_port_is_refused_and_no_byte_of_it_is_read(plugged, before, after):
    with PortServer(Chatter()) as server:
        link = SerialLink(server.port, baudrate=9600)
        plugged[:] = [usb(server.port, **before)]
        link.open()
        try:
            assert link.read(1.0)
            lose(server, link)
            plugged[:] = [usb(server.port, **after)]
            server.plug_in()
            for _ in range(2):
                with pytest.raises(DeviceMismatch, match="another USB device") as said:
                    read_on(link)
                assert "\n" not in str(said.value)
            assert link.reconnected == 0
            plugged[:] = [usb(server.port, **before)]
            assert read_on(link)
        finally:
            link.close()


def lose(server, link):
    """Unplug a device, and let its link notice that."""
    server.unplug()
    while link.read(0.02):
        pass


def read_on(link):
    """Return the next bytes of a link that is to be connected again, none after seconds."""
    return next((data for _ in range(100) if (data := link.read(0.05))), b"")


@pytest.mark.parametrize(
    ("before", "after", "others"),
    [
        ({}, {"place": "1-2"}, []),
        ({"serial": None}, {"serial": None}, []),
        ({"serial": "0001"}, {"serial": "0001"}, [{"serial": "0001", "place": "1-3"}]),
    ],
)
def test_the_same_device_is_taken_back(plugged, before, after, others):
    with PortServer(Chatter()) as server:
        more = [usb(f"/dev/other{number}", **other) for number, other in enumerate(others)]
        link = SerialLink(server.port, baudrate=9600)
        plugged[:] = [usb(server.port, **before), *more]
        link.open()
        try:
            lose(server, link)
            plugged[:] = more  # the port is there before its device is known
            server.plug_in()
            assert link.read(0.3) == link.read(0.3) == b""
            plugged[:] = [usb(server.port, **after), *more]
            assert read_on(link)
            assert link.reconnected == 1
        finally:
            link.close()


def test_devices_that_have_the_same_serial_number_are_told_by_their_sockets(plugged):
    plugged[:] = [usb("/dev/a", "0001", "1-1"), usb("/dev/b", "0001", "1-2"), usb("/dev/c", "7")]
    assert len({usb_device(each.device) for each in plugged}) == 3
    before = usb_device("/dev/c")
    plugged[2] = usb("/dev/d", "7", "1-5")
    assert usb_device("/dev/d") == before
    assert usb_device("/dev/ttyS0") is None


def test_a_device_that_goes_while_the_ports_are_listed_is_a_link_error(monkeypatch):
    monkeypatch.setattr(list_ports, "comports", lambda: int(None, 16))  # as pyserial's does
    with pytest.raises(LinkError, match="unplugged"):
        usb_device("/dev/a")


def test_an_adapter_of_a_bus_is_not_replaced_by_another(plugged, monkeypatch):
    at_once = SimpleNamespace(sleep=lambda _: None, time=time.time)  # it waits 2 s for a real one
    monkeypatch.setattr("can.interfaces.slcan.time", at_once)
    bus = can.Bus(interface="virtual", channel="port device")
    with bus, PortServer(SlcanAdapter(bus, source="sim:bus")) as server:
        link = CanLink(f"slcan:{server.port}")
        plugged[:] = [usb(server.port, "7")]
        link.open()
        try:
            lose(server, link)
            plugged[:] = [usb(server.port, "8")]
            server.plug_in()
            with pytest.raises(DeviceMismatch, match="another USB device"):
                read_on(link)
        finally:
            link.close()


@LINUX
def test_a_port_in_exclusive_use_is_refused_in_words_also_to_root(monkeypatch):
    import fcntl
    import termios

    monkeypatch.setattr(port_device, "_PSEUDO_TERMINALS", "/no such folder/")
    with PortServer(Chatter()) as server:
        link = SerialLink(server.port, baudrate=9600)
        handle = os.open(os.path.realpath(server.port), os.O_RDWR | os.O_NOCTTY)
        try:
            fcntl.ioctl(handle, termios.TIOCEXCL)
            with pytest.raises(LinkError, match=r"exclusive use|busy"):
                link.open()
            fcntl.ioctl(handle, termios.TIOCNXCL)
            link.open()
            answer = bytearray(4)
            fcntl.ioctl(handle, port_device._ASK_EXCLUSIVE, answer)
            assert any(answer)
        finally:
            link.close()
            os.close(handle)
