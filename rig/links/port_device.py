# SPDX-License-Identifier: MIT
"""The device at a serial port: exclusive use of its terminal, and which USB device it is."""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Final, NamedTuple

import serial
from serial.tools import list_ports

from rig.errors import DeviceMismatch, LinkError

_ASK_EXCLUSIVE: Final = 0x80045440
"""TIOCGEXCL of Linux, which Python does not name: whether a terminal is in exclusive use."""
_PSEUDO_TERMINALS = "/dev/pts/"
"""Beginning of the paths of pseudo-terminals, whose exclusive use outlives the program that set it
as long as the twin at the other end lives."""


class UsbDevice(NamedTuple):
    """What tells a USB device from others of its kind.

    Attributes:
        ids: Vendor, product, serial number if it has one, and number of the interface.
        place: Bus and sockets that it is plugged into, such as `1-1.4`.
        unique: Whether it has a serial number that no other connected device of its kind has.
    """

    ids: str
    place: str
    unique: bool = False

    def is_same(self, other: "UsbDevice") -> bool:
        """Return whether another reading is of the same device; of those not unique by place."""
        unique = self.unique and other.unique
        return self.ids == other.ids and (unique or self.place == other.place)


class PortDevice:
    """The device at a serial port: taken for this program, and not replaced by another.

    Ports are numbered in the order in which devices appear: two that were unplugged may come back
    each at the other's port.

    Args:
        name: Name of the port.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._first: UsbDevice | None = None

    def take(self, port: serial.Serial, close: Callable[[], None], *, again: bool) -> None:
        """Take exclusive use of a port just opened, and check that its device is the same.

        Args:
            port: The port.
            close: Closes the port; called before an error is raised.
            again: Whether the device must be that of before; else it is remembered.

        Raises:
            DeviceMismatch: It is another USB device.
            LinkError: Another program has exclusive use, or it is not known yet which USB device is
                there.
        """
        try:
            _claim_terminal(port)
            self._require_same(again=again)
        except BaseException:
            close()
            raise

    def _require_same(self, *, again: bool) -> None:
        found = usb_device(self._name)
        if not again or self._first is None:
            self._first = found
        elif found is None:
            raise LinkError(f"the USB device at port {self._name} is not known yet")
        elif not found.is_same(self._first):
            raise DeviceMismatch(
                f"another USB device has come back at port {self._name}: found {found}, expected "
                f"{self._first}; name the port by its link in /dev/serial/by-id or by-path"
            )


def usb_device(port: str) -> UsbDevice | None:
    """Return which USB device is at a serial port; None for other ports, or if it just goes."""
    try:
        found = {each.device: each for each in list_ports.comports() if each.vid is not None}
    except (OSError, TypeError, ValueError):  # a device was unplugged meanwhile
        return None
    place, ids = {}, {}
    for name, each in found.items():
        place[name], _, interface = (each.location or "").partition(":")
        ids[name] = f"{each.vid:04x}:{each.pid:04x} {each.serial_number or ''} {interface}"
    name = port if port in found else os.path.realpath(port)
    if name not in found:
        return None
    unique = bool(found[name].serial_number) and list(ids.values()).count(ids[name]) == 1
    return UsbDevice(ids[name].strip(), place[name], unique)


def _claim_terminal(port: serial.Serial) -> None:
    """Take exclusive use of a terminal (TIOCEXCL), in all containers, until the port is closed.

    Without effect on other systems than Linux, on pseudo-terminals and on URLs. Raises LinkError
    where another program has it, which does not keep root from opening the port.
    """
    if sys.platform != "linux":
        return
    import fcntl
    import termios

    path = os.path.realpath(str(port.port))
    if not path.startswith("/dev/") or path.startswith(_PSEUDO_TERMINALS):
        return
    in_use = bytearray(4)
    with suppress(OSError):  # the number is another on some processors
        fcntl.ioctl(port.fileno(), _ASK_EXCLUSIVE, in_use)
    if any(in_use):
        raise LinkError("another program has exclusive use of it")
    fcntl.ioctl(port.fileno(), termios.TIOCEXCL)
