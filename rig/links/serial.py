# SPDX-License-Identifier: MIT
"""Serial port link: bulk reads with a timeout, and reconnection after unplugging."""

import contextlib
import os
import select
import time
from typing import Final, cast

import serial

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import DeviceMismatch, LinkError, RigTimeout
from rig.exclusive import device_lock
from rig.links.port_device import take_port

CHUNK: Final = 1 << 16
"""Largest number of bytes of one system call [bytes]."""
MAX_PER_READ: Final = 1 << 18
"""Number of bytes after which one read ends: nearly a second at 3 Mbaud [bytes]."""
RETRY_AFTER: Final = 0.25
"""Interval between attempts to reopen a lost port [s]."""
WRITE_TIMEOUT: Final = 1.0
"""Longest wait until the port takes all bytes [s]."""


class SerialLink:
    """Bytes to and from a serial port, or any URL that pyserial knows (`socket://host:port`).

    A read returns all available bytes, many frames with one system call. A disconnected port is
    closed and reopened while the stream continues; `reconnected` counts how often. Another USB
    device than that which was opened is refused then.

    Args:
        port: Name of the port, or a URL.
        baudrate: Line rate [baud].
        source: `real`, or `sim:WHAT` for a port with a twin behind it.
        clock: Host time.
    """

    def __init__(
        self, port: str, *, baudrate: int, source: str = "real", clock: Clock = SYSTEM_CLOCK
    ) -> None:
        self.port = port
        self.source = source
        self.reconnected = 0
        self._baudrate = baudrate
        self._clock = clock
        self._serial: serial.Serial | None = None
        self._retry_at = 0.0
        self._lock = device_lock(port)
        self._usb: str | None = None

    def open(self) -> None:
        """Lock and open the port, so that no other program uses it.

        Raises:
            InUse: Another program has the port; the message says which.
            LinkError: There is no such port, its name is invalid, or permission is missing.
            OSError: The lock cannot be created.
        """
        self._lock.take()
        self._usb = None
        try:
            self._serial = self._connect()
        except (OSError, ValueError) as problem:
            self._lock.release()
            raise LinkError(
                f"cannot open port {self.port}: {_reason(problem)}; check the cable and the name "
                "of the port, that no other program uses it, and on Linux that your user is in its "
                "group"
            ) from problem

    def close(self) -> None:
        """Close the port and release its lock; a second call has no effect."""
        self._disconnect()
        self._lock.release()

    def read(self, timeout: float) -> bytes:
        """Return the available bytes, waiting at most `timeout` for the first [s].

        A read ends once it has `MAX_PER_READ`. While the port is disconnected the call tries to
        reopen it, at most every `RETRY_AFTER`, and returns nothing without success.

        Raises:
            DeviceMismatch: Another USB device than that which was opened is at the port.
        """
        if self._serial is None and not self._reconnect(timeout):
            return b""
        port = self._serial
        try:
            return _read_all(port) if port is not None and _readable(port, timeout) else b""
        except OSError:  # serial.SerialException is one: unplugged
            self._drop_connection()
            return b""

    def write(self, data: bytes) -> bool:
        """Send bytes; return whether the port took them, False while it is disconnected.

        Raises:
            RigTimeout: The port is connected, but does not take all bytes in `WRITE_TIMEOUT`.
        """
        if self._serial is None:
            return False
        try:
            self._serial.write(data)
        except serial.SerialTimeoutException as problem:
            raise RigTimeout(
                f"port {self.port} did not accept {len(data)} bytes", waited=WRITE_TIMEOUT
            ) from problem
        except OSError:
            self._drop_connection()
            return False
        return True

    def _connect(self) -> serial.Serial:
        """Open the port, exclusively where it is a device; a USB device is that of before."""
        opened = serial.serial_for_url(
            self.port, do_not_open=True, baudrate=self._baudrate, timeout=0,
            write_timeout=WRITE_TIMEOUT,
        )  # fmt: skip
        port = cast("serial.Serial", opened)  # the URL handlers have the same methods
        if not self.port.startswith("socket:"):
            port.exclusive = True  # two readers would each get a part of the bytes
        port.open()
        self._usb = take_port(port, port.close, expected=self._usb)
        return port

    def _disconnect(self) -> None:
        """Close the port, if it is open; keep its lock."""
        port, self._serial = self._serial, None
        if port is not None:
            port.close()

    def _drop_connection(self) -> None:
        """Close a port that failed; `_reconnect` may reopen it after `RETRY_AFTER`."""
        self._disconnect()
        self._retry_at = self._clock.now() + RETRY_AFTER

    def _reconnect(self, timeout: float) -> bool:
        """Try to reopen a lost port, at most every `RETRY_AFTER`; return whether it is open.

        Waits at most `timeout` [s]. Raises DeviceMismatch where another device is at the port.
        """
        wait = self._retry_at - self._clock.now()
        self._clock.sleep(min(max(wait, 0.0), timeout))
        if wait > timeout:
            return False
        self._retry_at = self._clock.now() + RETRY_AFTER
        try:
            self._serial = self._connect()
        except DeviceMismatch:
            raise
        except (OSError, ValueError):
            self._clock.sleep(max(timeout - max(wait, 0.0), 0.0))
            return False
        self.reconnected += 1
        return True


def _read_all(port: serial.Serial) -> bytes:
    """Read the available bytes of a port that has some, until there are `MAX_PER_READ`.

    On Windows, and from a port without a file handle, at most `CHUNK`.

    Raises:
        OSError: The port is disconnected.
    """
    if os.name != "posix" or not hasattr(port, "fileno"):
        return port.read(CHUNK)
    data = _read_once(port)
    with contextlib.suppress(OSError):  # the next read will meet it again
        while len(data) < MAX_PER_READ and _readable(port, 0.0):
            data += _read_once(port)
    return data


def _read_once(port: serial.Serial) -> bytes:
    """Read bytes with one system call, at most 4 KiB from a terminal.

    Raises:
        OSError: The port is disconnected.
    """
    data = os.read(port.fileno(), CHUNK)  # pyserial would call select once more
    if not data:
        raise OSError(f"port {port.port} became readable without bytes: it was unplugged")
    return data


def _readable(port: serial.Serial, timeout: float) -> bool:
    """Return whether a port has bytes to read, waiting at most `timeout` for them [s]."""
    if hasattr(port, "fileno"):
        return bool(select.select([port], [], [], timeout)[0])
    end = time.monotonic() + timeout  # ports of Windows cannot be waited for
    while not port.in_waiting and time.monotonic() < end:
        time.sleep(0.001)
    return bool(port.in_waiting)


def _reason(problem: OSError | ValueError) -> str:
    """Return the system's text for an error with an errno, else the error's own text.

    Pyserial's own text repeats errno and the name of the port.
    """
    number = problem.errno if isinstance(problem, OSError) else None
    return str(problem) if number is None else os.strerror(number)
