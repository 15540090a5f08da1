# SPDX-License-Identifier: MIT
"""Stop a command at Ctrl-C or SIGTERM at any moment: one line, exit code 130, no half file.

While a command runs, the signals raise `StoppedBySignal` in the main thread, so that drafts are
removed and devices closed on the way out. A progress bar, a recording and an experiment set their
own handlers meanwhile. It imports the standard library alone, as it works before all others.
"""

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, Final

from zebro_lab.terminal.timely_output import say_in_time

STOPPED: Final = 130
"""Exit code of a command that was stopped."""
SIGNALS: Final = (signal.SIGINT, signal.SIGTERM)
PATIENCE: Final = 5.0
"""Time after which a process is stopped again where a library has caught the exception [s].

After as long again it is ended.
"""

_asked = False


class StoppedBySignal(SystemExit):
    """A signal asked the command to stop; if nothing catches it, the exit code is `STOPPED`.

    Attributes:
        number: Number of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(STOPPED)
        self.number = number

    def __str__(self) -> str:
        """Say what happened, in one line."""
        by = "Ctrl-C" if self.number == signal.SIGINT else signal.Signals(self.number).name
        return f"stopped by {by}; nothing was left half-written"


def stop_at_once(number: int, _frame: FrameType | None = None) -> None:
    """Handle a signal: raise `StoppedBySignal`, and do so again later if that was caught.

    Raises:
        StoppedBySignal: Always.
    """
    global _asked
    watchdog = threading.Timer(PATIENCE, _end if _asked else _ask_again, (number,))
    _asked = True
    watchdog.daemon = True
    watchdog.start()
    raise StoppedBySignal(number)


@contextmanager
def stoppable() -> Iterator[None]:
    """Stop the body at Ctrl-C or SIGTERM; a signal that is ignored, as under nohup, stays ignored.

    After the body the signals have their usual effect again.

    Raises:
        SystemExit: The body was stopped; the exit code is `STOPPED`, and a line on stderr says so.
    """
    heard = [number for number in SIGNALS if signal.getsignal(number) is not signal.SIG_IGN]
    for number in heard:
        signal.signal(number, stop_at_once)
    sys.unraisablehook = _raise_again
    try:
        yield
    except StoppedBySignal as stopped:
        _restore(heard)  # a second signal ends the process at once
        say_in_time(str(stopped), err=True)
        raise SystemExit(STOPPED) from None
    finally:
        _restore(heard)


def _restore(numbers: list[signal.Signals]) -> None:
    """Give signals their default effect, which ends the process."""
    for number in numbers:
        signal.signal(number, signal.SIG_DFL)


def _raise_again(unraisable: Any) -> None:
    """Send the signal again where a finaliser or a callback of C swallowed its exception.

    Other errors of finalisers are shown until a stop is asked for; then they are of objects that
    the stop left half made.
    """
    if isinstance(unraisable.exc_value, StoppedBySignal):
        again = threading.Timer(0.01, os.kill, (os.getpid(), unraisable.exc_value.number))
        again.daemon = True
        again.start()
    elif not _asked:
        sys.__unraisablehook__(unraisable)


def _ask_again(number: int) -> None:
    """Send the signal again, so that drafts are removed; end the process if it is not heard."""
    if callable(signal.getsignal(number)):
        os.kill(os.getpid(), number)
    else:
        _end(number)


def _end(number: int) -> None:
    """End the process at once, without cleaning up, where a stop by an exception has failed."""
    say_in_time(str(StoppedBySignal(number)), err=True)
    os._exit(STOPPED)
