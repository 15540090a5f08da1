# SPDX-License-Identifier: MIT
"""Links and a bus whose next read is what was put into them."""

from collections.abc import Sequence
from typing import Any

import can

from rig.clock import ManualClock


class _Fed:
    """A link that is always open, with what its next read returns."""

    source = "sim:fuzz"
    reconnected = 0

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.data: Any = b""

    def open(self) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""


class Feed(_Fed):
    """A byte link whose next read is what was put into it; satisfies `ByteLink`."""

    def read(self, timeout: float) -> bytes:
        """Return what was put in, once."""
        self.clock.sleep(max(timeout, 0.01))
        data, self.data = self.data, b""
        return data

    def write(self, data: bytes) -> bool:
        """Take bytes."""
        return True


class Answers(Feed):
    """A link whose device answers a request with what was put into it."""

    waiting = b""

    def write(self, data: bytes) -> bool:
        """Let the device answer."""
        self.data, self.waiting = self.waiting, b""
        return True


class Datagrams(_Fed):
    """Like `Feed`, of datagrams."""

    def read(self, timeout: float) -> list[Any]:
        """Return what was put in, once."""
        self.clock.sleep(max(timeout, 0.001))
        data, self.data = self.data, []
        return data or []

    def write(self, data: bytes) -> bool:
        """Take a datagram."""
        return True


class Frames(_Fed):
    """Like `Feed`, of CAN frames."""

    damaged = 0

    def read(self, timeout: float) -> list[can.Message]:
        """Return what was put in, once."""
        self.clock.sleep(max(timeout, 0.001))
        data, self.data = self.data, []
        return data or []

    def arrivals(self, messages: Sequence[can.Message]) -> list[float]:
        """Tell when frames came: now."""
        return [self.clock.now() for _ in messages]

    def write(self, can_id: int, data: bytes) -> bool:
        """Take a frame."""
        return True

    def request(self, can_id: int, length: int) -> bool:
        """Take a request."""
        return True


class NoBus:
    """A bus whose next frame is what was put into it."""

    def __init__(self) -> None:
        self.waiting: list[can.Message] = []

    def recv(self, timeout: float | None) -> can.Message | None:
        """Return the frame put in, if any."""
        return self.waiting.pop() if self.waiting else None

    def send(self, message: can.Message) -> None:
        """Take a frame."""
