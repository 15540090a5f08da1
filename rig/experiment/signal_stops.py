# SPDX-License-Identifier: MIT
"""Signals of the system as stops: Ctrl-C, a terminal that is closed, a process that is ended."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

from rig.experiment.condition import next_stop
from rig.safety import StopCategory, StopSwitch

ENDING: Final = ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGTSTP")
"""Signals that ask for a safe stop: an end, a lost connection or closed terminal, Ctrl-\\, and
Ctrl-Z, because a suspended program reads nothing and guards nothing."""


@contextmanager
def signal_stops(switch: StopSwitch) -> Iterator[None]:
    """Let each SIGINT ask for the next harder stop, and each of `ENDING` for a safe one.

    Only the main thread may do so. The handlers that were there come back afterwards. A signal
    that is ignored stays so: that is how `nohup` asks for a run that outlives its terminal.

    Args:
        switch: Where stops are asked for.
    """

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        category = next_stop(None if switch.pending is None else switch.pending.category)
        switch.request(category, f"Ctrl-C, time {category.value}")

    def end(number: int, _frame: FrameType | None) -> None:
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
