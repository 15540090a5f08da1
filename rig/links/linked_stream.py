# SPDX-License-Identifier: MIT
"""Base of streams over one link, which is open while the stream is entered."""

from typing import Generic, Self, TypeVar

from rig.clock import Clock
from rig.links.byte_link import Link

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
