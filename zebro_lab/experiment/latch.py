# SPDX-License-Identifier: MIT
"""Latch of an emergency stop on disk: a file with preallocated space.

The file is overwritten in place, so that latching also works on a full disk, by the thread that
stops the rig, without a queue. A file of blanks means not latched; any other content, or an
unreadable file, counts as latched.
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
"""Flags so that a FIFO in its place does not block, and a symbolic link is rejected."""


class EmergencyLatch:
    """Emergency latch of one experiment: the file `emergency-latch` in its folder.

    Args:
        data: Folder of the experiment.
    """

    def __init__(self, data: Path) -> None:
        self._file = data / LATCH_FILE

    @property
    def reason(self) -> str | None:
        """Reason of the latched stop, or that the file is unreadable or damaged.

        None if it is not latched: the file is missing or blank.
        """
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
        """Create the file, not latched, with its disk space; leave an existing file as it is.

        Raises:
            OSError: The file cannot be created or opened, or is not a regular file.
        """
        try:
            os.close(self._open(os.O_WRONLY))
        except FileNotFoundError:
            self._write(b"", os.O_CREAT | os.O_EXCL)

    def latch(self, reason: str) -> None:
        """Write the reason of an emergency stop, cut to 256 characters, into the prepared file.

        Raises:
            OSError: The file is missing or not a regular one, or the write failed.
        """
        text = json.dumps(reason[: SIZE // 16])  # an escaped character takes up to twelve bytes
        self._write(text.encode("ascii"), 0)

    def reset(self) -> None:
        """Overwrite or create the file as not latched; only on a person's explicit request.

        Raises:
            OSError: The write failed, or the file is not a regular one.
        """
        self._write(b"", os.O_CREAT)

    def _open(self, flags: int) -> int:
        """Open the file without blocking and return its descriptor.

        Raises:
            OSError: The file cannot be opened, or is not a regular file.
        """
        handle = os.open(self._file, flags | _NO_WAIT, 0o644)
        if stat.S_ISREG(os.fstat(handle).st_mode):
            return handle
        os.close(handle)
        raise OSError(errno.EINVAL, "not a regular file", str(self._file))

    def _write(self, content: bytes, flags: int) -> None:
        """Overwrite the file with the content, filled up to `SIZE` with blanks, and flush it."""
        handle = self._open(os.O_WRONLY | flags)
        try:
            os.pwrite(handle, content.ljust(SIZE - 1) + b"\n", 0)
            os.ftruncate(handle, SIZE)
            os.fsync(handle)
        finally:
            os.close(handle)
