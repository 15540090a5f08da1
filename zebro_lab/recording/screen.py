# SPDX-License-Identifier: MIT
"""Live display of a recording on a terminal, and the signals and keys that end it."""

import contextlib
import errno
import os
import select
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Any, Final

from rich.console import Console
from rich.live import Live
from rich.text import Text

from zebro_lab.recording.drawing import LiveValues, draw_status, stream_in_words, time_left
from zebro_lab.terminal.tables import plain
from zebro_lab.terminal.timely_output import in_time

if TYPE_CHECKING:
    from zebro_lab.recording.status import RecordStatus

STOP_KEYS: Final = b"qQ\x1b"
DRAW_EVERY: Final = 0.125
"""Least interval of drawing on a terminal [s]."""
LINE_EVERY: Final = 10.0
"""Interval of lines where there is no terminal [s]."""
_HANGUP: Final = getattr(signal, "SIGHUP", None)


class RecordScreen:
    """Live display that also handles signals and keys; implements the protocol `RecordWatcher`.

    Args:
        console: Output.
        live: Display to update, of a terminal; None writes a line now and then.
        keys: Input file from which keys are read; None without a keyboard.

    Attributes:
        signalled: Whether a signal or a lost terminal requested the end of the recording.
    """

    def __init__(self, console: Console, live: Live | None = None, keys: Any = None) -> None:
        self.signalled = False
        self._console = console
        self._values = LiveValues()
        self._width = 0
        self._writing = False
        self._live = live
        self._keys = keys
        self._reason: str | None = None
        self._asked = False
        self._drawn = float("-inf") if live is not None else time.monotonic()
        # Under `nohup` and the like hangups are ignored, so that the run outlives the terminal.
        self._outlives = _HANGUP is not None and signal.getsignal(_HANGUP) == signal.SIG_IGN

    def note(self, line: str) -> None:
        """Print a line; a terminal or pipe that does not take it in time is not waited for."""
        in_time(lambda: self._console.print(plain(line), soft_wrap=True))

    def show(self, status: "RecordStatus") -> None:
        """Draw the status, at most every `DRAW_EVERY`; called in a separate thread.

        Without a terminal a line is written every `LINE_EVERY`.

        Raises:
            OSError: The terminal cannot be written; a lost terminal also requests a stop, unless
                hangups are ignored.
        """
        if time.monotonic() - self._drawn < (LINE_EVERY if self._live is None else DRAW_EVERY):
            return
        self._writing = True
        try:
            if self._live is None:
                self._console.print(_line(status), soft_wrap=True)
            else:
                self._draw(self._live, status)
        except OSError as error:
            if error.errno == errno.EIO:
                self._hang_up()
            raise
        finally:  # a write that hangs does not come here
            self._writing = False
        self._drawn = time.monotonic()

    def stop_reason(self) -> str | None:
        """Read keys; return the first reason to stop, or None without one.

        It is a signal's name, `key` (q, Q or Esc) or `terminal closed`.
        """
        typed = self._typed()
        if any(key in STOP_KEYS for key in typed):
            self._reason = self._reason or "key"
        return self._reason

    def request_stop(self, number: int, _frame: FrameType | None) -> None:
        """Handle a signal: the first one ends the recording, a second one ends it at once.

        Hangups do not count as a second signal: terminal, shell and service each send one.

        Args:
            number: Number of the signal.

        Raises:
            KeyboardInterrupt: The signal is the second one that is not a hangup.
        """
        if number != _HANGUP:
            if self._asked:
                raise KeyboardInterrupt
            self._asked = True
        self.signalled = True
        self._reason = self._reason or signal.Signals(number).name

    def close(self) -> bool:
        """End the display; return whether the terminal accepted its last output in time."""
        live, self._live = self._live, None
        return in_time(live.stop) if live is not None else not self._writing

    def _draw(self, live: Live, status: "RecordStatus") -> None:
        """Draw status and newest values; start the display first, or clear a resized one."""
        values = self._values.update(status.folder, status.streams)
        size = self._console.size
        if not live.is_started:
            live.start()
        elif size.width != self._width:
            self._console.clear()  # lines that the terminal has wrapped anew cannot be overwritten
        self._width = size.width
        drawn = draw_status(status, values, width=size.width, height=size.height)
        live.update(drawn, refresh=True)

    def _typed(self) -> bytes:
        """Read typed bytes without blocking, empty without any.

        A lost keyboard requests a stop, unless hangups are ignored.
        """
        if self._keys is None:
            return b""
        try:
            if not select.select([self._keys], [], [], 0)[0]:
                return b""
            typed = os.read(self._keys.fileno(), 4096)
        except BlockingIOError:
            return b""
        except (OSError, ValueError):
            typed = b""
        if not typed:
            self._keys = None
            self._hang_up()
        return typed

    def _hang_up(self) -> None:
        """Request the end because the terminal is lost, unless hangups are ignored."""
        if not self._outlives:
            self.signalled = True
            self._reason = self._reason or "terminal closed"


@contextmanager
def record_screen(console: Console) -> Iterator[RecordScreen]:
    """Provide the display of a recording; handle SIGINT, SIGTERM and SIGHUP while the body runs.

    SIGHUP stays ignored if it is. For the main thread only.

    Args:
        console: Output; unless it is a terminal, no key is read, and lines are written.

    Yields:
        The display, to be passed to the stage as its watcher.
    """
    with contextlib.ExitStack() as stack:
        screen = RecordScreen(console)
        if console.is_terminal:
            # Drawn by who calls `show` alone: a thread of its own would hold the lock of a terminal
            # that is stopped.
            live = Live(
                console=console, transient=True, auto_refresh=False, redirect_stdout=False,
                redirect_stderr=False,
            )  # fmt: skip
            screen = RecordScreen(console, live, stack.enter_context(_single_keys()))
            stack.callback(screen.close)
        numbers = [signal.SIGINT, signal.SIGTERM]
        if _HANGUP is not None and signal.getsignal(_HANGUP) != signal.SIG_IGN:
            numbers.append(_HANGUP)
        earlier = {number: signal.signal(number, screen.request_stop) for number in numbers}
        try:
            yield screen
        finally:
            for number, handler in earlier.items():
                signal.signal(number, handler)


@contextmanager
def _single_keys() -> Iterator[Any]:
    """Yield stdin, set to pass keys without Enter; None if it is not a terminal, or on Windows."""
    if sys.platform == "win32" or not sys.stdin.isatty():
        yield None
        return
    import termios
    import tty

    before = termios.tcgetattr(sys.stdin)
    try:
        tty.setcbreak(sys.stdin, termios.TCSANOW)  # to wait for output to drain may be for ever
        yield sys.stdin
    finally:
        with contextlib.suppress(termios.error):  # the terminal is gone
            termios.tcsetattr(sys.stdin, termios.TCSANOW, before)


def _line(status: "RecordStatus") -> Text:
    """Return the status in one line, without values."""
    streams = (stream_in_words(name, each) for name, each in status.streams.items())
    return Text("; ".join((time_left(status), *streams)))
