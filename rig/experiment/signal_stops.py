# SPDX-License-Identifier: MIT
"""Signal handlers that request stops: Ctrl-C, a closed terminal, a terminated process."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

from rig.experiment.condition import next_stop
from rig.safety import StopCategory, StopSwitch

ENDING: Final = ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGTSTP")
"""Signals that request a safe stop: termination, a lost connection or closed terminal, Ctrl-\\, and
Ctrl-Z, because a suspended program reads no samples and checks no limits."""


@contextmanager
def signal_stops(switch: StopSwitch) -> Iterator[None]:
    """Install handlers: SIGINT requests a stop harder than the pending one, others a safe stop.

    The first SIGINT requests a soft stop; the other signals are `ENDING`: SIGTERM, SIGHUP, SIGQUIT
    and SIGTSTP. The previous handlers are restored afterwards. A signal that is ignored stays
    ignored, as under `nohup`, which lets a run outlive its terminal.

    Args:
        switch: Receiver of the stop requests.

    Raises:
        ValueError: This is not the main thread.
    """

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        category = next_stop(None if switch.pending is None else switch.pending.category)
        switch.request(category, "Ctrl-C")

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
