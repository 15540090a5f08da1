# SPDX-License-Identifier: MIT
"""Terminal display of an experiment: state, progress, prompts, verdicts; keyboard commands.

The acquiring thread only stores values here. A separate thread draws, so that a stopped or slow
terminal does not delay the guards.
"""

import os
import select
import sys
import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Final

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.text import Text

from rig.errors import LinkError, ProtocolError
from rig.experiment.condition import Condition, RigState
from rig.experiment.control import Control
from rig.experiment.sink import ExperimentWatcher
from rig.experiment.steps import Point
from rig.experiment.supervision import start_thread
from rig.experiment.verdict import PointVerdict
from zebro_lab.files.errors import shown
from zebro_lab.terminal.tables import plain

KEYS: Final = {"p": "pause", "r": "resume", "": "confirm", "s": "soft", "ss": "safe",
               "e": "emergency"}  # fmt: skip
LONGEST_LINE: Final = 4096
"""Length to which a line is truncated; the longest line of common terminals [bytes]."""
WAIT: Final = 200
"""Polling interval for the end of the run [ms]."""


class Keyboard:
    """Reader of keyboard commands from a terminal, one per line: a key of `KEYS`, or in full.

    Args:
        handle: File descriptor of the terminal.
        control: Mailbox of the run, which executes the commands.
    """

    def __init__(self, handle: int, control: Control) -> None:
        self._handle = handle
        self._control = control
        self._line = b""
        self._over = False

    def close(self) -> None:
        """End `listen` within the polling interval `WAIT`; the terminal stays open.

        On Windows it ends only after the next input.
        """
        self._over = True

    def listen(self) -> None:
        """Read and execute commands until closed.

        Raises:
            LinkError: The terminal is gone, so that its keys can no longer stop the run.
            OSError: The terminal cannot be read.
        """
        if not hasattr(select, "poll"):  # Windows, whose consoles cannot be waited for
            while not self._over:
                self.take(os.read(self._handle, LONGEST_LINE))
        terminal = select.poll()
        terminal.register(self._handle, select.POLLIN)
        while not self._over:
            for _, found in terminal.poll(WAIT):
                # Input typed before the terminal disappeared is read first.
                data = os.read(self._handle, LONGEST_LINE) if found & select.POLLIN else b""
                if not data and found & ~select.POLLIN:  # hung up, or no file any more
                    raise LinkError("the terminal was closed")
                self.take(data)

    def take(self, data: bytes) -> None:
        """Buffer typed bytes and execute complete lines; unknown commands and Ctrl-D do nothing."""
        *lines, rest = (self._line + data).split(b"\n")
        self._line = rest[:LONGEST_LINE]
        for line in lines:
            self._obey(line[:LONGEST_LINE])

    def _obey(self, line: bytes) -> None:
        """Execute a typed line, a key of `KEYS` or a command in full; ignore any other."""
        key = line.decode("utf-8", "backslashreplace").strip()
        try:
            self._control.execute(KEYS.get(key, key), who="keyboard")
        except ProtocolError:  # a mistyped command has no effect
            return


WIDTH = 64
PERIOD: Final = 0.125
"""Refresh interval of the display [s]."""
LAST_PICTURE: Final = 1.0
"""Timeout of the display for the last lines, and of the keyboard thread [s]."""
_STYLES: Final = {
    RigState.RUNNING: "green", RigState.HOLDING: "bold yellow", RigState.STOPPING: "bold yellow",
    RigState.LATCHED: "bold red",
}  # fmt: skip


@dataclass(frozen=True)
class ScreenPicture:
    """Content of the screen at one instant.

    Attributes:
        condition: State of the run; None before it begins.
        head: Present step, finished points and remaining time as text.
        done: Number of finished points.
        of: Number of all points, at least 1.
        prompt: Instruction to the operator; empty without one.
    """

    condition: Condition | None = None
    head: str = ""
    done: int = 0
    of: int = 1
    prompt: str = ""

    def render(self) -> RenderableType:
        """Return the content as Rich text: state, keys, `head`, bar, prompt.

        `head`, with step, finished points and time left, is left out while the run holds, stops
        or is latched; state and keys before it begins.
        """
        parts: list[RenderableType] = []
        if self.condition is not None:
            style = _STYLES.get(self.condition.state, "")
            keys = self.condition.keys.replace("; ", "\n")
            parts = [Text(shown(self.condition.headline), style=style), Text(keys)]
        # A run that holds or stops makes no progress: its figures would only mislead.
        if self.condition is None or self.condition.state is RigState.RUNNING:
            parts.append(plain(self.head))
        parts.append(ProgressBar(total=self.of, completed=self.done, width=WIDTH))
        return Group(*parts, Text("\n" + shown(self.prompt), style="bold"))  # a bar ends no line


class ExperimentScreen(ExperimentWatcher):
    """Display of an experiment that stores changes at once and draws them in `draw_on`.

    Args:
        console: Console to draw on.
        live: Part that is redrawn in place; None without a terminal: changes are printed lines.
    """

    def __init__(self, console: Console, live: Live | None) -> None:
        self._console = console
        self._live = live
        self._picture = ScreenPicture()
        self._shown: ScreenPicture | None = None
        self._lines: deque[str] = deque()
        self._over = threading.Event()

    def changed(self, condition: Condition) -> None:
        """Show a new state of the run and clear the prompt; see `ExperimentWatcher.changed`.

        Without a terminal the state is printed as a line.
        """
        self._picture = replace(self._picture, condition=condition, prompt="")
        if self._live is None:
            self._lines.append(f"{condition.headline}; {condition.keys}")

    def notice(self, text: str) -> None:
        """Print a line, on a terminal above the redrawn part; see `ExperimentWatcher.notice`."""
        self._lines.append(text)

    def doing(self, what: str, *, done: int, of: int, left: float) -> None:
        """Show the step that begins and clear the prompt; see `ExperimentWatcher.doing`.

        Args:
            what: Name of the step.
            done: Number of finished points.
            of: Number of all points.
            left: Estimated remaining time [s].
        """
        minutes, seconds = divmod(round(left), 60)
        head = f"{what}: {done} of {of} points finished, {minutes} min {seconds:02d} s left"
        self._picture = replace(self._picture, head=head, done=done, of=max(of, 1), prompt="")

    def prompt(self, text: str, *, normal: float) -> None:
        """Show an instruction to the operator; without a terminal print each new one once.

        Args:
            text: Instruction, replaced by the next `changed`, `doing` or `prompt`.
            normal: Present normal force [N].
        """
        if self._live is not None:
            self._picture = replace(self._picture, prompt=f"{text}; it is {normal:.2f} N now")
        elif self._picture.prompt != text:
            self._lines.append(text)
            self._picture = replace(self._picture, prompt=text)

    def judged(self, point: Point, verdict: PointVerdict, *, attempt: int) -> None:
        """Print the verdict on a point; see `ExperimentWatcher.judged`.

        Args:
            point: The point.
            verdict: Result of its quality checks.
            attempt: Number of the attempt, from 1.
        """
        result = "; ".join(verdict.problems) or "good"
        self._lines.append(
            f"{point.label} (attempt {attempt}): {result}; slip ratio {verdict.slip:.4f}, "
            f"friction coefficient {verdict.friction:.3f}, normal force "
            f"{verdict.normal_force:.2f} N"
        )

    def draw_on(self) -> None:
        """Draw changes every `PERIOD` until `close`, then a last time.

        Raises:
            BrokenPipeError: The output pipe was closed by its reader.
        """
        try:
            while not self._over.wait(PERIOD):
                self.draw()
            self.draw()
        except SystemExit as error:  # how Rich answers a pipe that was closed
            raise BrokenPipeError(
                "the output pipe was closed; write to a terminal or a file"
            ) from error

    def draw(self) -> None:
        """Print the waiting lines, and redraw the live part where its content has changed."""
        while self._lines:
            self._console.print(plain(self._lines.popleft()))
        if self._live is not None and self._picture is not self._shown:
            self._shown = self._picture
            self._live.update(self._shown.render(), refresh=True)

    def close(self) -> None:
        """Let `draw_on` draw the remaining changes and return."""
        self._over.set()


class QuietScreen(ExperimentScreen):
    """Prints only what waits for a person: instructions, and that the run holds.

    Args:
        console: Console to print on.
    """

    def __init__(self, console: Console) -> None:
        super().__init__(console, None)

    def changed(self, condition: Condition) -> None:
        """Print that the run holds, and with which key it goes on."""
        if condition.state is RigState.HOLDING:
            super().changed(condition)

    def notice(self, text: str) -> None:
        """Print nothing."""

    def judged(self, point: Point, verdict: PointVerdict, *, attempt: int) -> None:
        """Print nothing."""


@contextmanager
def experiment_screen(
    console: Console, control: Control, *, quiet: bool = False
) -> Iterator[ExperimentScreen]:
    """Show an experiment on a console while the body runs, and execute keyboard commands.

    Args:
        console: Console to draw on; keys are read only if it and standard input are terminals.
        control: Mailbox of the run; receives commands, and failures of screen or keyboard.
        quiet: Print only what waits for a person.

    Raises:
        PartFailed: The thread of the screen or of the keyboard cannot be started.
    """
    is_drawn = console.is_terminal and not quiet
    live = Live(console=console, auto_refresh=False) if is_drawn else None
    screen = QuietScreen(console) if quiet else ExperimentScreen(console, live)

    def draw() -> None:
        """Draw until the screen is closed; on a terminal with the live part shown."""
        if live is None:
            screen.draw_on()
            return
        with live:
            screen.draw_on()

    with _keys(console, control):
        thread = start_thread(draw, name="screen", control=control)
        try:
            yield screen
        finally:
            screen.close()
            thread.join(LAST_PICTURE)


@contextmanager
def _keys(console: Console, control: Control) -> Iterator[None]:
    """Execute keyboard commands of a terminal while the body runs; nothing without a terminal."""
    # Standard input is None where a shell has closed it.
    if not (console.is_terminal and sys.stdin is not None and sys.stdin.isatty()):
        yield
        return
    keyboard = Keyboard(sys.stdin.fileno(), control)
    thread = start_thread(keyboard.listen, name="keyboard", control=control)
    try:
        yield
    finally:
        keyboard.close()
        thread.join(LAST_PICTURE)
