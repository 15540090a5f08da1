# SPDX-License-Identifier: MIT
"""Fault injection into the byte stream of a twin, to test the real parser."""

from dataclasses import dataclass, fields

import numpy as np

from rig.errors import ProtocolError


@dataclass(frozen=True)
class Faults:
    """Probabilities of transmission errors on a line; the defaults are an error-free line.

    Attributes:
        flip: Probability that a bit is flipped.
        drop: Probability that a frame is lost whole.
        truncate: Probability that a frame loses its end.
        duplicate: Probability that a frame is sent twice.
        delay: Probability that a frame is sent after the next one.
        garbage: Probability that random bytes precede a frame.
        noise_at_start: Random bytes before the first frame.

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


class FaultyWire:
    """Channel that adds transmission errors to frames.

    Args:
        faults: Probabilities of the errors.
        rng: Random generator.
    """

    def __init__(self, faults: Faults, *, rng: np.random.Generator) -> None:
        self._faults = faults
        self._rng = rng
        self._held: list[bytes] = []
        self._noise = faults.noise_at_start
        self._perfect = faults == PERFECT_LINE

    def carry(self, frames: list[bytes]) -> bytes:
        """Transmit frames with random errors.

        Args:
            frames: Whole frames, in order.

        Returns:
            The bytes at the far end.
        """
        if self._perfect:
            return b"".join(frames)
        out = bytearray(self._rng.bytes(self._noise))
        self._noise = 0
        for frame in frames:
            self._pass(frame, out)
        return self._flip(out)

    def _pass(self, frame: bytes, out: bytearray) -> None:
        held, self._held = self._held, []
        if self._happens(self._faults.garbage):
            out += self._rng.bytes(int(self._rng.integers(1, 40)))
        if self._happens(self._faults.delay):
            self._held = [frame]
        elif not self._happens(self._faults.drop):
            if self._happens(self._faults.truncate):
                frame = frame[: int(self._rng.integers(0, len(frame)))]
            out += frame * (2 if self._happens(self._faults.duplicate) else 1)
        for late in held:
            out += late

    def _happens(self, probability: float) -> bool:
        return probability > 0 and self._rng.random() < probability

    def _flip(self, data: bytearray) -> bytes:
        flips = self._rng.binomial(8 * len(data), self._faults.flip) if self._faults.flip else 0
        for bit in self._rng.integers(0, 8 * len(data), flips) if flips else ():
            data[bit // 8] ^= 1 << (bit % 8)
        return bytes(data)
