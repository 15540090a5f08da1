# SPDX-License-Identifier: MIT
"""Byte link to a twin in the same process, without port or thread, with any clock."""

from rig.clock import Clock
from rig.links.byte_link import ByteTwin

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
        received = bytes(self._outbox)
        self._outbox.clear()
        return self._twin.poll(self._clock.now(), received)
