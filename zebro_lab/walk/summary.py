# SPDX-License-Identifier: MIT
"""Summary statistics of a walk, and of each segment of a program."""

from dataclasses import dataclass

import numpy as np
from rich.table import Table

from model.arrays import Array
from model.counted import counted
from model.metrics.turning import fitted_radius
from model.poses import Poses
from model.walk.path import WalkPath
from zebro_lab.terminal.tables import plain, plain_table
from zebro_lab.walk.shown_time import leg_turns
from zebro_lab.walk.walking import WalkedSegment

STRAIGHT = 0.05  # rad/m: a radius above 20 m is not visible as a curve on a lab floor


@dataclass(frozen=True)
class WalkSummary:
    """Summary statistics of a walk.

    Attributes:
        duration: Duration of the walk [s].
        end: x, y and yaw of the last pose in the inertial frame [m, m, rad].
        length: Length of the path over the ground [m].
        strides: Number of whole strides that speed, yaw rate and radius are means over. If there is
            none it is 0, and they are means over the whole walk. For a walk of several gaits it is
            0, and the three are NaN.
        speed: Mean speed along the circle through the poses between strides [m/s].
        yaw_rate: Mean yaw rate, positive to the left [rad/s].
        radius: Mean radius of the circle [m], positive to the left; infinite without any turn, NaN
            if the poses between strides, four or more, lie on no circle.
        largest_roll: Largest absolute roll [rad].
        largest_pitch: Largest absolute pitch [rad].
        mean_slip: Mean slip speed of legs in contact [m/s]; NaN without slip or contacts.
    """

    duration: float
    end: tuple[float, float, float]
    length: float
    strides: int
    speed: float
    yaw_rate: float
    radius: float
    largest_roll: float
    largest_pitch: float
    mean_slip: float

    @property
    def straight(self) -> bool:
        """Whether the absolute radius is at least 20 m."""
        return abs(self.radius) >= 1 / STRAIGHT


def summarise(path: WalkPath, *, one_gait: bool = True) -> WalkSummary:
    r"""Compute the summary of a walk.

    Speed and radius are computed from the poses between strides, not from the oscillating path
    within them.

    Args:
        path: The walk.
        one_gait: Whether the legs follow one gait, else there is no mean speed or radius.
    """
    x, y = path.position[-1, :2]
    nan = float("nan")
    strides, circle = 0, (nan, nan, nan)
    if one_gait:
        poses, strides = stride_poses(path)
        circle = circle_of(poses)
    sliding = np.linalg.norm(path.slip_velocity[path.contact], axis=-1)
    largest = np.abs(path.orientation[:, :2]).max(axis=0)
    return WalkSummary(
        duration=float(path.t[-1] - path.t[0]),
        end=(float(x), float(y), float(path.yaw[-1])),
        length=path.length,
        strides=strides,
        speed=circle[0],
        yaw_rate=circle[1],
        radius=circle[2],
        largest_roll=float(largest[0]),
        largest_pitch=float(largest[1]),
        mean_slip=float(sliding.mean()) if len(sliding) else nan,
    )


def circle_of(poses: Array) -> tuple[float, float, float]:
    r"""Compute speed [m/s], yaw rate [rad/s] and radius [m] from poses between strides.

    For a constant gait these poses lie on a circle,

    .. math::
        R = \frac{|\Delta p|}{2 \sin(\Delta\psi / 2)}, \qquad v = R\, \Delta\psi / T ,

    with chord, change of yaw and duration of a stride, each the mean over the strides.

    Args:
        poses: Columns t, x, y, yaw [s, m, m, rad], shape (m, 4), m >= 2.

    Returns:
        The three; yaw rate and radius are positive to the left, the radius is infinite without any
        turn and NaN if the poses, four or more, lie on no circle.
    """
    time, turn = np.diff(poses[:, 0]).mean(), np.diff(poses[:, 3]).mean()
    chord = np.linalg.norm(np.diff(poses[:, 1:3], axis=0), axis=1).mean()
    sine = 2 * np.sin(turn / 2)
    arc = chord if sine == 0 else chord * turn / sine
    return float(arc / time), float(turn / time), _radius(poses, float(chord), float(sine))


def _radius(poses: Array, chord: float, sine: float) -> float:
    """Return the radius [m] by chord [m] and turn of a stride: `sine` is 2 sin(turn / 2).

    Infinite without any turn; NaN if the poses lie on no circle, which is judged for four or more.
    """
    fitted = fitted_radius(Poses(poses[:, 0], poses[:, 1:3], poses[:, 3]))
    if len(poses) >= 4 and np.isnan(fitted):
        return float("nan")
    return float("inf") if sine == 0 else chord / sine


def stride_poses(path: WalkPath) -> tuple[Array, int]:
    """Interpolate the poses between strides: at whole turns of the mean leg angle from the start.

    The first stride is the transient from standstill and is left out if there are several.

    Args:
        path: The walk.

    Returns:
        Columns t, x, y, yaw [s, m, m, rad], shape (m, 4), m >= 2, and the number of strides
        m - 1; the first and last sample and 0 if the legs do not complete a turn.
    """
    turns = leg_turns(path)
    # A stride may end with the walk, within rounding.
    whole = int(np.floor(turns[-1] + 1e-6))
    columns = np.column_stack([path.t, path.position[:, :2], path.yaw])
    if whole < 1:
        return columns[[0, -1]], 0
    wanted = np.arange(1 if whole > 1 else 0, whole + 1)
    rising = np.concatenate([[True], np.diff(turns) > 0])  # np.interp needs increasing values
    poses = [np.interp(wanted, turns[rising], column[rising]) for column in columns.T]
    return np.column_stack(poses), len(wanted) - 1


@dataclass(frozen=True)
class SegmentSummary:
    """Summary statistics of a segment of a program.

    Attributes:
        segment: What it does, its cycles and end.
        pose: x, y and yaw at its end [m, m, rad].
        length: Length of the path over the ground [m].
        turn: Change of heading, positive to the left [rad].
        speed: Mean speed along the circle through the poses between cycles; NaN of a stand [m/s].
        radius: Mean radius of that circle [m], positive to the left, infinite without any turn; NaN
            of a stand, and if the poses between cycles, four or more, lie on no circle.
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
    """Summarise one segment, from `begin` [s] to its end, as `segment_summaries` says."""
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
