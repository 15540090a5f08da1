# SPDX-License-Identifier: MIT
"""Terminal output of `reach`: the table of ways, and what it says."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from zebro_lab.reach.stage import ReachResult
from zebro_lab.reach.way import Way, compared, missed, named
from zebro_lab.terminal.result import print_result
from zebro_lab.terminal.tables import plain, plain_table


def print_reached(console: Console, reached: ReachResult, out: Path) -> None:
    """Print the table of ways, warnings, which way is faster and cheaper, notes and files.

    Args:
        console: Console to print to.
        reached: The ways.
        out: Folder that was written.
    """
    parts = [f"SIMULATED ways to goals: {reached.title}", way_table(reached.ways), *lines(reached)]
    files = [path for name in ("reach.*", "*.toml") for path in sorted(out.glob(name))]
    print_result(console, parts, out=out, files=files)


def way_table(ways: Sequence[Way]) -> Table:
    """Return a table of ways: time, length, work, energy to slip, and errors at the end."""
    numbers = ("time\n[s]", "path\n[m]", "work\ndone\n[J]", "taken\nback\n[J]", "to\nslip\n[J]",
               "place\noff\n[mm]", "heading\noff\n[deg]")  # fmt: skip
    title = "ways to goals"
    table = plain_table(title, ("goal", "manoeuvre"), numbers, fold=True, no_wrap=True)
    table.padding, table.pad_edge = (0, 1, 0, 0), False
    table.columns[1].no_wrap = True
    last = 0
    for way in ways:
        off = way.heading_error
        table.add_row(
            plain(f"{way.number}: {named(way.goal)}") if way.number != last else "",
            way.manoeuvre, f"{way.time:.2f}", f"{way.path.length:.3f}", f"{way.work.done:.2f}",
            f"{way.work.taken_back:.2f}", f"{way.work.slip:.2f}", f"{1000 * way.place_error:.1f}",
            "-" if np.isnan(off) else f"{np.degrees(off):.2f}",
        )  # fmt: skip
        last = way.number
    return table


def lines(reached: ReachResult) -> list[str]:
    """Return warnings of goals that are missed, a sentence for each goal, and notes."""
    warnings = [line for line in map(missed, reached.ways) if line is not None]
    said = [
        compared(*(way for way in reached.ways if way.number == number))
        for number in range(1, len(reached.goals) + 1)
    ]
    return [*warnings, *said, *reached.notes]


def reach_document(reached: ReachResult) -> dict[str, object]:
    """Return the ways to each goal for `--json`; keys end in the unit."""
    goals = [
        {
            "x_m": goal.x,
            "y_m": goal.y,
            "heading_rad": goal.heading,
            "ways": [way.document() for way in reached.ways if way.number == number],
        }
        for number, goal in enumerate(reached.goals, start=1)
    ]
    return {
        "title": reached.title,
        "simulated": True,
        "stride_m": reached.stride.length,
        "goals": goals,
        "notes": lines(reached),
    }
