# SPDX-License-Identifier: MIT
"""Summary of a program's walk, segment by segment: as a table for people, and for `--json`."""

from dataclasses import dataclass

import numpy as np
from rich.table import Table

from model.counted import counted
from model.walk.path import WalkPath
from zebro_lab.terminal.messages import plain
from zebro_lab.terminal.tables import plain_table
from zebro_lab.walk.asked import WalkedSegment
from zebro_lab.walk.summary import STRAIGHT, circle_of


@dataclass(frozen=True)
class SegmentSummary:
    """Summary statistics of a segment of a program.

    Attributes:
        segment: What it does, its cycles and end.
        pose: x, y and yaw at its end [m, m, rad].
        length: Length of the path over the ground [m].
        turn: Change of heading, positive to the left [rad].
        speed: Mean speed along the circle through the poses between cycles; NaN of a stand [m/s].
        radius: Mean radius of that circle, positive to the left, infinite without any turn; NaN of
            a stand [m].
    """

    segment: WalkedSegment
    pose: tuple[float, float, float]
    length: float
    turn: float
    speed: float
    radius: float

    def document(self) -> dict[str, object]:
        """Return the summary for `--json`; keys end in the unit."""
        x, y, yaw = self.pose
        return {
            "what": self.segment.what,
            "cycles": self.segment.cycles,
            "end_s": self.segment.end,
            "x_m": x,
            "y_m": y,
            "yaw_rad": yaw,
            "length_m": self.length,
            "turn_rad": self.turn,
            "speed_m_per_s": self.speed,
            "radius_m": self.radius,
        }


def segment_summaries(
    path: WalkPath, segments: tuple[WalkedSegment, ...]
) -> tuple[SegmentSummary, ...]:
    """Summarise each segment of a program's walk.

    Speed and radius are those of the circle through the poses between cycles, of which the first,
    in which one gait hands the legs over to the next, is left out if there are several.

    Args:
        path: The walk.
        segments: The segments.
    """
    found, begin = [], float(path.t[0])
    for segment in segments:
        found.append(_summary(path, segment, begin))
        begin = segment.end
    return tuple(found)


def _summary(path: WalkPath, segment: WalkedSegment, begin: float) -> SegmentSummary:
    t = np.linspace(begin, segment.end, segment.cycles + 1 if segment.cycles else 2)
    columns = (path.t, path.position[:, 0], path.position[:, 1], path.yaw)
    poses = np.column_stack([np.interp(t, path.t, column) for column in columns])
    steady = poses[1:] if segment.cycles > 1 else poses
    nan = float("nan")
    speed, _, radius = circle_of(steady) if segment.cycles else (nan, nan, nan)
    within = (path.t >= begin - 1e-9) & (path.t <= segment.end + 1e-9)
    _, x, y, yaw = poses[-1].tolist()
    turn = float(poses[-1, 3] - poses[0, 3])
    return SegmentSummary(segment, (x, y, yaw), path.part(within).length, turn, speed, radius)


def segment_table(summaries: tuple[SegmentSummary, ...]) -> Table:
    """Return a table of a program's segments: end, pose there, length, turn, speed and radius.

    It fits in 80 columns: what a segment does is folded, numbers are not.
    """
    numbers = ("end\n[s]", "x\n[m]", "y\n[m]", "yaw\n[deg]", "length\n[m]", "turn\n[deg]",
               "speed\n[mm/s]", "radius\n[m]")  # fmt: skip
    title = "the program, segment by segment"
    table = plain_table(title, ("segment",), numbers, fold=True, no_wrap=True)
    table.padding, table.pad_edge = (0, 1, 0, 0), False
    for number, each in enumerate(summaries, start=1):
        x, y, yaw = each.pose
        cycles = f", {counted(each.segment.cycles, 'cycle')}" if each.segment.cycles else ""
        table.add_row(
            plain(f"{number}: {each.segment.what}{cycles}"), f"{each.segment.end:.2f}",
            f"{x:.3f}", f"{y:.3f}", f"{np.degrees(yaw):.1f}", f"{each.length:.3f}",
            f"{np.degrees(each.turn):.1f}", *_course(each),
        )  # fmt: skip
    return table


def _course(summary: SegmentSummary) -> tuple[str, str]:
    """Return cells of speed and radius; a stand has none."""
    if np.isnan(summary.speed):
        return "-", "-"
    straight = abs(summary.radius) >= 1 / STRAIGHT
    return f"{1000 * summary.speed:.1f}", "straight" if straight else f"{summary.radius:.3f}"
