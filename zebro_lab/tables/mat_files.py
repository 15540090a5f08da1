# SPDX-License-Identifier: MIT
"""Read MATLAB files (.mat up to version 7) as raw tables: named arrays of one length."""

import io
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.io import loadmat, whosmat

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import MOST_UNPACKED, parsing, read_unpacked, require_unpacked_size
from zebro_lab.tables.raw_table import RawTable


def read_mat_file(path: Path) -> RawTable:
    """Read a MATLAB file, perhaps gzipped: its rows and columns of numbers, as columns.

    Also those that are fields of a structure. Of several lengths the most frequent one is taken;
    other arrays are named in a note.

    Raises:
        NotFound: There is no such file.
        DataError: The file is of version 7.3, damaged, too large, or has no such arrays.
    """
    content = read_unpacked(path)
    if content.startswith(b"MATLAB 7.3"):
        advice = "save it with the option -v7, or export its arrays as CSV"
        raise DataError(f"is of version 7.3 (HDF5), which is not read; {advice}", file=path)
    with parsing(path, "is not a MATLAB file of version 7 or less", advice="export it as CSV"):
        sizes = [8 * int(np.prod(shape)) for _, shape, _ in whosmat(io.BytesIO(content))]
        require_unpacked_size(path, sum(sizes), MOST_UNPACKED)
        arrays = dict(_arrays(loadmat(io.BytesIO(content), squeeze_me=True)))
    if not arrays:
        expected = "one of each quantity, under its name, all of one length"
        raise DataError(f"has no array of numbers in one dimension; expected {expected}", file=path)
    counts = Counter(map(len, arrays.values()))
    n = max(counts, key=lambda length: (counts[length], length))
    others = ", ".join(f"'{name}'" for name, array in arrays.items() if len(array) != n)
    note = f"{path.name}: arrays of another length than {n} are not read: {others}"
    columns = {name: pd.Series(array) for name, array in arrays.items() if len(array) == n}
    return RawTable(path, columns, notes=(note,) * bool(others))


def _arrays(found: Mapping[str, Any]) -> Iterator[tuple[str, Array]]:
    """Yield name and numbers of each array in one dimension, also of the fields of structures."""
    for name, value in found.items():
        if name.startswith("__"):
            continue
        cells = np.asarray(value)
        if cells.dtype.names and cells.ndim == 0:
            yield from _arrays(dict(zip(cells.dtype.names, cells.item(), strict=True)))
        elif cells.ndim == 1 and cells.dtype.kind in "ifub":
            yield name, cells.astype(float)
