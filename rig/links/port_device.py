# SPDX-License-Identifier: MIT
"""The device at a serial port: exclusive use of its terminal, and which USB device it is."""

import os
import sys
from collections.abc import Callable
from contextlib import ExitStack, suppress
from typing import Final

import serial
from serial.tools import list_ports
from serial.tools.list_ports_common import ListPortInfo

from rig.errors import DeviceMismatch, LinkError

_ASK_EXCLUSIVE: Final = 0x80045440
"""TIOCGEXCL of Linux, which Python does not name: whether a terminal is in exclusive use."""
_PSEUDO_TERMINALS = "/dev/pts/"
"""Beginning of the paths of pseudo-terminals, whose exclusive use outlives the program that set it
as long as the twin at the other end lives."""


def take_port(
    port: serial.Serial, close: Callable[[], object], *, expected: str | None = None
) -> str | None:
    """Take exclusive use of a port just opened, and return which USB device is there.

    Ports are numbered in the order in which devices appear: two that were unplugged may come back
    each at the other's port.

    Args:
        port: The port.
        close: Closes the port; called before an error is raised.
        expected: USB device that was there before; None for any, or where there was none.

    Raises:
        DeviceMismatch: Another one is there now.
        LinkError: Another program has exclusive use of the port, or it is unplugged again.
    """
    with ExitStack() as failed:
        failed.callback(close)
        _claim_terminal(port)
        found = usb_device(str(port.port))
        if expected not in {None, found}:
            problem = (
                f"another USB device has come back at port {port.port}: found {found}, expected "
                f"{expected}; name the port by its link in /dev/serial/by-id"
            )
            raise DeviceMismatch(problem) if found else LinkError(problem)
        failed.pop_all()
    return found


def usb_device(port: str) -> str | None:
    """Describe the USB device at a serial port, as no other is described; None for other ports.

    By vendor, product and serial number; where there is none, or another port has the same, by the
    socket that it is plugged into, too.

    Raises:
        LinkError: A device was unplugged meanwhile.
    """
    try:
        found = {each.device: each for each in list_ports.comports() if each.vid is not None}
    except TypeError as gone:
        raise LinkError("a device was unplugged meanwhile") from gone
    own = found.get(port) or found.get(os.path.realpath(port))
    if own is None:
        return None
    alike = [_ids(each) for each in found.values()].count(_ids(own))
    return _ids(own) + ("" if own.serial_number and alike == 1 else f" in socket {own.location}")


def _ids(device: ListPortInfo) -> str:
    """Return vendor, product and serial number of a USB device."""
    return f"{device.vid:04x}:{device.pid:04x} {device.serial_number or 'without serial number'}"


def _claim_terminal(port: serial.Serial) -> None:
    """Take exclusive use of a terminal (TIOCEXCL), in all containers, until the port is closed.

    Without effect on other systems than Linux, on pseudo-terminals and on URLs. Raises LinkError
    where another program has it, which does not keep root from opening the port.
    """
    if sys.platform != "linux":
        return
    import fcntl
    import termios

    name = str(port.port)
    if not name.startswith("/") or os.path.realpath(name).startswith(_PSEUDO_TERMINALS):
        return
    in_use = bytearray(4)
    with suppress(OSError):  # the number is another on some processors
        fcntl.ioctl(port.fileno(), _ASK_EXCLUSIVE, in_use)
    if any(in_use):
        raise LinkError("another program has exclusive use of it")
    fcntl.ioctl(port.fileno(), termios.TIOCEXCL)
