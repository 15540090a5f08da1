# SPDX-License-Identifier: MIT
"""Progress of a command, as a bar or in lines, and graceful stopping on Ctrl-C and SIGTERM."""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from types import FrameType
from typing import Final, Protocol

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, Task, TaskID, TextColumn
from rich.text import Text

from zebro_lab.terminal.messages import say
from zebro_lab.terminal.stopping import StoppedBySignal, stop_at_once

LINE_EVERY: Final = 10.0
"""Shortest time between two lines of progress, and before the first [s]."""


class ProgressDisplay(Protocol):
    """Shows how far the present step of a command is."""

    def show(self, what: str, fraction: float | None) -> None:
        """Show a step and the share of it that is done [-], None if unknown."""
        ...


class ProgressBar:
    """A watcher that displays progress; its `request_stop` handles SIGINT and SIGTERM.

    Args:
        display: Shows the progress.
        acknowledge: Called when a stop is requested that the command will follow.
    """

    def __init__(self, display: ProgressDisplay, acknowledge: Callable[[], object]) -> None:
        self._display = display
        self._acknowledge = acknowledge
        self._what = ""
        self._is_heard = False
        self._stop: int | None = None

    def step(self, what: str, fraction: float | None) -> None:
        """Display progress.

        Args:
            what: Name of the step; a new name completes the present step and starts a new one.
            fraction: Share of the step that is done, 0 to 1 [-]; None if unknown.

        Raises:
            StoppedBySignal: A stop was requested in the step before, too late for it to notice.
        """
        if what != self._what:
            self._what, self._is_heard = what, False
            if self._stop is not None:
                raise StoppedBySignal(self._stop)
        self._display.show(what, fraction)

    def stop_requested(self) -> bool:
        """Return whether a stop was requested, by a signal or a call of `request_stop`."""
        self._is_heard = True
        return self._stop is not None

    def request_stop(self, number: int, frame: FrameType | None = None) -> None:
        """Handle a stop signal: request a stop if the present step asks for that, else stop.

        Args:
            number: Number of the signal.
            frame: Interrupted stack frame; unused.

        Raises:
            StoppedBySignal: The step has not called `stop_requested`, or a stop is requested
                already.
        """
        if self._stop is not None or not self._is_heard:
            stop_at_once(number, frame)
        self._stop = number
        self._acknowledge()


class ProgressLines:
    """Shows progress in lines on standard error, one every `LINE_EVERY` s at most.

    Args:
        clock: Returns the time [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._what = ""
        self._began = self._said = clock()

    def show(self, what: str, fraction: float | None) -> None:
        """Print a line if the last one, or the beginning without one, is `LINE_EVERY` ago."""
        now = self._clock()
        if what != self._what:
            self._what, self._began = what, now
        if now - self._said < LINE_EVERY:
            return
        self._said = now
        done = "" if fraction is None else f"{fraction:.0%}, "
        say(f"{what}: {done}{shown_times(now - self._began, fraction)}", err=True)


class _Bars:
    """Draws a bar for each step on a terminal."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._task: TaskID | None = None
        self._what = ""

    def show(self, what: str, fraction: float | None) -> None:
        """Show the share of a step that is done; a new step completes the bar of the one before."""
        total = None if fraction is None else 1.0
        if what != self._what:
            if self._task is not None:
                self._progress.update(self._task, total=1.0, completed=1.0)
            self._task, self._what = self._progress.add_task(what, total=total), what
        if fraction is not None and self._task is not None:
            self._progress.update(self._task, total=total, completed=fraction)


class _Silence:
    """Shows nothing."""

    def show(self, what: str, fraction: float | None) -> None:
        """Do nothing."""


class _TimesColumn(ProgressColumn):
    """Column of a progress bar: elapsed and remaining time of a step."""

    def render(self, task: Task) -> Text:
        """Return elapsed and remaining time of a task as text."""
        elapsed = (task.finished_time if task.finished else task.elapsed) or 0.0
        return Text(shown_times(elapsed, None if task.total is None else task.completed))


def shown_times(elapsed: float, fraction: float | None) -> str:
    """Describe the elapsed time of a step and, at the same pace, the remaining time.

    Args:
        elapsed: Time since the step began [s].
        fraction: Share of the step that is done [-]; None if unknown.

    >>> shown_times(75.0, 0.25), shown_times(7.0, None)
    ('1:15 of this step, about 3:45 left', '0:07 of this step')
    """
    text = f"{_clock_time(elapsed)} of this step"
    if fraction is None or not 0 < fraction < 1:
        return text
    return f"{text}, about {_clock_time(elapsed * (1 - fraction) / fraction)} left"


def _clock_time(seconds: float) -> str:
    """Format a time as M:SS, or H:MM:SS from an hour on."""
    minutes, whole = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{whole:02}" if hours else f"{minutes}:{whole:02}"


@contextmanager
def progress_bar(console: Console | None = None, *, quiet: bool = False) -> Iterator[ProgressBar]:
    """Show progress, and turn SIGINT and SIGTERM into a stop request, during the body.

    A step that asks `stop_requested` is asked to stop; another one, and one that was asked already,
    is stopped at once by `StoppedBySignal`. Only the main thread can call this function.

    Args:
        console: Console to draw bars on, standard error by default; if it is no terminal, lines are
            printed to standard error instead.
        quiet: Whether nothing is shown.

    Yields:
        The watcher to pass to a stage.
    """
    console = console or Console(stderr=True)
    with ExitStack() as stack:
        bar = ProgressBar(*_display(console, stack, quiet=quiet))
        earlier = {s: signal.signal(s, bar.request_stop) for s in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield bar
        finally:
            for number, handler in earlier.items():
                signal.signal(number, handler)


def _display(
    console: Console, stack: ExitStack, *, quiet: bool
) -> tuple[ProgressDisplay, Callable[[], object]]:
    """Return a display for a console, and what tells there that a requested stop is followed.

    Bars are drawn on a terminal, until `stack` is closed; elsewhere lines are printed.
    """
    if quiet:
        return _Silence(), lambda: None
    if not console.is_terminal:
        return ProgressLines(), lambda: None
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        _TimesColumn(),
    )
    progress = stack.enter_context(Progress(*columns, console=console))
    said = "stopping; press Ctrl-C again to quit at once"
    return _Bars(progress), lambda: console.print(said)
