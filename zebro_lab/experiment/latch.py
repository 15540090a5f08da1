# SPDX-License-Identifier: MIT
"""The emergency latch of an experiment on disk: a file whose space is taken beforehand.

It is written in place, without new space, so that a full disk keeps no emergency stop from being
latched; and by the thread that stops the rig, so that no queue does. A file of blanks is open;
whatever else it holds, or that it cannot be read, counts as latched.
"""

import json
import os
from pathlib import Path
from typing import Final

LATCH_FILE: Final = "emergency-latch"
SIZE: Final = 4096
"""Length of the file [bytes]: a block of most disks, and longer than any reason."""


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
            with self._file.open("rb") as file:
                content = file.read(SIZE + 1)
        except FileNotFoundError:
            return None
        except OSError as error:
            return f"{self._file.name} cannot be read ({error.strerror})"
        if len(content) <= SIZE and not content.strip(b" \n"):
            return None
        try:
            return str(json.loads(content.decode("ascii")))
        except (ValueError, RecursionError):
            return f"{self._file.name} is damaged"

    def prepare(self) -> None:
        """Make the file, open, unless it is there; takes its space on the disk.

        Raises:
            OSError: It cannot be made.
        """
        if not self._file.exists():
            self._write(b"", os.O_CREAT)

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

    def _write(self, content: bytes, flags: int) -> None:
        handle = os.open(self._file, os.O_WRONLY | flags, 0o644)
        try:
            os.pwrite(handle, content.ljust(SIZE - 1) + b"\n", 0)
            os.ftruncate(handle, SIZE)
            os.fsync(handle)
        finally:
            os.close(handle)
