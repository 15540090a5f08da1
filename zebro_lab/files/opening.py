# SPDX-License-Identifier: MIT
"""Open user files safely: regular files only, limited in size, with one-line error messages.

Every reader of a user's file opens it with these functions and calls third-party parsers inside
`parsing`. A file is bounded by its size alone, unpacked if it is packed.
"""

import gzip
import os
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Final

from zebro_lab.files.errors import DataError, NotFound, SettingsError, ZebroLabError

Fault = type[DataError] | type[SettingsError]

MOST_TEXT: Final = 64 << 20
"""Largest text file that is read at once: a trajectory of half a million poses [bytes]."""
MOST_TABLE: Final = 1 << 30
"""Largest table that is read: some ten million rows of eight columns of text [bytes]."""
MOST_UNPACKED: Final = 256 << 20
"""Largest size of a packed table when it is unpacked: a small file may hold gigabytes [bytes]."""
_KINDS: Final = (
    (stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a FIFO"), (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"), (stat.S_ISBLK, "a device"),
)  # fmt: skip


@contextmanager
def open_file(
    path: Path, *, most: int | None = None, advice: str = "", fault: Fault = DataError
) -> Iterator[BinaryIO]:
    """Open a regular file for reading.

    A FIFO or device is never opened: opening a FIFO blocks until there is a writer, and opening a
    device may have side effects.

    Args:
        path: The file.
        most: Largest size that is accepted [bytes]; None if the caller limits what it reads.
        advice: What to do if the file does not exist; part of the error message.
        fault: Type of error to raise if the file exists but cannot be opened.

    Yields:
        The file, open for reading in binary mode.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, larger than `most`, or cannot be opened
            (`SettingsError` if `fault` is that type).
    """
    with os.fdopen(_descriptor(path, advice, fault), "rb") as file:
        size = os.fstat(file.fileno()).st_size
        if most is not None and size > most:
            raise fault(
                f"has {size / 1e6:.1f} MB; expected at most {most / 1e6:.1f} MB for a file of this "
                "kind; check that this is the right file",
                file=path,
            )
        yield file


def read_bytes(path: Path, *, most: int, advice: str = "", fault: Fault = DataError) -> bytes:
    """Read a whole file as bytes.

    Args:
        path: The file.
        most: Largest size that is accepted [bytes].
        advice: What to do if the file does not exist; part of the error message.
        fault: Type of error to raise if the file exists but cannot be read.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, larger than `most`, or cannot be read (`SettingsError`
            if `fault` is that type).
    """
    with (
        open_file(path, most=most, advice=advice, fault=fault) as file,
        parsing(path, "cannot be read", fault=fault),
    ):
        return file.read(most)


def read_text(
    path: Path, *, most: int = MOST_TEXT, advice: str = "", fault: Fault = DataError
) -> str:
    """Read a whole text file in UTF-8, with or without a byte order mark.

    Args:
        path: The file.
        most: Largest size that is accepted [bytes].
        advice: What to do if the file does not exist; part of the error message.
        fault: Type of error to raise if the file exists but cannot be read.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, larger than `most`, cannot be read, or is not UTF-8
            (`SettingsError` if `fault` is that type).
    """
    data = read_bytes(path, most=most, advice=advice, fault=fault)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise fault(
            f"is not UTF-8 text (byte 0x{data[error.start]:02x} at position {error.start}); save "
            "it as UTF-8",
            file=path,
        ) from error


def read_unpacked(path: Path) -> bytes:
    """Read a whole table as bytes, decompressing it if its name ends in .gz.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, not opened, larger than `MOST_TABLE`, not complete gzip,
            or unpacks to more than `MOST_UNPACKED`.
    """
    if not path.name.lower().endswith(".gz"):
        return read_bytes(path, most=MOST_TABLE)
    with open_file(path, most=MOST_TABLE) as file:
        try:
            data = gzip.GzipFile(fileobj=file).read(MOST_UNPACKED + 1)
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            raise DataError(
                f"is not a complete gzip file ({error}); copy or export it again", file=path
            ) from error
    require_unpacked_size(path, len(data), MOST_UNPACKED)
    return data


def require_unpacked_size(path: Path, size: int, most: int) -> None:
    """Check the size to which a packed file unpacks.

    Args:
        path: The file.
        size: Unpacked size, or a part of it that is beyond `most` [bytes].
        most: Largest size that is accepted [bytes].

    Raises:
        DataError: It is larger.
    """
    if size > most:
        raise DataError(
            f"unpacks to {size / 1e6:.0f} MB or more; expected at most {most / 1e6:.0f} MB; unpack "
            "it, or split it",
            file=path,
        )


@contextmanager
def parsing(
    path: Path, problem: str, *, advice: str = "", fault: Fault = DataError
) -> Iterator[None]:
    """Convert any exception of the body into a one-line error that names the file.

    Third-party parsers may raise any `Exception`. A `ZebroLabError` passes unchanged.

    Args:
        path: The file.
        problem: What is wrong with the file, e.g. "cannot be read as TOML".
        advice: What to try; part of the error message.
        fault: Type of error to raise.

    Raises:
        DataError: The body raised any other exception (`SettingsError` if `fault` is that type).
    """
    try:
        yield
    except ZebroLabError:
        raise
    except Exception as error:
        reason = str(error) or "no reason given"
        named = "" if isinstance(error, (ValueError, OSError)) else f"{type(error).__name__}: "
        closing = f"; {advice}" if advice else ""
        raise fault(f"{problem} ({named}{reason}){closing}", file=path) from error


def _descriptor(path: Path, advice: str, fault: Fault) -> int:
    """Open a regular file without blocking, and return its descriptor.

    Raises `NotFound` if there is no such file, and `fault` if it is not regular or not opened.
    """
    try:
        _require_regular(path.stat().st_mode, path, fault)  # before it is opened: see above
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    except (FileNotFoundError, NotADirectoryError) as error:
        raise NotFound(f"{path}: no such file" + (f"; {advice}" if advice else "")) from error
    except ZebroLabError:
        raise
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise fault(f"cannot be opened: {reason}", file=path) from error
    try:
        _require_regular(os.fstat(descriptor).st_mode, path, fault)  # it may have been replaced
    except ZebroLabError:
        os.close(descriptor)
        raise
    return descriptor


def _require_regular(mode: int, path: Path, fault: Fault) -> None:
    """Raise `fault` if the mode of a path (`st_mode`) is not that of a regular file."""
    if not stat.S_ISREG(mode):
        kind = next((name for test, name in _KINDS if test(mode)), "something else")
        raise fault(f"is {kind}; expected a regular file", file=path)
