# SPDX-License-Identifier: MIT
"""Encode and decode ROS 2 messages in little-endian CDR, field by field.

The writer of mcap-ros2-support is not used: it has no `flush()` and is several times slower. The
tests compare these bytes with its decoder.
"""

import struct
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

HEADER = b"\x00\x01\x00\x00"
_NANOSECONDS = 1_000_000_000


class CdrWriter:
    """Builds one message; every method adds a field and returns the writer.

    Numbers are aligned to their size, counted from behind the header.

    >>> CdrWriter().uint32(7).text("ab").message().hex()
    '000100000700000003000000616200'
    """

    def __init__(self) -> None:
        self._parts = bytearray()

    def uint32(self, value: int) -> Self:
        """Add a 32-bit number."""
        return self._packed("<I", 4, value)

    def uint64(self, value: int) -> Self:
        """Add a 64-bit number."""
        return self._packed("<Q", 8, value)

    def uint8(self, value: int) -> Self:
        """Add an 8-bit number."""
        return self._packed("<B", 1, value)

    def float64(self, *values: float) -> Self:
        """Add doubles, also an array of fixed length."""
        return self._packed(f"<{len(values)}d", 8, *values)

    def text(self, value: str) -> Self:
        """Add a text."""
        self._align(4)
        self._parts += _text_block(value)
        return self

    def texts(self, values: Sequence[str]) -> Self:
        """Add a sequence of texts."""
        self._align(4)
        self._parts += _texts_block(tuple(values))
        return self

    def array(self, values: NDArray[Any]) -> Self:
        """Add a sequence of numbers of the array's type."""
        self.uint32(len(values))
        if len(values):  # an empty sequence is its length alone
            self._align(values.itemsize)
            self._parts += np.ascontiguousarray(values).tobytes()
        return self

    def time(self, nanoseconds: int) -> Self:
        """Add a `builtin_interfaces/Time` from nanoseconds since the Unix epoch."""
        seconds, rest = divmod(nanoseconds, _NANOSECONDS)
        return self._packed("<iI", 4, seconds, rest)

    def message(self) -> bytes:
        """Return the message."""
        return HEADER + bytes(self._parts)

    def _align(self, size: int) -> None:
        self._parts += bytes(-len(self._parts) % size)

    def _packed(self, layout: str, size: int, *values: float) -> Self:
        self._align(size)
        self._parts += struct.pack(layout, *values)
        return self


def _text_block(value: str) -> bytes:
    data = value.encode("utf-8", "backslashreplace") + b"\0"
    return struct.pack("<I", len(data)) + data


@lru_cache(maxsize=256)  # names of joints: the same in every message
def _texts_block(values: tuple[str, ...]) -> bytes:
    block = struct.pack("<I", len(values))
    for value in values:
        block += bytes(-len(block) % 4) + _text_block(value)
    return block


class CdrReader:
    """Decodes a message of `CdrWriter`, field by field in order.

    Args:
        data: The message.

    Raises:
        ValueError: It is not little-endian CDR.
    """

    def __init__(self, data: bytes) -> None:
        if data[:4] != HEADER:
            raise ValueError("a message is not little-endian CDR")
        self._data = memoryview(data)[4:]
        self._at = 0

    def uint32(self) -> int:
        """Read a 32-bit number."""
        return int(self._take(np.dtype("<u4"), 1)[0])

    def array(self, dtype: str) -> NDArray[Any]:
        """Read a sequence of numbers.

        Raises:
            ValueError: The message ends before it.
        """
        count = self.uint32()
        return self._take(np.dtype(dtype), count) if count else np.empty(0, dtype)

    def _take(self, dtype: np.dtype[Any], count: int) -> NDArray[Any]:
        start = self._at + -self._at % dtype.itemsize
        self._at = start + count * dtype.itemsize
        if self._at > len(self._data):
            raise ValueError(f"a message of {len(self._data)} bytes ends before its fields do")
        return np.frombuffer(self._data, dtype=dtype, count=count, offset=start)
