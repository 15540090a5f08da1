# SPDX-License-Identifier: MIT
"""Ctrl-C and SIGTERM as stops: soft, then safe, then emergency."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from rig.safety import StopCategory, StopSwitch


@contextmanager
def signal_stops(switch: StopSwitch) -> Iterator[None]:
    """Let SIGINT ask for a soft, a safe, then an emergency stop, and SIGTERM for a safe one.

    Only the main thread may do so. The handlers that were there come back afterwards.

    Args:
        switch: Where stops are asked for.
    """
    pressed: list[int] = []

    def interrupt(number: int, _frame: FrameType | None) -> None:
        # One Ctrl-C may come while the last is being answered: a generator could not be re-entered.
        pressed.append(number)
        category = StopCategory(min(len(pressed), StopCategory.EMERGENCY))
        switch.request(category, f"Ctrl-C, time {category.value}")

    def terminate(_number: int, _frame: FrameType | None) -> None:
        switch.request(StopCategory.SAFE, "SIGTERM")

    earlier = {
        signal.SIGINT: signal.signal(signal.SIGINT, interrupt),
        signal.SIGTERM: signal.signal(signal.SIGTERM, terminate),
    }
    try:
        yield
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)
