# SPDX-License-Identifier: MIT
"""What is seen of a recording: counters on a terminal, silence in a pipe; and how to end it."""

import contextlib
import select
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Any

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:
    from zebro_lab.stages.record import RecordStatus

STOP_KEYS = ("q", "Q", "\x1b")


class RecordScreen:
    """A watcher that draws, and hears signals and keys; satisfies `RecordWatcher`.

    Args:
        live: Where to draw; None draws nothing.
        keys: Where keys are typed; None where nobody can.

    Attributes:
        signalled: A signal ended the recording.
    """

    def __init__(self, live: Live | None, keys: Any = None) -> None:
        self.signalled = False
        self._live = live
        self._keys = keys
        self._reason: str | None = None

    def show(self, status: "RecordStatus") -> None:
        """Draw how the recording is doing."""
        if self._live is not None:
            self._live.update(_drawn(status))

    def stop_reason(self) -> str | None:
        """Say which signal or key asked for the end; None where none did."""
        if self._keys is not None and select.select([self._keys], [], [], 0)[0]:
            key = self._keys.read(1)
            if key in STOP_KEYS and self._reason is None:
                self._reason = "key"
        return self._reason

    def request_stop(self, number: int, _frame: FrameType | None) -> None:
        """Note a signal; a second one is obeyed at once."""
        if self.signalled:
            raise KeyboardInterrupt
        self.signalled = True
        self._reason = signal.Signals(number).name


@contextmanager
def record_screen(console: Console) -> Iterator[RecordScreen]:
    """Watch a recording while the body runs.

    Args:
        console: Where to draw; nothing is drawn, and no key heard, unless it is a terminal.

    Yields:
        The watcher to hand to the stage.
    """
    with contextlib.ExitStack() as stack:
        screen = RecordScreen(None)
        if console.is_terminal:
            live = stack.enter_context(Live(console=console, transient=True, refresh_per_second=8))
            screen = RecordScreen(live, stack.enter_context(_single_keys()))
        numbers = (signal.SIGINT, signal.SIGTERM)
        earlier = {number: signal.signal(number, screen.request_stop) for number in numbers}
        try:
            yield screen
        finally:
            for number, handler in earlier.items():
                signal.signal(number, handler)


@contextmanager
def _single_keys() -> Iterator[Any]:
    """Hear keys without Enter; yields None where stdin is no terminal, and on Windows."""
    if sys.platform == "win32" or not sys.stdin.isatty():
        yield None
        return
    import termios
    import tty

    before = termios.tcgetattr(sys.stdin)
    try:
        tty.setcbreak(sys.stdin)
        yield sys.stdin
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)


def _drawn(status: "RecordStatus") -> Group:
    table = Table(box=None, pad_edge=False)
    table.add_column("stream")
    for column in ("rate [Hz]", "received", "lost", "rejected", "dropped"):
        table.add_column(column, justify="right")
    for name, stream in status.streams.items():
        simulated = " SIMULATED" if stream.source.startswith("sim:") else ""
        table.add_row(
            name + simulated, f"{stream.rate:.0f}", f"{stream.counters.received}",
            f"{stream.counters.lost}", f"{stream.counters.rejected}", f"{stream.dropped}",
        )  # fmt: skip
    return Group(table, _time(status))


def _time(status: "RecordStatus") -> Group:
    if status.duration is None:
        return Group(Text(f"{status.elapsed:.0f} s; q ends the recording"))
    left = max(status.duration - status.elapsed, 0.0)
    return Group(
        ProgressBar(total=status.duration, completed=status.elapsed, width=40),
        Text(f"{status.elapsed:.0f} of {status.duration:g} s, {left:.0f} s left; q ends it now"),
    )
