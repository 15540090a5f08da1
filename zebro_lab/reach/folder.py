# SPDX-License-Identifier: MIT
"""The result folder of `reach`: table, programs and picture."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import tomlkit

from model.robot import Robot
from model.routes.manoeuvre import Part, Stepping
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.result_folder import ResultKind
from zebro_lab.plots import save
from zebro_lab.plots.ways import DrawnGoal, ways_to_goals
from zebro_lab.reach.request import SteppingRequest
from zebro_lab.reach.way import CURVE, STOP_TURN_WALK, Way, named

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
    rows = [
        {
            "goal": way.number, "x_m": way.goal.x, "y_m": way.goal.y,
            "heading_rad": way.goal.heading, **way.document(),
        }
        for way in ways
    ]  # fmt: skip
    pd.DataFrame(rows).to_csv(file, index=False, float_format="%.10g", lineterminator="\n")


def draw_ways(file: Path, ways: Sequence[Way], robot: Robot, *, title: str) -> None:
    """Draw both ways to each goal from above, with the robot at start and ends.

    Args:
        file: File to write.
        ways: The ways.
        robot: The robot, for the size of its body.
        title: Title of the figure.
    """
    numbers = dict.fromkeys(way.number for way in ways)
    goals = [
        DrawnGoal(
            f"goal {number}: {named(mine[0].goal)}" if len(numbers) > 1 else named(mine[0].goal),
            (mine[0].goal.x, mine[0].goal.y), mine[0].goal.heading,
            {way.manoeuvre: way.path for way in mine},
        )
        for number in numbers
        if (mine := [way for way in ways if way.number == number])
    ]  # fmt: skip
    ground = ways[0].walked.heights
    save(ways_to_goals(goals, robot, title=title, ground=ground), file)


_DIGITS = 6  # decimals of steering and of degrees; a micrometre in a metre


def program_text(
    parts: Sequence[Part], stepping: Stepping, request: SteppingRequest, *, about: Sequence[str]
) -> str:
    """Return the text of a program with a segment for each part.

    Args:
        parts: The parts.
        stepping: Gait, times and angles that they have in common.
        request: The options: gait and times are written as they were given there.
        about: Lines of a comment at its beginning.
    """
    document = tomlkit.document()
    for line in about:
        document.add(tomlkit.comment(line))
    segments = tomlkit.aot()
    for part in parts:
        segments.append(tomlkit.item(_segment(part, stepping, request)))
    document.add("segment", segments)
    return tomlkit.dumps(document)


def _segment(part: Part, stepping: Stepping, request: SteppingRequest) -> dict[str, object]:
    """Return the keys of a part's `[[segment]]`: gait, times, steering, angles [deg], strides."""
    down, up = stepping.stance(part.share)
    segment: dict[str, object] = {"gait": request.gait, **_times(request)}
    if part.bend != 0:
        segment |= {"steering": round(part.steering, _DIGITS), "direction": part.direction}
    segment["touchdown_deg"] = round(float(np.degrees(down)), _DIGITS)
    if up is not None:
        segment["liftoff_deg"] = round(float(np.degrees(up)), _DIGITS)
    until = tomlkit.inline_table()
    until["strides"] = part.strides
    return {**segment, "until": until}


def _times(request: SteppingRequest) -> dict[str, float]:
    """Return the times that were given, by their keys in a program."""
    times = {"cycle": request.cycle, "ground_time": request.tau_ground,
             "flight_time": request.tau_flight}  # fmt: skip
    given = {name: value for name, value in times.items() if value is not None}
    return {**given, **({"double_stance": request.tau_double} if request.tau_double else {})}
