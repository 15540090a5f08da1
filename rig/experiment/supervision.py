# SPDX-License-Identifier: MIT
"""Report uncaught exceptions of any thread to the running experiment, which then stops."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rig.errors import PartFailed
from rig.experiment.control import Control


@contextmanager
def supervised(control: Control) -> Iterator[None]:
    """Request a safe stop at an uncaught exception of a thread, until the context ends.

    Exceptions of the main thread are not caught.

    Args:
        control: Mailbox of the run; `Control.fail` is called with the exception.
    """
    earlier = threading.excepthook

    def report(found: threading.ExceptHookArgs) -> None:
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
