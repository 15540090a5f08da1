# SPDX-License-Identifier: MIT
"""Print with a timeout, to a terminal or pipe that may be stopped, blocked or closed."""

import os
import sys
import threading
from collections.abc import Callable
from typing import Final, NoReturn

PATIENCE: Final = 1.0
"""Timeout for writing to a terminal or pipe [s]."""


def say_in_time(text: str, *, err: bool = False) -> bool:
    """Print a line to stdout or stderr with a timeout.

    Args:
        text: Text to print, without the newline.
        err: Whether to print to stderr.

    Returns:
        Whether the line was written within `PATIENCE`, True also if the stream is None. If not, the
        stream is closed, or a thread is still blocked in the write: end with `leave_at_once`.
    """

    def write() -> None:
        stream = sys.stderr if err else sys.stdout
        if stream is None:  # a shell has closed it
            return
        stream.write(text + "\n")
        stream.flush()

    return in_time(write)


def in_time(act: Callable[[], object]) -> bool:
    """Call a function in a thread; return whether it ended within `PATIENCE` [s] without error.

    `OSError` and `ValueError` of the function are suppressed; it may still run after a timeout. If
    no thread can be started, it is called without a timeout.
    """
    done: list[bool] = []

    def run() -> None:
        try:
            act()
        except (OSError, ValueError):  # the terminal or pipe is gone, or closed
            return
        done.append(True)

    thread = threading.Thread(target=run, daemon=True, name="timely output")
    try:
        thread.start()
    except RuntimeError:  # no thread can be started: print without one
        run()
    else:
        thread.join(PATIENCE)
    return bool(done)


def leave_at_once(code: int) -> NoReturn:
    """End the process at once, without flushing output, as a blocked terminal would delay it."""
    os._exit(code)
