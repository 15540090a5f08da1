# SPDX-License-Identifier: MIT
"""Announce that numeric loops are being compiled, which happens once per installation."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, Final

ANNOUNCEMENT: Final = (
    "compiling numeric loops for this computer, once per installation; this can take two minutes"
)
AFTER: Final = 0.5
"""Time for which loops are compiled before a terminal is told [s]."""
AFTER_IN_PIPE: Final = 10.0
"""The same where stderr is no terminal, as the interval of lines of progress [s]."""


@contextmanager
def announcing_compilation() -> Iterator[None]:
    """Write one line to stderr while the body compiles numeric loops for longer than a moment.

    The line is written in a thread of its own, so that a terminal that is stopped stops nothing.
    Nothing is announced unless numba has been imported before: this does not import it.
    """
    if "numba" not in sys.modules or sys.stderr is None:  # a shell has closed it
        yield
        return
    from numba.core.event import install_listener

    announcer = _Announcer(AFTER if sys.stderr.isatty() else AFTER_IN_PIPE)
    try:
        with install_listener("numba:compile", announcer.listener()):
            yield
    finally:
        announcer.end()


class _Announcer:
    """Says `ANNOUNCEMENT` once, where a function is being compiled `after` seconds [s] later."""

    def __init__(self, after: float) -> None:
        self._after = after
        self._compiling = 0
        self._timer: threading.Timer | None = None
        self._said = False

    def listener(self) -> Any:
        """Return numba's listener of compilations, which it calls in the compiling thread."""
        from numba.core.event import Listener

        announcer = self

        class Compiling(Listener):
            def on_start(self, event: Any) -> None:
                announcer.begin()

            def on_end(self, event: Any) -> None:
                announcer.over()

        return Compiling()

    def begin(self) -> None:
        """Note that a function is being compiled, perhaps within another one."""
        self._compiling += 1
        if self._timer is None and not self._said:
            self._timer = threading.Timer(self._after, self._say)
            self._timer.daemon = True
            self._timer.start()

    def over(self) -> None:
        """Note that a function has been compiled."""
        self._compiling -= 1

    def end(self) -> None:
        """Say nothing any more."""
        self._said = True
        if self._timer is not None:
            self._timer.cancel()

    def _say(self) -> None:
        self._timer = None  # of loops compiled one by one, a later one may be met
        if self._compiling > 0 and not self._said:
            self._said = True
            # Not by typer, which writes past the display of a progress bar
            with suppress(OSError, ValueError):
                sys.stderr.write(ANNOUNCEMENT + "\n")
                sys.stderr.flush()
