# SPDX-License-Identifier: MIT
"""Read text tables, also gzipped, with limits on their unpacked size."""

import gzip
import io
import os
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import open_file

FREELY: Final = 64 << 20
"""Unpacked size that is allowed whatever the packed size [bytes]."""
MOST_RATIO: Final = 100
"""Largest ratio of unpacked to packed size, beyond `FREELY`; logs of sensors reach 20 [-]."""
MOST_CELLS: Final = 32_000_000
"""Largest number of table cells; each takes some 25 bytes while numbers are parsed."""
LONGEST_LINE: Final = 1 << 20
"""Largest length of a line [bytes]."""


@contextmanager
def open_unpacked(path: Path, *, width: int = 1) -> Iterator[IO[bytes]]:
    """Open a file for reading with size limits, decompressing it if its name ends in .gz.

    Args:
        path: The file.
        width: Number of cells per line that the reader of the file keeps.

    Yields:
        The decompressed file in binary mode; reading beyond a limit raises.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, not opened, or not complete gzip; or unpacked has more
            than `FREELY` plus `MOST_RATIO` times its size, than `MOST_CELLS` (lines times `width`),
            or than `LONGEST_LINE` in a line. It then replaces any exception of the body.
    """
    with open_file(path) as file:
        most = FREELY + MOST_RATIO * os.fstat(file.fileno()).st_size
        source = gzip.GzipFile(fileobj=file) if path.name.lower().endswith(".gz") else file
        counted = _Counted(source, path, most, width)
        try:
            yield counted  # pyright: ignore[reportReturnType]
        except Exception as error:
            # pandas replaces errors of the file it reads from by its own types.
            raise counted.refusal or error from error


def read_unpacked(path: Path) -> bytes:
    """Read a whole binary file, decompressing it if its name ends in .gz.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, not opened, not complete gzip, or has more than `FREELY`
            plus `MOST_RATIO` times its packed size.
    """
    with open_file(path) as file:
        if not path.name.lower().endswith(".gz"):
            return file.read()
        most = FREELY + MOST_RATIO * os.fstat(file.fileno()).st_size
        try:
            data = gzip.GzipFile(fileobj=file).read(most + 1)
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            raise DataError(
                f"is not a complete gzip file ({error}); copy or export it again", file=path
            ) from error
    if len(data) > most:
        raise DataError(
            f"unpacks to more than {MOST_RATIO} times its size; check that it is a table", file=path
        )
    return data


class _Counted(io.BufferedIOBase):
    """A file wrapper that counts bytes and lines read, and raises DataError beyond the limits.

    Args:
        source: File to read from; incomplete gzip also raises DataError.
        path: Path of the file, for messages.
        most: Largest number of bytes that may be read.
        width: Number of cells per line.

    Attributes:
        refusal: The DataError that was raised last; None before.
    """

    def __init__(
        self, source: IO[bytes] | gzip.GzipFile, path: Path, most: int, width: int
    ) -> None:
        self._source, self._path, self._left, self._width = source, path, most, width
        self._lines = self._line = 0
        self.refusal: DataError | None = None

    def readable(self) -> bool:
        return True

    def read(self, size: int | None = -1, /) -> bytes:
        try:
            data = self._source.read(-1 if size is None else size)
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            raise self._refuse(
                f"is not a complete gzip file ({error}); copy or export it again"
            ) from error
        self._left -= len(data)
        if self._left < 0:
            raise self._refuse(
                f"unpacks to more than {MOST_RATIO} times its size; check that it is a table"
            )
        self._count(data)
        return data

    def read1(self, size: int = -1, /) -> bytes:
        return self.read(size)

    def _count(self, data: bytes) -> None:
        self._lines += max(data.count(b"\n"), data.count(b"\r"))
        last = max(data.rfind(b"\n"), data.rfind(b"\r"))
        self._line = len(data) - last if last >= 0 else self._line + len(data)
        if self._line > LONGEST_LINE:
            raise self._refuse(f"has a line of more than {LONGEST_LINE >> 20} MB; is this a table?")
        if self._lines * self._width > MOST_CELLS:
            raise self._refuse(
                f"has more than {MOST_CELLS / 1e6:.0f} million cells; split it, or drop columns "
                "that are not needed"
            )

    def _refuse(self, problem: str) -> DataError:
        self.refusal = DataError(problem, file=self._path)
        return self.refusal
