# SPDX-License-Identifier: MIT
"""An exception that ends any thread of the program reaches the running experiment, and stops it."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rig.errors import PartFailed
from rig.experiment.control import Control


@contextmanager
def supervised(control: Control) -> Iterator[None]:
    """Report every exception that nobody catches in a thread to a run, for as long as it lasts.

    Args:
        control: Mailbox of the run, whose safe stop follows.
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
    """Start a thread that a run depends on; its failure, or that it cannot start, stops the run.

    Args:
        work: What it does.
        name: Its name, for the message.
        control: Mailbox of the run.

    Raises:
        PartFailed: The system gives no thread.
    """

    def watched() -> None:
        try:
            work()
        except BaseException as error:  # noqa: BLE001, RUF100 - the run stops and says why
            control.fail(name, error)

    thread = threading.Thread(target=watched, daemon=True, name=name)
    try:
        thread.start()
    except RuntimeError as error:
        failure = PartFailed(name, error)
        control.fail(name, error)
        raise failure from error
    return thread
