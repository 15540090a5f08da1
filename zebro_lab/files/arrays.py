# SPDX-License-Identifier: MIT
"""Read arrays of numbers from an .npz archive with a size limit and without pickle."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import open_file, parsing, require_unpacked_size

MOST_BYTES: Final = 256 << 20
"""Largest unpacked size of the arrays read: a band of 10,000 paths of one minute [bytes]."""


def read_arrays(
    path: Path, names: Iterable[str], *, advice: str, most: int = MOST_BYTES
) -> Mapping[str, NDArray]:
    """Read named arrays of an .npz archive.

    Args:
        path: The archive.
        names: Names of the arrays to read.
        advice: What to do if the file is missing or cannot be read; part of the error message.
        most: Largest unpacked size of all named arrays together [bytes].

    Returns:
        Arrays by name.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, cannot be opened, is not an archive, lacks an array, or
            has a damaged one or one that is not of numbers, truth values or texts; or the arrays
            unpack to more than `most`.
    """
    wanted = list(names)
    with (
        open_file(path, advice=advice) as file,
        parsing(path, "cannot be read as arrays", advice=advice),
        np.load(file, allow_pickle=False) as archive,
    ):
        missing = next((name for name in wanted if name not in archive.files), None)
        if missing is not None:
            raise DataError(
                f"has no array '{missing}'; delete the file and compute the result again", file=path
            )
        require_unpacked_size(path, sum(_size(archive, name) for name in wanted), most)
        arrays = {name: archive[name] for name in wanted}
    for name, array in arrays.items():
        if not isinstance(array, np.ndarray) or array.dtype.kind not in "biufU":
            raise DataError(f"holds no array of numbers as '{name}'; {advice}", file=path)
    return arrays


def _size(archive: Any, name: str) -> int:
    """Return the unpacked size of an array in an open .npz archive [bytes]."""
    return archive.zip.getinfo(f"{name}.npy").file_size
