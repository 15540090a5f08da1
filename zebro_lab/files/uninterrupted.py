# SPDX-License-Identifier: MIT
"""Put off signals that would stop the command between two steps that belong together."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

_SIGNALS: Final = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Put off SIGINT and SIGTERM until the end of the body.

    Also around imports of C extensions: an exception within their initialisation can abort Python.
    Python runs handlers of signals in the main thread alone; in other threads, and of signals
    without a handler, nothing is done.
    """
    is_main = threading.current_thread() is threading.main_thread()
    heard = [number for number in _SIGNALS if is_main and callable(signal.getsignal(number))]
    came: list[int] = []
    earlier = {
        number: signal.signal(number, lambda number, _: came.append(number)) for number in heard
    }
    try:
        yield
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)
    for number in dict.fromkeys(came):
        signal.raise_signal(number)
