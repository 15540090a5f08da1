# SPDX-License-Identifier: MIT
"""A byte stream to a twin in the same process: no port, no thread, time by any clock."""

from rig.clock import Clock
from rig.links.byte_link import ByteTwin

STEP = 0.001
"""How often a waiting link looks after its twin [s]."""


class MemoryLink:
    """Bytes to and from a twin that is polled whenever the host reads.

    With a `ManualClock` an hour of streaming passes in seconds, the same in every run. Not
    modelled: baud rate, and bytes that overflow a receive buffer.
    """

    def __init__(self, twin: ByteTwin, *, clock: Clock) -> None:
        self._twin = twin
        self._clock = clock
        self._outbox = bytearray()

    @property
    def source(self) -> str:
        """What is simulated."""
        return self._twin.source

    @property
    def reconnected(self) -> int:
        """Never: memory stays."""
        return 0

    def open(self) -> None:
        """Do nothing: the twin is there."""

    def close(self) -> None:
        """Let the twin have what was written last."""
        self._poll()

    def read(self, timeout: float) -> bytes:
        """Hand on what the twin sends, letting at most `timeout` pass [s]."""
        end = self._clock.now() + timeout
        while not (data := self._poll()):
            left = end - self._clock.now()
            if left <= 0:
                return b""
            self._clock.sleep(min(STEP, left))
        return data

    def write(self, data: bytes) -> bool:
        """Keep bytes for the twin's next poll; always taken."""
        self._outbox += data
        return True

    def _poll(self) -> bytes:
        received = bytes(self._outbox)
        self._outbox.clear()
        return self._twin.poll(self._clock.now(), received)
