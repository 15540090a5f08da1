# SPDX-License-Identifier: MIT
"""Read MATLAB files (.mat of versions 5 to 7) as raw tables: named arrays of one length.

They are read here, since scipy.io (1.17) ends the process at some damaged ones. Source of the
format: MathWorks, MAT-File Format, chapter 1.
"""

import math
import struct
import zlib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import MOST_UNPACKED, parsing, read_unpacked
from zebro_lab.tables.raw_table import RawTable

_MATRIX, _COMPRESSED = 14, 15  # types of elements
_TYPES: Final = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8",
                 13: "u8"}  # fmt: skip
"""Type of the numbers of an element."""


def read_mat_file(path: Path) -> RawTable:
    """Read a MATLAB file, perhaps gzipped: its rows and columns of numbers, as columns.

    Of several lengths the most frequent one is taken; other arrays are named in a note.

    Raises:
        NotFound: There is no such file.
        DataError: The file is of version 7.3 or 4, damaged, too large, or has no such arrays.
    """
    data = read_unpacked(path)
    if data.startswith(b"MATLAB 7.3"):
        advice = "save it with the option -v7, or export its arrays as CSV"
        raise DataError(f"is of version 7.3 (HDF5), which is not read; {advice}", file=path)
    with parsing(path, "is not a whole MATLAB file of version 5 to 7", advice="save it again"):
        order = {b"IM": "<", b"MI": ">"}.get(data[126:128])  # at the end of the header
        if order is None:
            raise ValueError("no order of bytes in its header")
        arrays = dict(_arrays(data[128:], order))
    if not arrays:
        raise DataError("has no row or column of numbers; expected one of a quantity", file=path)
    counts = Counter(map(len, arrays.values()))
    n = max(counts, key=lambda length: (counts[length], length))
    others = ", ".join(f"'{name}'" for name, array in arrays.items() if len(array) != n)
    note = f"{path.name}: arrays of another length than {n} are not read: {others}"
    columns = {name: pd.Series(array) for name, array in arrays.items() if len(array) == n}
    return RawTable(path, columns, notes=(note,) * bool(others))


def _elements(data: bytes, order: str) -> Iterator[tuple[int, bytes]]:
    """Yield type and content of each data element; raise `ValueError` where one is cut short."""
    at = 0
    while at < len(data):
        kind, size = struct.unpack_from(f"{order}II", data, at)
        small = kind >> 16  # bytes of an element that stands in the place of its size
        kind, size, begin = (kind & 0xFFFF, small, at + 4) if small else (kind, size, at + 8)
        if begin + size > len(data):
            raise ValueError("it is cut short")
        yield kind, data[begin : begin + size]
        at = at + 8 if small else begin + size + (0 if kind == _COMPRESSED else -size % 8)


def _arrays(data: bytes, order: str) -> Iterator[tuple[str, Array]]:
    """Yield name and numbers of each array of two or more real numbers in one dimension."""
    for kind, content in _elements(data, order):
        if kind == _COMPRESSED:
            yield from _arrays(zlib.decompressobj().decompress(content, MOST_UNPACKED), order)
        elif kind == _MATRIX:
            (_, flags), *parts = _elements(content, order)
            (about,) = struct.unpack_from(f"{order}I", flags)
            if about & 0xFF not in range(6, 16) or about & 0x800:  # class of numbers, complex
                continue
            (_, sizes), (_, name), (of, numbers), *_ = parts
            shape = np.frombuffer(sizes, f"{order}u4").tolist()
            if name and 1 < max(shape) == math.prod(shape):
                values = np.frombuffer(numbers, order + _TYPES[of]).reshape(max(shape))
                yield name.decode(), values.astype(float)
