# SPDX-License-Identifier: MIT
"""Last words of a command, to a terminal or pipe that may be stopped, blocked or gone."""

import os
import sys
import threading
from collections.abc import Callable
from typing import Final, NoReturn

PATIENCE: Final = 1.0
"""How long a terminal or pipe may take nothing before it is given up [s]."""


def say_in_time(text: str, *, err: bool = False) -> bool:
    """Print text and a line end on stdout or stderr; tell whether it was taken in time.

    Where it was not, a thread may still be writing: leave by `leave_at_once`.
    """

    def write() -> None:
        stream = sys.stderr if err else sys.stdout
        if stream is None:  # a shell has closed it
            return
        stream.write(text + "\n")
        stream.flush()

    return in_time(write)


def in_time(act: Callable[[], object]) -> bool:
    """Do something to a terminal; tell whether it ended within `PATIENCE`, and succeeded."""
    done: list[bool] = []

    def run() -> None:
        try:
            act()
        except (OSError, ValueError):  # the terminal or pipe is gone, or closed
            return
        done.append(True)

    thread = threading.Thread(target=run, daemon=True, name="last words")
    try:
        thread.start()
    except RuntimeError:  # no thread can be started: say it without one
        run()
    else:
        thread.join(PATIENCE)
    return bool(done)


def leave_at_once(code: int) -> NoReturn:
    """End the process without flushing: the interpreter would wait for a blocked terminal."""
    os._exit(code)
