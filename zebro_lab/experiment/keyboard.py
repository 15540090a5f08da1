# SPDX-License-Identifier: MIT
"""Read keyboard commands of a run from a terminal as bytes, robust against any input."""

import os
import select
from typing import Final

from rig.errors import LinkError, ProtocolError
from rig.experiment.control import Control

KEYS: Final = {"p": "pause", "r": "resume", "": "confirm", "s": "soft", "ss": "safe",
               "e": "emergency"}  # fmt: skip
LONGEST_LINE: Final = 4096
"""Length to which a line is truncated; the longest line of common terminals [bytes]."""
WAIT: Final = 200
"""Polling interval for the end of the run [ms]."""


class Keyboard:
    """Reader of keyboard commands from a terminal, one per line: a key of `KEYS`, or in full.

    Args:
        handle: File descriptor of the terminal.
        control: Mailbox of the run, which executes the commands.
    """

    def __init__(self, handle: int, control: Control) -> None:
        self._handle = handle
        self._control = control
        self._line = b""
        self._over = False

    def close(self) -> None:
        """End `listen` within the polling interval `WAIT`; the terminal stays open.

        On Windows it ends only after the next input.
        """
        self._over = True

    def listen(self) -> None:
        """Read and execute commands until closed.

        Raises:
            LinkError: The terminal is gone, so that its keys can no longer stop the run.
            OSError: The terminal cannot be read.
        """
        if not hasattr(select, "poll"):  # Windows, whose consoles cannot be waited for
            while not self._over:
                self.take(os.read(self._handle, LONGEST_LINE))
        terminal = select.poll()
        terminal.register(self._handle, select.POLLIN)
        while not self._over:
            for _, found in terminal.poll(WAIT):
                # Input typed before the terminal disappeared is read first.
                data = os.read(self._handle, LONGEST_LINE) if found & select.POLLIN else b""
                if not data and found & ~select.POLLIN:  # hung up, or no file any more
                    raise LinkError("the terminal was closed")
                self.take(data)

    def take(self, data: bytes) -> None:
        """Buffer typed bytes and execute complete lines; unknown commands and Ctrl-D do nothing."""
        *lines, rest = (self._line + data).split(b"\n")
        self._line = rest[:LONGEST_LINE]
        for line in lines:
            self._obey(line[:LONGEST_LINE])

    def _obey(self, line: bytes) -> None:
        key = line.decode("utf-8", "backslashreplace").strip()
        try:
            self._control.execute(KEYS.get(key, key), who="keyboard")
        except ProtocolError:  # a mistyped command has no effect
            return
