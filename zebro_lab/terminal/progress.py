# SPDX-License-Identifier: MIT
"""Progress bar with the remaining time, and graceful stopping on Ctrl-C; silent in a pipe."""

import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from types import FrameType

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.progress import TimeRemainingColumn as TimeLeftColumn

from zebro_lab.terminal.compiling import announcing_compilation


class ProgressBar:
    """A watcher that draws a progress bar; its `request_stop` handles SIGINT and SIGTERM."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._task: TaskID | None = None
        self._what = ""
        self._stop = False

    def step(self, what: str, fraction: float | None) -> None:
        """Update the progress bar.

        Args:
            what: Name of the task; a new name completes the present bar and starts a new one.
            fraction: Share of the task that is done, 0 to 1 [-]; None if unknown.
        """
        if what != self._what:
            if self._task is not None:
                self._progress.update(self._task, total=1.0, completed=1.0)
            self._task = self._progress.add_task(what, total=None if fraction is None else 1.0)
            self._what = what
        if fraction is not None and self._task is not None:
            self._progress.update(self._task, completed=fraction)

    def stop_requested(self) -> bool:
        """Return whether a stop was requested, by a signal or a call of `request_stop`."""
        return self._stop

    def request_stop(self, _signal: int, _frame: FrameType | None) -> None:
        """Handle a stop signal: set the stop flag; a second signal raises immediately.

        Args:
            _signal: Signal number; unused.
            _frame: Interrupted stack frame; unused.

        Raises:
            KeyboardInterrupt: A stop was already requested.
        """
        if self._stop:
            raise KeyboardInterrupt
        self._stop = True
        if self._progress.console.is_terminal:
            self._progress.console.print("stopping; press Ctrl-C again to quit at once")


@contextmanager
def progress_bar(console: Console | None = None) -> Iterator[ProgressBar]:
    """Show a progress bar, and turn SIGINT and SIGTERM into a stop request, during the body.

    A second signal raises `KeyboardInterrupt`. Only the main thread can call this function.

    Args:
        console: Console to draw on, standard error by default; nothing is drawn unless it is a
            terminal.

    Yields:
        The watcher to pass to a stage.
    """
    console = console or Console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("elapsed, left:"),
        TimeLeftColumn(),
    )
    progress = Progress(*columns, console=console, disable=not console.is_terminal)
    with ExitStack() as stack:
        if console.is_terminal:  # rich before 14.3 ends a disabled display with an empty line
            stack.enter_context(progress)
        stack.enter_context(announcing_compilation())
        bar = ProgressBar(progress)
        earlier = {s: signal.signal(s, bar.request_stop) for s in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield bar
        finally:
            for number, handler in earlier.items():
                signal.signal(number, handler)
