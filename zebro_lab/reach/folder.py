# SPDX-License-Identifier: MIT
"""The result folder of `reach`: table, programs and picture."""

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.result_folder import ResultKind
from zebro_lab.reach.way import CURVE, STOP_TURN_WALK, Way

TABLE, PICTURE = "reach.csv", "reach"
REACH = ResultKind(
    "reach", "reach",
    (TABLE, *in_every_format(PICTURE), f"*{STOP_TURN_WALK}.toml", f"*{CURVE}.toml"),
)  # fmt: skip
"""Kind of folder that `reach` writes."""


def program_name(number: int, manoeuvre: str, *, goals: int) -> str:
    """Return the name of a program's file; that of one of several goals has the goal's number.

    >>> program_name(1, "curve", goals=1), program_name(2, "curve", goals=3)
    ('curve.toml', 'goal2-curve.toml')
    """
    return f"{manoeuvre}.toml" if goals == 1 else f"goal{number}-{manoeuvre}.toml"


def write_table(file: Path, ways: Sequence[Way]) -> None:
    """Write one row a way as CSV, SI; an empty cell for a heading that was not asked for.

    Args:
        file: File to write.
        ways: The ways, at least one.
    """
    rows = [_row(way) for way in ways]
    with file.open("w", encoding="utf-8", newline="") as text:
        writer = csv.DictWriter(text, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _row(way: Way) -> dict[str, str]:
    goal = {"goal": way.number, "x_m": way.goal.x, "y_m": way.goal.y,
            "heading_rad": way.goal.heading}  # fmt: skip
    return {name: _cell(value) for name, value in {**goal, **way.document()}.items()}


def _cell(value: object) -> str:
    if value is None or (isinstance(value, float) and np.isnan(value)):
        return ""
    return f"{value:.10g}" if isinstance(value, float) else str(value)
