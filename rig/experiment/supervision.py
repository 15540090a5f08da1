# SPDX-License-Identifier: MIT
"""Request stops of a running experiment: by signals, and at uncaught exceptions of any thread."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

from rig.errors import PartFailed
from rig.experiment.condition import next_stop
from rig.experiment.control import Control
from rig.safety import StopCategory, StopSwitch

JOIN_TIMEOUT: Final = 2.0
"""Longest wait for the end of a thread [s]."""


@contextmanager
def supervised(control: Control) -> Iterator[None]:
    """Request a safe stop at an uncaught exception of a thread, until the context ends.

    Exceptions of the main thread are not caught.

    Args:
        control: Mailbox of the run; `Control.fail` is called with the exception.
    """
    earlier = threading.excepthook

    def report(found: threading.ExceptHookArgs) -> None:
        """Request a safe stop that names the thread and its exception."""
        name = "a thread" if found.thread is None else found.thread.name
        control.fail(name, found.exc_value or found.exc_type())

    threading.excepthook = report
    try:
        yield
    finally:
        threading.excepthook = earlier


def start_thread(work: Callable[[], None], *, name: str, control: Control) -> threading.Thread:
    """Start a daemon thread that a run depends on; an exception in it requests a safe stop.

    Args:
        work: Function that the thread calls once.
        name: Name of the thread, for the message.
        control: Mailbox of the run.

    Raises:
        PartFailed: The system cannot start a thread; a safe stop is requested as well.
    """

    def watched() -> None:
        """Do the work, and request a safe stop where it raises."""
        try:
            work()
        except BaseException as error:  # noqa: BLE001, RUF100 - the run stops and reports it
            control.fail(name, error)

    thread = threading.Thread(target=watched, daemon=True, name=name)
    try:
        thread.start()
    except RuntimeError as error:
        control.fail(name, error)
        raise PartFailed(name, error) from error
    return thread


@contextmanager
def repeating(
    work: Callable[[], object], *, every: float, name: str, control: Control
) -> Iterator[None]:
    """Call a function again and again in a thread, as of `start_thread`, until the context ends.

    Args:
        work: Function to call; the end of the context waits for it, at most `JOIN_TIMEOUT`.
        every: Pause between two calls [s].
        name: Name of the thread, for the message.
        control: Mailbox of the run.

    Raises:
        PartFailed: As `start_thread`.
    """
    ending = threading.Event()

    def repeat() -> None:
        """Do the work, time after time, until the context ends."""
        while not ending.wait(every):
            work()

    thread = start_thread(repeat, name=name, control=control)
    try:
        yield
    finally:
        ending.set()
        thread.join(JOIN_TIMEOUT)


ENDING: Final = ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGTSTP", "SIGUSR1", "SIGUSR2", "SIGXCPU")
"""Signals that request a safe stop: termination, a lost connection or closed terminal, Ctrl-\\,
Ctrl-Z, because a suspended program reads no samples and checks no limits, and others that would
end the program."""


@contextmanager
def signal_stops(switch: StopSwitch) -> Iterator[None]:
    """Install handlers: SIGINT requests a stop harder than the pending one, others a safe stop.

    The first SIGINT requests a soft stop; the other signals are `ENDING`. The previous handlers are
    restored afterwards. A signal that is ignored stays ignored, as under `nohup`, which lets a run
    outlive its terminal.

    Args:
        switch: Receiver of the stop requests.

    Raises:
        ValueError: This is not the main thread.
    """

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        """Request the next harder stop, as Ctrl-C does."""
        category = next_stop(None if switch.pending is None else switch.pending.category)
        switch.request(category, "Ctrl-C")

    def end(number: int, _frame: FrameType | None) -> None:
        """Request a safe stop that is named after the signal."""
        switch.request(StopCategory.SAFE, signal.Signals(number).name)

    handlers = {signal.SIGINT: interrupt}
    handlers |= {getattr(signal, name): end for name in ENDING if hasattr(signal, name)}
    earlier = {
        number: signal.signal(number, handler)
        for number, handler in handlers.items()
        if signal.getsignal(number) is not signal.SIG_IGN
    }
    try:
        yield
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)
