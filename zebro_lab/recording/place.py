# SPDX-License-Identifier: MIT
"""Detect that a folder is removed, renamed or full while a file in it is being written.

Writing to a file whose name is gone succeeds on Linux and macOS, so that the path must be checked.
"""

import os
import shutil
from collections.abc import Iterable
from contextlib import ExitStack
from pathlib import Path
from typing import IO

from zebro_lab.files.errors import RecordingError


class OpenPlace:
    """Check of whether an open file is still under its path, by device and inode.

    Args:
        path: Path of the file.
        file: The file, open.

    Raises:
        OSError: The file or its folder cannot be examined.
    """

    def __init__(self, path: Path, file: IO[bytes]) -> None:
        self._path = path
        self._number = file.fileno()
        self._file = identity(os.fstat(self._number))
        self._folder = identity(path.parent.stat())

    def problem(self) -> str | None:
        """Return why the open file is no longer under its path; None where it is."""
        try:
            found = self._path.stat()
        except FileNotFoundError:
            return f"{self._path} no longer exists: the file or its folder was removed or renamed"
        except OSError as error:
            return f"{self._path} can no longer be accessed: {error.strerror}"
        if identity(found) != self._file:
            return f"{self._path} was removed or renamed, and another file has its name now"
        return None

    def folder(self) -> Path | None:
        """Return the folder's present path, on Linux also after a rename; None if not found."""
        for place in (self._path.parent, *self._renamed()):
            try:
                if identity(place.stat()) == self._folder:
                    return place
            except OSError:
                continue
        return None

    def _renamed(self) -> list[Path]:
        """Return the present folder of the open file by `/proc` in a list; empty if unknown."""
        try:
            return [Path(f"/proc/self/fd/{self._number}").readlink().parent]
        except OSError:
            return []


def require_space(folder: Path, least: float) -> None:
    """Raise where the disk of a folder has too little free space.

    Args:
        folder: The folder, which exists.
        least: Least free space [bytes].

    Raises:
        RecordingError: Less space is free, or the free space cannot be determined.
    """
    try:
        free = shutil.disk_usage(folder).free
    except OSError as error:
        raise RecordingError(f"{folder}: cannot determine free space: {error.strerror}") from error
    if free < least:
        raise RecordingError(
            f"the disk of {folder} has {free / 1e6:.0f} MB free; expected at least "
            f"{least / 1e6:.0f} MB: delete files, or choose a folder on another disk with --data"
        )


def sync_files(paths: Iterable[Path]) -> None:
    """Flush existing files to the disk (fsync), after all could be opened.

    Raises:
        OSError: The disk fails, or a file is missing or not writable.
    """
    with ExitStack() as stack:
        for file in [stack.enter_context(path.open("r+b")) for path in paths]:
            os.fsync(file.fileno())


def identity(status: os.stat_result) -> tuple[int, int]:
    """Return device and inode number, which identify a file or folder."""
    return status.st_dev, status.st_ino
