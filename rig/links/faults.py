# SPDX-License-Identifier: MIT
"""Fault injection into the byte stream of a twin, to test the real parser."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Generic, TypeVar

import numpy as np

from rig.errors import ProtocolError


@dataclass(frozen=True)
class Faults:
    """Probabilities of transmission errors on a line; the defaults are an error-free line.

    Attributes:
        flip: Probability, for each bit, that it is flipped.
        drop: Probability that a frame is lost whole.
        truncate: Probability that the end of a frame is lost.
        duplicate: Probability that a frame is sent twice.
        delay: Probability that a frame is sent after the next one.
        garbage: Probability that 1 to 39 random bytes precede a frame.
        noise_at_start: Number of random bytes before the first frame.

    Raises:
        ProtocolError: A probability is outside 0 to 1.
    """

    flip: float = 0.0
    drop: float = 0.0
    truncate: float = 0.0
    duplicate: float = 0.0
    delay: float = 0.0
    garbage: float = 0.0
    noise_at_start: int = 0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name != "noise_at_start" and not 0 <= value <= 1:
                raise ProtocolError(f"{field.name} is {value:g}; expected a probability, 0 to 1")


PERFECT_LINE = Faults()
"""A line without transmission errors."""


FrameT = TypeVar("FrameT")


class FaultyLine(Generic[FrameT]):
    """Channel that drops, truncates, duplicates and delays frames at random.

    Args:
        faults: Probabilities of the errors.
        rng: Random generator.
    """

    def __init__(self, faults: Faults, *, rng: np.random.Generator) -> None:
        self._faults = faults
        self._rng = rng
        self._held: list[FrameT] = []

    def carry(
        self, frame: FrameT, truncate: Callable[[FrameT], FrameT] | None = None
    ) -> list[FrameT]:
        """Transmit a frame with random errors.

        Args:
            frame: The frame.
            truncate: Removes the end of a frame; None where frames arrive whole or not at all.

        Returns:
            The frames that arrive now: this one never, once or twice, then a delayed earlier one.
        """
        held, self._held = self._held, []
        if self._happens(self._faults.delay):
            self._held = [frame]
            return held
        if self._happens(self._faults.drop):
            return held
        if truncate is not None and self._happens(self._faults.truncate):
            frame = truncate(frame)
        return [frame] * (2 if self._happens(self._faults.duplicate) else 1) + held

    def _happens(self, probability: float) -> bool:
        """Draw whether an error happens; a probability of 0 draws no number."""
        return probability > 0 and self._rng.random() < probability


class FaultyWire(FaultyLine[bytes]):
    """Byte stream of frames with all errors of `Faults`, flipped and random bytes included."""

    def __init__(self, faults: Faults, *, rng: np.random.Generator) -> None:
        super().__init__(faults, rng=rng)
        self._noise = faults.noise_at_start

    def stream(self, frames: list[bytes]) -> bytes:
        """Transmit frames as bytes with random errors; an error-free line draws no numbers.

        Args:
            frames: Whole frames, in order.

        Returns:
            The bytes that arrive at the far end.
        """
        if self._faults == PERFECT_LINE:
            return b"".join(frames)
        out = bytearray(self._rng.bytes(self._noise))
        self._noise = 0
        for frame in frames:
            if self._happens(self._faults.garbage):
                out += self._rng.bytes(int(self._rng.integers(1, 40)))
            out += b"".join(self.carry(frame, self._truncate))
        return self._flip(out)

    def _truncate(self, frame: bytes) -> bytes:
        """Cut a frame to a random length, from 0 to all but its last byte."""
        return frame[: int(self._rng.integers(0, len(frame)))]

    def _flip(self, data: bytearray) -> bytes:
        """Flip bits: draw how many, each bit with the probability `flip`, and then which.

        A bit may be drawn twice, and is then as it was.
        """
        flips = self._rng.binomial(8 * len(data), self._faults.flip) if self._faults.flip else 0
        for bit in self._rng.integers(0, 8 * len(data), flips) if flips else ():
            data[bit // 8] ^= 1 << (bit % 8)
        return bytes(data)
