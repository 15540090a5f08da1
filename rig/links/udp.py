# SPDX-License-Identifier: MIT
"""UDP link to one device: datagrams are read in bulk from a large socket buffer."""

import contextlib
import select
import socket
from typing import Final

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import LinkError
from rig.exclusive import device_lock

BUFFER: Final = 4 << 20
"""Size of the socket buffer: seconds of a fast load cell, in case the reader is delayed [bytes]."""
LONGEST: Final = 1472
"""Longest datagram, that of an Ethernet frame; longer ones are truncated [bytes]."""
MAX_PER_READ: Final = 8192
"""Largest number of datagrams of one read."""


class UdpLink:
    """Datagrams to and from one address; the system drops those of other senders.

    Args:
        host: Name or address of the device.
        port: UDP port of the device.
        gather: Time for which datagrams accumulate before a read takes them all: waking up for
            each of 7,000 per second takes several times the CPU time [s].
        source: `real`, or `sim:WHAT` for a twin's address.
        clock: Host time.

    Attributes:
        address: `HOST:PORT`, for messages.
    """

    def __init__(
        self,
        host: str,
        port: int,
        *,
        gather: float = 0.004,
        source: str = "real",
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self.source = source
        self.address = f"{host}:{port}"
        self._host = host
        self._port = port
        self._gather = gather
        self._clock = clock
        self._socket: socket.socket | None = None
        self._lock = device_lock(f"udp:{self.address}")
        self._read_at = 0.0

    def open(self) -> None:
        """Lock the device and open the socket; the device need not be connected yet.

        Raises:
            InUse: Another program has the lock; the message says which.
            LinkError: The host name is unknown, or there is no network.
            OSError: The lock or a socket cannot be created.
        """
        self._lock.take()
        opened = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
            opened.connect((self._host, self._port))
            opened.setblocking(False)
        except OSError as problem:
            opened.close()
            self._lock.release()
            raise LinkError(
                f"cannot reach the device at {self.address}: {problem}; check address and network"
            ) from problem
        self._socket = opened

    def close(self) -> None:
        """Close the socket and release the device's lock; a second call has no effect."""
        opened, self._socket = self._socket, None
        if opened is not None:
            opened.close()
        self._lock.release()

    def read(self, timeout: float) -> list[bytes]:
        """Return the available datagrams, waiting at most `timeout` for the first [s].

        With a timeout, a read less than `gather` after the last one waits a little longer, so that
        datagrams accumulate. One call returns at most `MAX_PER_READ`; each is cut to `LONGEST`. A
        closed link returns none at once.
        """
        opened = self._socket
        if opened is None or not select.select([opened], [], [], timeout)[0]:
            return []
        gathered = self._clock.now() - self._read_at
        if timeout > 0 and gathered < self._gather:
            self._clock.sleep(min(self._gather - gathered, timeout))
        self._read_at = self._clock.now()
        datagrams: list[bytes] = []
        receive, keep = opened.recv, datagrams.append
        with contextlib.suppress(BlockingIOError):
            for _ in range(MAX_PER_READ):
                try:
                    keep(receive(LONGEST))
                except ConnectionRefusedError:  # no device at the port yet; it may start later
                    continue
        return datagrams

    def write(self, data: bytes) -> bool:
        """Send one datagram; return whether the system accepted it, False while not open."""
        if self._socket is None:
            return False
        try:
            self._socket.send(data)
        except OSError:
            return False
        return True
