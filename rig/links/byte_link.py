# SPDX-License-Identifier: MIT
"""Protocols of a link to a device and of its twin at the other end; streams over a link."""

from typing import Generic, Protocol, Self, TypeVar

from rig.clock import Clock


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


LinkT = TypeVar("LinkT", bound=Link)


class LinkedStream(Generic[LinkT]):
    """A stream over one link, as a context manager.

    Args:
        link: Link to the device, opened on entering and closed on leaving.
        name: Name of the stream.
        clock: Host time.

    Attributes:
        name: Name of the stream.
        source: Origin of the samples: `real` or `sim:WHAT`.
    """

    def __init__(self, link: LinkT, *, name: str, clock: Clock) -> None:
        self.name = name
        self.source = link.source
        self._link = link
        self._clock = clock
        self._received = 0
        self._refused = 0

    def __enter__(self) -> Self:
        self._link.open()
        return self

    def __exit__(self, *exception: object) -> None:
        self._link.close()


STEP = 0.001
"""Interval at which a waiting link polls its twin [s]."""


class MemoryLink:
    """Byte link that polls its twin whenever the host reads.

    With a `ManualClock` an hour of streaming takes seconds and is reproducible. Not modelled: baud
    rate, and overflow of a receive buffer.

    Args:
        twin: Simulated device at the other end.
        clock: Host time, which is passed to the twin and used for waiting.
    """

    def __init__(self, twin: ByteTwin, *, clock: Clock) -> None:
        self.source = twin.source
        self.reconnected = 0  # it cannot disconnect
        self._twin = twin
        self._clock = clock
        self._outbox = bytearray()

    def open(self) -> None:
        """Do nothing: the twin is always connected."""

    def close(self) -> None:
        """Pass the last written bytes to the twin, and discard the bytes that it sends."""
        self._poll()

    def read(self, timeout: float) -> bytes:
        """Return the bytes that the twin sends, waiting at most `timeout` for the first [s]."""
        end = self._clock.now() + timeout
        while not (data := self._poll()):
            left = end - self._clock.now()
            if left <= 0:
                return b""
            self._clock.sleep(min(STEP, left))
        return data

    def write(self, data: bytes) -> bool:
        """Buffer bytes for the twin's next poll; always returns True."""
        self._outbox += data
        return True

    def _poll(self) -> bytes:
        """Pass the written bytes to the twin, and return those that it sends up to now."""
        received = bytes(self._outbox)
        self._outbox.clear()
        return self._twin.poll(self._clock.now(), received)
