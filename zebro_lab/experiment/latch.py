# SPDX-License-Identifier: MIT
"""The emergency latch of an experiment on disk: a file whose space is taken beforehand.

It is written in place, without new space, so that a full disk keeps no emergency stop from being
latched; and by the thread that stops the rig, so that no queue does. A file of blanks is open;
whatever else it holds, or that it cannot be read, counts as latched.
"""

import errno
import json
import os
import stat
from pathlib import Path
from typing import Final

LATCH_FILE: Final = "emergency-latch"
SIZE: Final = 4096
"""Length of the file [bytes]: a block of most disks, and longer than any reason."""
_NO_WAIT: Final = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0)
"""A FIFO in its place holds no emergency stop up; a link to another file is refused."""


class EmergencyLatch:
    """The latch of one experiment.

    Args:
        data: Folder of the experiment.
    """

    def __init__(self, data: Path) -> None:
        self._file = data / LATCH_FILE

    @property
    def reason(self) -> str | None:
        """Why it is latched; None where it is open, or was never prepared."""
        try:
            handle = self._open(os.O_RDONLY)
        except FileNotFoundError:
            return None
        except OSError as error:
            return f"{self._file.name} cannot be read ({error.strerror})"
        with os.fdopen(handle, "rb") as file:
            content = file.read(SIZE + 1)
        if len(content) <= SIZE and not content.strip(b" \n"):
            return None
        try:
            return str(json.loads(content.decode("ascii")))
        except (ValueError, RecursionError):
            return f"{self._file.name} is damaged"

    def prepare(self) -> None:
        """Make the file, open, unless it is there; takes its space on the disk.

        Raises:
            OSError: It cannot be made, or something else is in its place.
        """
        try:
            os.close(self._open(os.O_WRONLY))
        except FileNotFoundError:
            self._write(b"", os.O_CREAT | os.O_EXCL)

    def latch(self, reason: str) -> None:
        """Latch, without taking any space.

        Raises:
            OSError: The file is gone, or the disk takes nothing.
        """
        text = json.dumps(reason[: SIZE // 16])  # an escaped character takes up to twelve bytes
        self._write(text.encode("ascii"), 0)

    def reset(self) -> None:
        """Open the latch: only ever at a person's explicit wish.

        Raises:
            OSError: The disk takes nothing.
        """
        self._write(b"", os.O_CREAT)

    def _open(self, flags: int) -> int:
        """Open the file; what is no regular file is refused without waiting for it.

        Raises:
            OSError: It cannot be opened, or is no regular file.
        """
        handle = os.open(self._file, flags | _NO_WAIT, 0o644)
        if stat.S_ISREG(os.fstat(handle).st_mode):
            return handle
        os.close(handle)
        raise OSError(errno.EINVAL, "is no regular file", str(self._file))

    def _write(self, content: bytes, flags: int) -> None:
        handle = self._open(os.O_WRONLY | flags)
        try:
            os.pwrite(handle, content.ljust(SIZE - 1) + b"\n", 0)
            os.ftruncate(handle, SIZE)
            os.fsync(handle)
        finally:
            os.close(handle)
