# SPDX-License-Identifier: MIT
"""Frames out of a byte stream: found again after damage, and the damage counted."""

from typing import Final, Protocol

from cobs import cobs

DELIMITER: Final = b"\0"


class Framer(Protocol):
    """Finds frames in a stream of bytes.

    Attributes:
        damaged: Frames that were refused so far.
        resynchronised: Times that a good frame followed damaged ones.
    """

    damaged: int
    resynchronised: int

    def feed(self, data: bytes) -> list[bytes]:
        """Take bytes and hand on the payloads of the frames that are now complete."""
        ...

    def reset(self) -> None:
        """Forget a frame in the making: the link was gone, and its rest will never come."""
        ...


class CobsFramer:
    """Frames of consistent overhead byte stuffing, each ended by a zero byte.

    COBS keeps zeros out of a frame, so that a zero always is an end: after any damage the next
    frame is whole again. The piece before the first end may be the tail of a frame that was under
    way when the port was opened, and is not counted.

    Args:
        longest: Longest frame of the protocol, encoded, without its end [bytes].
    """

    def __init__(self, *, longest: int) -> None:
        self.damaged = 0
        self.resynchronised = 0
        self._longest = longest
        self._tail = b""
        self._joined = False
        self._astray = False

    def feed(self, data: bytes) -> list[bytes]:
        """Take bytes and hand on the payloads of the frames that are now complete."""
        *pieces, tail = (self._tail + data).split(DELIMITER)
        self._tail = tail
        if len(tail) > self._longest:  # noise without an end must not fill the memory
            self._tail = tail[-self._longest - 1 :]
        return [payload for piece in pieces if (payload := self._decode(piece)) is not None]

    def reset(self) -> None:
        """Forget a frame in the making."""
        self._tail = b""
        self._joined = False

    def refuse(self) -> None:
        """Count a frame as damaged that was stuffed correctly and whose content is not right."""
        self.damaged += 1
        self._astray = True

    def accept(self) -> None:
        """Take note of a good frame."""
        self.resynchronised += self._astray
        self._astray = False

    def _decode(self, piece: bytes) -> bytes | None:
        joined, self._joined = self._joined, True
        if not piece:  # two ends in a row: a sender may begin with one to end any noise
            return None
        try:
            if len(piece) <= self._longest:
                return cobs.decode(piece)
        except cobs.DecodeError:
            pass
        if joined:
            self.refuse()
        return None


class TrailerFramer:
    """Frames of one length that all end in the same bytes, and have no checksum.

    A frame is taken where a trailer stands both right before and at the end of it, so that a
    truncated, doubled-up or interrupted frame is not. A bit flipped between two trailers stays
    unseen: that is this format's weakness, not mended here.

    Args:
        length: Length of a frame with its trailer [bytes].
        trailer: What every frame ends in.
    """

    def __init__(self, *, length: int, trailer: bytes) -> None:
        self.damaged = 0
        self.resynchronised = 0
        self._length = length
        self._trailer = trailer
        self._buffer = b""
        self._aligned = False
        self._astray = False

    def feed(self, data: bytes) -> list[bytes]:
        """Take bytes and hand on the frames that are now complete, without their trailers."""
        self._buffer += data
        frames: list[bytes] = []
        while self._aligned or self._align():
            if len(self._buffer) < self._length:
                break
            if not self._buffer[: self._length].endswith(self._trailer):
                self._lose_alignment()
                continue
            frames.append(self._buffer[: self._length - len(self._trailer)])
            self._buffer = self._buffer[self._length :]
            self.resynchronised += self._astray
            self._astray = False
        return frames

    def reset(self) -> None:
        """Forget a frame in the making."""
        self._buffer = b""
        self._aligned = False

    def _lose_alignment(self) -> None:
        self.damaged += 1
        self._astray = True
        self._aligned = False

    def _align(self) -> bool:
        """Throw away bytes up to and with the next trailer; return whether there was one."""
        found = self._buffer.find(self._trailer)
        if found < 0:
            self._buffer = self._buffer[-len(self._trailer) + 1 :]
            return False
        self._buffer = self._buffer[found + len(self._trailer) :]
        self._aligned = True
        return True
