# SPDX-License-Identifier: MIT
"""Announce that numeric loops are being compiled, which happens once per installation."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

from zebro_lab.terminal.timely_output import say_in_time

ANNOUNCEMENT: Final = (
    "compiling numeric loops for this computer, once per installation; this can take two minutes"
)
AFTER: Final = 0.5
"""Time for which loops are compiled before a terminal is told [s]."""
AFTER_IN_PIPE: Final = 10.0
"""The same where stderr is no terminal, as the interval of lines of progress [s]."""


@contextmanager
def announcing_compilation() -> Iterator[None]:
    """Write one line to stderr while the body compiles a numeric loop for longer than a moment.

    The line is written in a thread of its own, so that a terminal that is stopped stops nothing.
    Nothing is announced unless numba has been imported before: this does not import it.
    """
    if "numba" not in sys.modules or sys.stderr is None:  # a shell has closed it
        yield
        return
    from numba.core.event import Listener, install_listener

    after = AFTER if sys.stderr.isatty() else AFTER_IN_PIPE
    said = threading.Event()
    running: list[threading.Timer] = []

    def say() -> None:
        if not said.is_set():
            said.set()
            say_in_time(ANNOUNCEMENT, err=True)  # typer would write past a progress bar

    class Compiling(Listener):
        def on_start(self, event: Any) -> None:
            timer = threading.Timer(after, say)
            timer.daemon = True
            timer.start()
            running.append(timer)

        def on_end(self, event: Any) -> None:
            if running:
                running.pop().cancel()

    try:
        with install_listener("numba:compile", Compiling()):
            yield
    finally:
        said.set()
