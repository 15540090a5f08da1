# SPDX-License-Identifier: MIT
"""Protocols of a byte stream to a device, and of the simulated device at its other end."""

from typing import Protocol


class Link(Protocol):
    """A connection that is opened and closed: a serial port, a CAN bus, a socket."""

    @property
    def source(self) -> str:
        """Origin of the data: `real` or `sim:WHAT`."""
        ...

    def open(self) -> None:
        """Open the link.

        Raises:
            LinkError: There is no such port, no permission to open it, or another program has it.
        """
        ...

    def close(self) -> None:
        """Close the link; a second call has no effect."""
        ...


class ByteLink(Link, Protocol):
    """Link that carries bytes to and from one device."""

    @property
    def reconnected(self) -> int:
        """Number of times that the link came back after a disconnection."""
        ...

    def read(self, timeout: float) -> bytes:
        """Return the bytes that have arrived, waiting at most `timeout` for the first [s].

        A disconnected link returns no bytes and tries to reconnect.
        """
        ...

    def write(self, data: bytes) -> bool:
        """Send bytes; return whether the link took them, False while it is disconnected.

        Raises:
            RigTimeout: The port accepts no bytes within its timeout.
        """
        ...


class ByteTwin(Protocol):
    """Simulated device at the far end of a byte stream.

    It has neither thread nor clock: the caller passes the time. The same twin therefore runs step
    by step in a test, and behind a pseudo-terminal in real time.
    """

    @property
    def source(self) -> str:
        """Origin of the twin's data, as in manifests: `sim:WHAT`."""
        ...

    def poll(self, now: float, received: bytes) -> bytes:
        """Pass the bytes that the host sent, and return those that the device sends up to a time.

        Args:
            now: Time, never decreasing [s].
            received: Bytes from the host since the last poll.

        Returns:
            Bytes to the host since the last poll.
        """
        ...
