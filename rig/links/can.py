# SPDX-License-Identifier: MIT
"""CAN bus link: frames are read in bulk by the calling thread, and every wait has a timeout.

`can.Notifier` is not used: its thread ends silently when a listener raises.
"""

import contextlib
import math
import time
from collections.abc import Sequence
from itertools import accumulate
from typing import TYPE_CHECKING, Final, cast

import can

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import DeviceMismatch, LinkError, RigTimeout
from rig.exclusive import Exclusive, device_lock
from rig.links.port_device import take_port

if TYPE_CHECKING:
    import serial
    from can.interfaces.slcan import slcanBus

WRITE_TIMEOUT: Final = 0.5
"""Longest wait until the bus takes a frame [s]."""
RETRY_AFTER: Final = 0.25
"""Interval between attempts to reopen a lost bus [s]."""
MAX_PER_READ: Final = 4096
"""Largest number of frames of one read."""
LONGEST_READ: Final = 0.05
"""Longest duration of one read beyond its timeout; more frames may still wait [s]."""
STAMPED: Final = frozenset({"socketcan", "virtual"})
"""Interfaces whose frame time stamps are arrival times by the system's clock."""
STAMP_ERROR: Final = 0.001
"""Tolerance of a time stamp, because both clocks are read one after the other [s]."""


class CanLink:
    """Frames to and from a CAN bus.

    Args:
        channel: `INTERFACE:CHANNEL` as python-can names them, such as `socketcan:can0`, or an open
            bus, which is then used and closed but never reopened.
        bitrate: Bit rate, for interfaces that set it [bit/s].
        source: `real`, or `sim:WHAT` for a bus with twins on it.
        clock: Host time.

    Attributes:
        reconnected: Number of times that the bus came back after it failed.
        damaged: Number of error frames that the bus reported, and of invalid lines of an adapter.
    """

    def __init__(
        self,
        channel: "str | can.BusABC",
        *,
        bitrate: int = 1_000_000,
        source: str = "real",
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self.source = source
        self.reconnected = 0
        self.damaged = 0
        self._channel = channel
        self._bitrate = bitrate
        self._clock = clock
        self._bus: can.BusABC | None = None
        self._lock = _bus_lock(channel)
        self._usb: str | None = None
        self._retry_at = 0.0
        self._last_arrival = -math.inf
        self._empty_at = self._since = clock.now()

    def open(self) -> None:
        """Lock and open the bus, so that no other program uses it.

        Raises:
            InUse: Another program has the bus; the message says which.
            LinkError: There is no such bus, its name is invalid, permission is missing, or the
                interface's Python package is not installed.
            OSError: The lock cannot be created.
        """
        if self._lock is not None:
            self._lock.take()
        self._usb = None
        try:
            self._bus = self._connect()
            self._empty_at = self._since = self._clock.now()
        except (can.CanError, OSError, ValueError, ImportError) as problem:
            self.close()
            raise LinkError(
                f"cannot open CAN bus {self._channel}: {problem}; give the bus as "
                "INTERFACE:CHANNEL, such as socketcan:can0, and bring it up first"
            ) from problem

    def close(self) -> None:
        """Close the bus and release its lock; a second call has no effect."""
        self._disconnect()
        if self._lock is not None:
            self._lock.release()

    def _disconnect(self) -> None:
        """Close the bus, if it is open; keep its lock."""
        bus, self._bus = self._bus, None
        if bus is not None:
            with contextlib.suppress(
                can.CanError, OSError
            ):  # an adapter that is disconnected raises again
                bus.shutdown()

    def read(self, timeout: float) -> list[can.Message]:
        """Return the data frames that have arrived, waiting at most `timeout` for the first [s].

        Only frames with 11-bit ids are returned, at most `MAX_PER_READ` of them; remote and damaged
        frames are discarded. While the bus is disconnected the call tries to reopen it, at most
        every `RETRY_AFTER`, and returns no frames without success.

        Raises:
            DeviceMismatch: Another USB adapter than that which was opened is at the bus's port.
        """
        if self._bus is None and not self._reconnect(timeout):
            return []
        messages: list[can.Message] = []
        self._since = self._empty_at
        try:
            if self._bus is not None:
                self._drain(self._bus, timeout, messages)
        except (can.CanError, OSError):
            self._drop_connection()
        return messages

    def arrivals(self, messages: Sequence[can.Message]) -> list[float]:
        """Estimate the arrival time of each frame just read, by host time, non-decreasing [s].

        A frame arrived between the moment at which the bus was last found empty and now. Its time
        stamp gives the arrival where the interface takes it from the system's clock, as the kernel
        does for socketcan, and it lies in that interval up to `STAMP_ERROR`. Otherwise the frames
        are spread evenly over the interval.
        """
        now, wall = self._clock.now(), time.time()
        longest = now - self._since
        arrived = []
        for count, message in enumerate(messages, 1):
            age = wall - message.timestamp
            if not (self._stamped and -STAMP_ERROR <= age <= longest + STAMP_ERROR):
                age = longest * (1 - count / len(messages))
            arrived.append(now - max(age, 0.0))
        times = list(accumulate(arrived, max, initial=self._last_arrival))
        self._last_arrival = times[-1]
        return times[1:]

    def write(self, can_id: int, data: bytes) -> bool:
        """Send a frame with an 11-bit id.

        Args:
            can_id: Arbitration id, 11 bits.
            data: At most 8 bytes.

        Returns:
            Whether the frame was sent; False while the bus is disconnected.

        Raises:
            RigTimeout: The bus is there but takes no frame: it is off, or no node acknowledges.
        """
        return self._send(can.Message(arbitration_id=can_id, data=data, is_extended_id=False))

    def request(self, can_id: int, length: int) -> bool:
        """Send a remote frame, which requests a frame with this id.

        Args:
            can_id: Arbitration id, 11 bits.
            length: Length of the requested data [bytes].

        Returns:
            Whether the frame was sent; False while the bus is disconnected.

        Raises:
            RigTimeout: The bus is there but takes no frame, as in `write`.
        """
        return self._send(
            can.Message(
                arbitration_id=can_id, dlc=length, is_remote_frame=True, is_extended_id=False
            )
        )

    def _send(self, message: can.Message) -> bool:
        """Send a frame; return False, and begin to reconnect, where the bus is disconnected.

        Raises:
            RigTimeout: The bus takes no frame within `WRITE_TIMEOUT`.
        """
        if self._bus is None:
            return False
        try:
            self._bus.send(message, timeout=WRITE_TIMEOUT)
        except can.CanError as problem:
            raise RigTimeout(
                f"CAN bus {self._channel} did not accept a frame ({problem})",
                waited=WRITE_TIMEOUT, advice="check the termination and power of the bus"
            ) from problem  # fmt: skip
        except OSError:
            self._drop_connection()
            return False
        return True

    @property
    def _stamped(self) -> bool:
        """Whether frames have time stamps by the system's clock.

        They have on the interfaces `STAMPED`, and on a bus that was given open and is no slcan.
        """
        if isinstance(self._channel, str):
            return self._channel.partition(":")[0] in STAMPED
        return _serial_port(self._channel) is None

    def _drain(self, bus: can.BusABC, timeout: float, messages: list[can.Message]) -> None:
        """Append frames to `messages` until none is left, waiting `timeout` [s] for the first.

        Ends after `MAX_PER_READ` frames, or `LONGEST_READ` longer than `timeout`.
        """
        port = _serial_port(bus)
        began, wait = self._clock.now(), timeout
        for _ in range(MAX_PER_READ):
            looked = self._clock.now()
            # An adapter's acknowledgements stand between its frames, and recv gives None for each.
            if wait == 0 and port is not None and not port.in_waiting:
                self._empty_at = looked
                return
            if not self._receive(bus, wait, messages) and port is None:
                self._empty_at = looked
                return
            if looked - began > timeout + LONGEST_READ:
                return
            wait = 0.0

    def _receive(self, bus: can.BusABC, wait: float, messages: list[can.Message]) -> bool:
        """Receive one frame, valid or damaged; return whether there was any within `wait` [s]."""
        try:
            message = bus.recv(wait)
        except (ValueError, LookupError):  # raised by python-can's slcan for a damaged line
            self.damaged += 1
            return True
        except can.CanOperationError as problem:
            if not isinstance(problem.__cause__, UnicodeDecodeError):
                raise
            # Drop a byte of noise, on which python-can's slcan would fail in every later call.
            cast("slcanBus", bus).flush()
            self.damaged += 1
            return True
        if message is not None:
            self._keep(message, messages)
        return message is not None

    def _keep(self, message: can.Message, messages: list[can.Message]) -> None:
        """Append a data frame with an 11-bit id, count a damaged frame, and drop all others."""
        # python-can's slcan returns truncated lines, with fewer data bytes than their length says.
        cut = not message.is_remote_frame and len(message.data) != message.dlc
        if message.is_error_frame or cut:
            self.damaged += 1
        elif not message.is_remote_frame and not message.is_extended_id:
            messages.append(message)

    def _connect(self) -> can.BusABC:
        """Open the bus by its name, or return the one that was given open.

        An adapter on a serial port is opened exclusively, and is that of before.
        """
        if isinstance(self._channel, can.BusABC):
            return self._channel
        interface, _, channel = self._channel.partition(":")
        bus = can.Bus(channel=channel, interface=interface, bitrate=self._bitrate)
        if (port := _serial_port(bus)) is not None:
            self._usb = take_port(port, bus.shutdown, expected=self._usb)
        return bus

    def _drop_connection(self) -> None:
        """Close a bus that failed; `_reconnect` may reopen it after `RETRY_AFTER`."""
        self._disconnect()
        self._retry_at = self._clock.now() + RETRY_AFTER

    def _reconnect(self, timeout: float) -> bool:
        """Try to reopen a lost bus, at most every `RETRY_AFTER`; return whether it is open.

        Waits at most `timeout` [s]. A bus that was given as an object is never reopened. Raises
        DeviceMismatch where another adapter is at its port.
        """
        wait = self._retry_at - self._clock.now()
        self._clock.sleep(min(max(wait, 0.0), timeout))
        if wait > timeout or isinstance(self._channel, can.BusABC):
            return False
        self._retry_at = self._clock.now() + RETRY_AFTER
        try:
            self._bus = self._connect()
        except DeviceMismatch:
            raise
        except (can.CanError, OSError, ValueError):
            return False
        self._empty_at = self._clock.now()
        self.reconnected += 1
        return True


def _serial_port(bus: can.BusABC) -> "serial.Serial | None":
    """Return the serial port of a python-can slcan bus; None for any other bus."""
    return getattr(bus, "serialPortOrig", None)


def _bus_lock(channel: "str | can.BusABC") -> Exclusive | None:
    """Return the lock of a bus; None for an open or virtual bus, which no other program opens.

    An adapter on a serial line is locked as that serial port, however it is opened.
    """
    if isinstance(channel, can.BusABC) or channel.startswith("virtual:"):
        return None
    interface, _, place = channel.partition(":")
    return device_lock(place.partition("@")[0] if interface == "slcan" else channel)
