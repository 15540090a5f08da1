# SPDX-License-Identifier: MIT
"""Read arrays of numbers from an .npz archive with size limits and without pickle."""

import math
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import IO, Final

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import open_file, parsing

MOST_BYTES: Final = 256 << 20
"""Largest unpacked size of the arrays read: a band of 10,000 paths of one minute [bytes]."""
_HEADERS: Final = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}
_AGAIN: Final = "delete the file and compute the result again"
_NUMBERS: Final = "biufU"  # booleans, integers, floats and fixed-length strings


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
        Read-only arrays by name.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, cannot be opened, is not an archive, or lacks an array;
            an array does not hold integers, floats, booleans or strings of fixed length, or not as
            many bytes as its header says; or the arrays unpack to more than `most`.
    """
    with (
        open_file(path, advice=advice) as file,
        parsing(path, "cannot be read as arrays", advice=advice),
        zipfile.ZipFile(file) as archive,
    ):
        wanted = {name: _member(archive, name, path) for name in names}
        unpacked = sum(member.file_size for member in wanted.values())
        if unpacked > most:
            raise DataError(
                f"would unpack to {unpacked / 1e6:.0f} MB; expected at most {most / 1e6:.0f} MB",
                file=path,
            )
        return {name: _array(archive, member, path) for name, member in wanted.items()}


def _member(archive: zipfile.ZipFile, name: str, path: Path) -> zipfile.ZipInfo:
    try:
        return archive.getinfo(f"{name}.npy")
    except KeyError as error:
        raise DataError(f"has no array '{name}'; {_AGAIN}", file=path) from error


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo, path: Path) -> NDArray:
    """Read one array; raise DataError if not of `_NUMBERS`, or not of the size that it states."""
    with archive.open(member) as file:
        shape, fortran, dtype = _header(file, member, path)
        data = file.read()
    count = _product(shape)
    if dtype.kind not in _NUMBERS or dtype.hasobject or count * dtype.itemsize != len(data):
        raise DataError(
            f"the array '{member.filename.removesuffix('.npy')}' has {len(data)} bytes of type "
            f"{dtype}, expected {count * dtype.itemsize} bytes of numbers or texts; {_AGAIN}",
            file=path,
        )
    return np.frombuffer(data, dtype).reshape(shape, order="F" if fortran else "C")


def _header(
    file: IO[bytes], member: zipfile.ZipInfo, path: Path
) -> tuple[tuple[int, ...], bool, np.dtype]:
    name = member.filename.removesuffix(".npy")
    with parsing(path, f"'{name}' is not an array of numbers", advice=_AGAIN):
        return _HEADERS[npy.read_magic(file)](file)


def _product(shape: tuple[int, ...]) -> int:
    if min(shape, default=0) < 0:
        return -1
    return math.prod(shape)
