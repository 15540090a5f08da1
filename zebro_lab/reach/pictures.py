# SPDX-License-Identifier: MIT
"""Picture of the ways to goals."""

from collections.abc import Sequence
from pathlib import Path

from model.robot import Robot
from zebro_lab.reach.way import Way, named


def draw_ways(file: Path, ways: Sequence[Way], robot: Robot, *, title: str) -> None:
    """Draw both ways to each goal from above, with the robot at start and ends.

    Args:
        file: File to write.
        ways: The ways.
        robot: The robot, for the size of its body.
        title: Title of the figure.
    """
    from zebro_lab.plots import save  # matplotlib takes most of a second
    from zebro_lab.plots.ways import DrawnGoal, ways_to_goals

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
