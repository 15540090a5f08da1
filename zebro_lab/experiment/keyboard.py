# SPDX-License-Identifier: MIT
"""Reads the keys that command a run, as bytes: nothing that is typed or pasted ends the reading."""

import os
import select
from typing import Final

from rig.errors import LinkError, ProtocolError
from rig.experiment.control import Control

KEYS: Final = {"p": "pause", "r": "resume", "": "confirm", "s": "soft", "ss": "safe",
               "e": "emergency"}  # fmt: skip
LONGEST_LINE: Final = 4096
"""What a line has beyond this is dropped: a terminal hands on no longer one [bytes]."""
WAIT: Final = 200
"""Between two looks whether the run is over [ms]."""


class Keyboard:
    """The keys of a terminal, each line a command.

    Args:
        handle: File descriptor of the terminal.
        control: Mailbox of the run.
    """

    def __init__(self, handle: int, control: Control) -> None:
        self._handle = handle
        self._control = control
        self._line = b""
        self._over = False

    def close(self) -> None:
        """Read no more; the terminal stays open."""
        self._over = True

    def listen(self) -> None:
        """Obey lines until closed.

        Raises:
            LinkError: The terminal is gone: nobody can stop the run by its keys any more.
            OSError: It cannot be read.
        """
        if not hasattr(select, "poll"):  # Windows, whose consoles cannot be waited for
            while not self._over:
                self.take(os.read(self._handle, LONGEST_LINE))
        terminal = select.poll()
        terminal.register(self._handle, select.POLLIN)
        while not self._over:
            for _, found in terminal.poll(WAIT):
                # What was typed before the terminal went away is read first.
                data = os.read(self._handle, LONGEST_LINE) if found & select.POLLIN else b""
                if not data and found & ~select.POLLIN:  # hung up, or no file any more
                    raise LinkError("the terminal is gone")
                self.take(data)

    def take(self, data: bytes) -> None:
        """Take bytes as they were typed; an end of input in the middle, Ctrl-D, is passed over."""
        *lines, rest = (self._line + data).split(b"\n")
        self._line = rest[:LONGEST_LINE]
        for line in lines:
            self._obey(line[:LONGEST_LINE])

    def _obey(self, line: bytes) -> None:
        key = line.decode("utf-8", "backslashreplace").strip()
        try:
            self._control.obey(KEYS.get(key, key), who="keyboard")
        except ProtocolError:  # a slip of the finger commands nothing
            return
