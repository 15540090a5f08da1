# SPDX-License-Identifier: MIT
"""Base of streams over one link, which is open while the stream is entered."""

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
            LinkError: There is no such port, or no permission to open it.
        """
        ...

    def close(self) -> None:
        """Close the link; a second call has no effect."""
        ...


LinkT = TypeVar("LinkT", bound=Link)


class LinkedStream(Generic[LinkT]):
    """A stream over one link, as a context manager.

    Args:
        link: The link.
        name: Name of the stream.
        clock: Host time.
    """

    def __init__(self, link: LinkT, *, name: str, clock: Clock) -> None:
        self.name = name
        self._link = link
        self._clock = clock
        self._received = 0
        self._refused = 0

    @property
    def source(self) -> str:
        """Origin of the samples: `real` or `sim:WHAT`."""
        return self._link.source

    def __enter__(self) -> Self:
        self._link.open()
        return self

    def __exit__(self, *exception: object) -> None:
        self._link.close()
