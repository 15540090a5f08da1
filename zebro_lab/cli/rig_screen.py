# SPDX-License-Identifier: MIT
"""What is seen of an experiment: progress, prompts and the slip curve as it grows; and its keys."""

import contextlib
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.text import Text

from rig.errors import ProtocolError
from rig.experiment.control import Control
from rig.experiment.steps import Point
from rig.experiment.verdict import Verdict

WIDTH, HEIGHT = 64, 14
MARKS = "ox+*#@%&"
KEYS = {"p": "pause", "r": "resume", "": "confirm", "s": "soft", "ss": "safe", "e": "emergency"}
HELP = "keys, each with Enter: Enter confirm, p pause, r resume, s soft, ss safe, e emergency stop"


class ExperimentScreen:
    """Follows an experiment on a console; without a terminal each point is a line.

    Args:
        console: Where to draw.
        live: The part that is drawn anew; None without a terminal.
    """

    def __init__(self, console: Console, live: Live | None) -> None:
        self._console = console
        self._live = live
        self._points: list[tuple[float, float, float]] = []
        self._head = ""
        self._done, self._of = 0, 1
        self._prompt = ""

    def doing(self, what: str, *, done: int, of: int, left: float) -> None:
        """Show what begins; see `Watcher.doing`."""
        minutes, seconds = divmod(round(left), 60)
        self._head = f"{what}: {done} of {of} points, {minutes}:{seconds:02d} left"
        self._done, self._of, self._prompt = done, max(of, 1), ""
        self._draw()

    def prompt(self, text: str, *, normal: float) -> None:
        """Show what the operator is to do and the force now; see `Watcher.prompt`."""
        if self._live is None and self._prompt != text:
            self._console.print(text)
            self._prompt = text
        elif self._live is not None:
            self._prompt = f"{text}; now {normal:.2f} N"
            self._draw()

    def judged(self, point: Point, verdict: Verdict, *, attempt: int) -> None:
        """Show what a point is worth; see `Watcher.judged`."""
        worth = "; ".join(verdict.problems) or "good"
        if verdict.accepted:
            self._points.append((point.load, verdict.slip, verdict.friction))
        if self._live is None or not verdict.accepted:
            self._console.print(
                f"{point.label} (attempt {attempt}): {worth}; slip {verdict.slip:.4f}, "
                f"friction {verdict.friction:.3f}, normal {verdict.normal_force:.2f} N"
            )
        self._draw()

    def _draw(self) -> None:
        if self._live is None:
            return
        bar = ProgressBar(total=self._of, completed=self._done, width=WIDTH)
        chart = Text(slip_chart(self._points))
        self._live.update(Group(Text(self._head), bar, chart, Text(self._prompt), Text(HELP)))


def slip_chart(points: list[tuple[float, float, float]]) -> str:
    """Draw friction over slip in characters, a mark a load.

    Args:
        points: Load [N], slip ratio [-] and friction [-] of each.

    >>> slip_chart([])
    ''
    """
    if not points:
        return ""
    low, high = min(p[1] for p in points), max(p[1] for p in points)
    bottom, top = min(0.0, *(p[2] for p in points)), max(p[2] for p in points)
    rows = [[" "] * WIDTH for _ in range(HEIGHT)]
    loads = sorted({load for load, _, _ in points})
    for load, slip, friction in points:
        column = round((slip - low) / max(high - low, 1e-9) * (WIDTH - 1))
        row = round((friction - bottom) / max(top - bottom, 1e-9) * (HEIGHT - 1))
        rows[HEIGHT - 1 - row][column] = MARKS[loads.index(load) % len(MARKS)]
    legend = ", ".join(f"{MARKS[k % len(MARKS)]} {load:g} N" for k, load in enumerate(loads))
    body = "\n".join("".join(row).rstrip() for row in rows)
    return f"friction {bottom:.2f} to {top:.2f} over slip {low:.2f} to {high:.2f}: {legend}\n{body}"


@contextmanager
def experiment_screen(console: Console, control: Control) -> Iterator[ExperimentScreen]:
    """Show an experiment on a console while the body runs; a terminal's keys command it.

    Args:
        console: Where to draw.
        control: Mailbox of the run.
    """
    if not console.is_terminal:
        yield ExperimentScreen(console, None)
        return
    with Live(console=console, refresh_per_second=8) as live:
        if sys.stdin.isatty():
            threading.Thread(target=_listen, args=(control,), daemon=True, name="keys").start()
        yield ExperimentScreen(console, live)


def _listen(control: Control) -> None:
    for line in sys.stdin:
        key = line.strip()
        with contextlib.suppress(ProtocolError):  # a slip of the finger commands nothing
            control.obey(KEYS.get(key, key), who="keyboard")
