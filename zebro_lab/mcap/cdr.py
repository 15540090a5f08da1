# SPDX-License-Identifier: MIT
"""Encode and decode ROS 2 messages in little-endian CDR, field by field.

The writer of mcap-ros2-support is not used: it has no `flush()` and is several times slower. The
tests compare these bytes with its decoder.
"""

import struct
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

HEADER = b"\x00\x01\x00\x00"
_NANOSECONDS = 1_000_000_000


class CdrWriter:
    """Encoder of one CDR message; each field method appends a field and returns the writer.

    Numbers are aligned to multiples of their size, counted from the end of the 4-byte header. A
    number outside the range of its field raises struct.error.

    >>> CdrWriter().uint32(7).text("ab").message().hex()
    '000100000700000003000000616200'
    """

    def __init__(self) -> None:
        self._parts = bytearray()

    def uint32(self, value: int) -> Self:
        """Append an unsigned 32-bit integer."""
        return self._packed("<I", 4, value)

    def uint64(self, value: int) -> Self:
        """Append an unsigned 64-bit integer."""
        return self._packed("<Q", 8, value)

    def uint8(self, value: int) -> Self:
        """Append an unsigned 8-bit integer."""
        return self._packed("<B", 1, value)

    def text(self, value: str) -> Self:
        """Append a string in UTF-8, with its length in bytes before and a zero byte behind.

        The length counts the zero byte; lone surrogates are written as Python escapes.
        """
        self._align(4)
        data = value.encode("utf-8", "backslashreplace") + b"\0"
        self._parts += struct.pack("<I", len(data)) + data
        return self

    def array(self, values: NDArray[Any]) -> Self:
        """Append a one-dimensional array of a little-endian dtype, preceded by its length."""
        self.uint32(len(values))
        if len(values):  # an empty sequence is its length alone
            self._align(values.itemsize)
            self._parts += np.ascontiguousarray(values).tobytes()
        return self

    def time(self, nanoseconds: int) -> Self:
        """Append a `builtin_interfaces/Time` (int32 s, uint32 ns) from ns since the Unix epoch."""
        seconds, rest = divmod(nanoseconds, _NANOSECONDS)
        return self._packed("<i", 4, seconds)._packed("<I", 4, rest)

    def message(self) -> bytes:
        """Return the encoded message: the CDR header and all fields so far."""
        return HEADER + bytes(self._parts)

    def _align(self, size: int) -> None:
        """Append zero bytes up to a multiple of `size` bytes, not counting the header."""
        self._parts += bytes(-len(self._parts) % size)

    def _packed(self, layout: str, size: int, value: int) -> Self:
        """Append one number of `size` bytes, aligned, in a layout of the `struct` module."""
        self._align(size)
        self._parts += struct.pack(layout, value)
        return self


class CdrReader:
    """Decoder of a message of `CdrWriter`; each method reads the next field.

    Args:
        data: The message, with its CDR header.

    Raises:
        ValueError: The message does not begin with the header of little-endian CDR.
    """

    def __init__(self, data: bytes) -> None:
        if data[:4] != HEADER:
            raise ValueError("a message is not little-endian CDR")
        self._data = memoryview(data)[4:]
        self._at = 0

    def uint32(self) -> int:
        """Read an unsigned 32-bit integer; ValueError where the message ends before it does."""
        return int(self._take(np.dtype("<u4"), 1)[0])

    def array(self, dtype: str) -> NDArray[Any]:
        """Read the next sequence of numbers of a NumPy dtype such as `<f8`, shape (length,).

        The array is read-only unless it is empty.

        Raises:
            ValueError: The message ends before the sequence does.
        """
        count = self.uint32()
        return self._take(np.dtype(dtype), count) if count else np.empty(0, dtype)

    def _take(self, dtype: np.dtype[Any], count: int) -> NDArray[Any]:
        """Read `count` numbers from the next multiple of their size on; the array is a view.

        Raises `ValueError` if the message ends before them.
        """
        start = self._at + -self._at % dtype.itemsize
        self._at = start + count * dtype.itemsize
        if self._at > len(self._data):
            raise ValueError(f"a message of {len(self._data)} bytes ends before its fields do")
        return np.frombuffer(self._data, dtype=dtype, count=count, offset=start)
