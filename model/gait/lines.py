# SPDX-License-Identifier: MIT
"""Straight lines through one leg's counted angles, compiled; see `model.gait.inexact_log`."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.compiled import compiled

FASTEST = 60.0  # largest speed of a line, beyond any leg's [rad/s]
HALVINGS = 60  # bisections of a line's speed
SPEEDS = 33  # speeds by which the lines that pass a group of samples are described
SAME = 1e-9  # rad: angles no further apart are one count


class Samples(NamedTuple):
    """First and last sample of each stay of a leg at one count; they imply all samples between.

    Attributes:
        t: Times, increasing, shape (n,) [s].
        angle: Counted angles, middles of their bins, shape (n,) [rad].
    """

    t: Array
    angle: Array


class Lines(NamedTuple):
    """Straight lines of a leg's angle over time: successive constant speeds.

    Attributes:
        x: A time on each line, shape (k,) [s].
        angle: Angle of each line at that time, shape (k,) [rad].
        speed: Slope of each line, shape (k,) [rad/s].
    """

    x: Array
    angle: Array
    speed: Array


class Passing(NamedTuple):
    """All lines that pass each of k groups of samples: a range of angles for each speed.

    Attributes:
        x: Mean time of each group, shape (k,) [s].
        speed: Evenly spaced speeds, shape (k, SPEEDS) [rad/s].
        low: Least angle at x of a line of each speed, shape (k, SPEEDS) [rad].
        high: Largest angle at x of a line of each speed, shape (k, SPEEDS) [rad].
    """

    x: Array
    speed: Array
    low: Array
    high: Array


@compiled
def split(samples: Samples, half: float) -> NDArray[np.intp]:
    """Split samples greedily into the fewest successive groups that a straight line passes.

    A line passes a sample if it lies within `half` of the counted angle. Its speed is at most
    `FASTEST` either way. Each group is as long as it can be, from the first one on.

    Args:
        samples: The samples, at least one.
        half: Half a count plus the tolerance of a line [rad].

    Returns:
        Index of each group's first sample, then the number of samples, shape (k + 1,).
    """
    n = len(samples.t)
    first = np.empty(n + 1, dtype=np.intp)
    count, at = 1, 0
    first[0] = 0
    while at < n:
        at = _reach(samples, at, half)
        first[count] = at
        count += 1
    return first[:count].copy()


@compiled
def _reach(samples, start, half):
    """Return the end of the longest group of samples from `start` on that one line passes.

    That is the index of the first sample beyond it, found by doubling the group, then bisection.
    """
    n = len(samples.t)
    passed, failed = start + 1, n + 1  # a line passes up to the first, none up to the second
    span, m = 2, 0.0
    while passed < n and failed - passed > 1:
        end = min(start + span, n) if failed > n else (passed + failed) // 2
        fits, m = _slope(samples, start, end, half, m)
        if fits:
            passed, span = end, 2 * span
        else:
            failed = end
    return passed


@compiled
def _slope(samples, start, end, half, m):
    """Search a slope, by bisection from m on, of a line within `half` of samples start to end - 1.

    Return whether there is one, and the last slope tried [rad/s].
    """
    low, high = -FASTEST, FASTEST
    for attempt in range(HALVINGS):
        m = m if attempt == 0 else 0.5 * (low + high)
        floor, ceiling, rise = _range(samples, start, end, half, m)
        if floor <= ceiling:
            return True, m
        low, high = (low, m) if rise > 0 else (m, high)
    return False, m


@compiled
def _range(samples, begin, end, half, m):
    """Return least and largest angle, at sample `begin`, of lines of slope m that pass a group.

    They lie within `half` of the samples begin to end - 1. No line passes if the least angle is
    above the largest. The third value is the derivative of least minus largest by the slope; the
    difference is convex in the slope, so that bisection by this sign finds its minimum.
    """
    floor, ceiling = -np.inf, np.inf
    floor_t, ceiling_t = 0.0, 0.0
    for k in range(begin, end):
        t = samples.t[k] - samples.t[begin]
        value = samples.angle[k] - m * t
        if value - half > floor:
            floor, floor_t = value - half, t
        if value + half < ceiling:
            ceiling, ceiling_t = value + half, t
    return floor, ceiling, ceiling_t - floor_t


@compiled
def closest(samples: Samples, begin: int, end: int) -> tuple[float, float]:
    """Find the minimax (Chebyshev) line of a group of samples: its largest distance is the least.

    Args:
        samples: The samples.
        begin: Index of the group's first sample.
        end: Index after that of its last sample.

    Returns:
        Speed of the line [rad/s], and its largest distance from a counted angle [rad].
    """
    low, high = -FASTEST, FASTEST
    m = 0.0
    for _ in range(HALVINGS):
        _, _, rise = _range(samples, begin, end, 0.0, m)
        low, high = (low, m) if rise > 0 else (m, high)
        m = 0.5 * (low + high)
    floor, ceiling, _ = _range(samples, begin, end, 0.0, m)
    return m, 0.5 * (floor - ceiling)


@compiled
def passing(
    samples: Samples, begin: NDArray[np.intp], end: NDArray[np.intp], half: Array
) -> Passing:
    """Describe all lines that pass each group of samples.

    A group of a single count is a rest: its lines have no speed.

    Args:
        samples: The samples.
        begin: Index of each group's first sample, shape (k,).
        end: Index after that of each group's last sample, shape (k,).
        half: How far from a counted angle a line of each group may lie, no less than `closest`
            does, shape (k,) [rad].
    """
    k = len(begin)
    found = Passing(
        np.empty(k), np.empty((k, SPEEDS)), np.empty((k, SPEEDS)), np.empty((k, SPEEDS))
    )
    for i in range(k):
        slowest = fastest = 0.0
        if np.ptp(samples.angle[begin[i] : end[i]]) > SAME:
            m, _ = closest(samples, begin[i], end[i])
            slowest = _last(samples, begin[i], end[i], half[i], m, -FASTEST)
            fastest = _last(samples, begin[i], end[i], half[i], m, FASTEST)
        found.x[i] = samples.t[begin[i] : end[i]].mean()
        for j in range(SPEEDS):
            m = slowest + (fastest - slowest) * j / (SPEEDS - 1)
            floor, ceiling, _ = _range(samples, begin[i], end[i], half[i], m)
            to_x = m * (found.x[i] - samples.t[begin[i]])
            middle, reach = 0.5 * (floor + ceiling), max(0.5 * (ceiling - floor), 0.0)
            found.speed[i, j] = m
            found.low[i, j], found.high[i, j] = to_x + middle - reach, to_x + middle + reach
    return found


@compiled
def _last(samples, begin, end, half, inside, outside):
    """Return the speed closest to `outside` of a line that passes the group, by bisection.

    A line of the speed `inside` must pass; `half` is as for `_range`.
    """
    for attempt in range(HALVINGS):
        m = outside if attempt == 0 else 0.5 * (inside + outside)
        floor, ceiling, _ = _range(samples, begin, end, half, m)
        if floor > ceiling:
            outside = m
        elif attempt == 0:
            return outside
        else:
            inside = m
    return inside


@compiled
def middle(lines: Passing) -> Lines:
    """Average all lines that pass each group, distributed evenly over speed and angle."""
    k = len(lines.x)
    found = Lines(lines.x, np.empty(k), np.empty(k))
    for i in range(k):
        weight = lines.high[i] - lines.low[i] + 1e-12  # not all zero where only one line passes
        weight /= weight.sum()
        found.angle[i] = (weight * 0.5 * (lines.low[i] + lines.high[i])).sum()
        found.speed[i] = (weight * lines.speed[i]).sum()
    return found


@compiled
def chosen(lines: Passing, place: Array) -> Lines:
    """Choose one line of each group: evenly distributed places give evenly distributed lines.

    Args:
        lines: The lines that pass each group.
        place: Share of the lines that are slower, and share of those as fast that are lower, both
            from 0 to 1, shape (k, 2) [-].
    """
    k = len(lines.x)
    found = Lines(lines.x, np.empty(k), np.empty(k))
    for i in range(k):
        width = lines.high[i] - lines.low[i] + 1e-12
        slower = np.zeros(SPEEDS)
        slower[1:] = np.cumsum(width[1:] + width[:-1])
        at = np.array([place[i, 0] * slower[-1]])
        low, high = np.interp(at, slower, lines.low[i])[0], np.interp(at, slower, lines.high[i])[0]
        found.speed[i] = np.interp(at, slower, lines.speed[i])[0]
        found.angle[i] = low + place[i, 1] * (high - low)
    return found


@compiled
def knots(
    samples: Samples,
    earliest: NDArray[np.intp],
    latest: NDArray[np.intp],
    lines: Lines,
    rest: float,
    half: float,
) -> Array:
    """Compute the knots of the piecewise linear angle, where each line passes into the next.

    The first and the last knot are at the first and last sample. A time before that of the knot
    before it is raised to it.

    Args:
        samples: The samples.
        earliest: Least index of each line's first sample, then the number of samples, (k + 1,).
        latest: Largest index of each line's first sample, likewise, (k + 1,).
        lines: The k lines.
        rest: Angle of a rest between two lines, from the middle of its count [rad].
        half: Half a count plus the tolerance of a line [rad].

    Returns:
        Rows of times, not decreasing, [s] and of angles [rad], shape (2, m).
    """
    k = len(lines.x)
    found = np.empty((2, 2 * k + 2))
    n = _add(found, 0, samples.t[0], _at(lines, 0, samples.t[0]))
    for i in range(k - 1):
        n = _junction(samples, earliest[i + 1], latest[i + 1], lines, i, rest, half, found, n)
    n = _add(found, n, samples.t[-1], _at(lines, k - 1, samples.t[-1]))
    for i in range(1, n):
        found[0, i] = max(found[0, i], found[0, i - 1])
    return found[:, :n]


@compiled
def _junction(samples, earliest, latest, lines, i, rest, half, found, n):
    """Add the knots between line i and the next to the n in `found`; return their new number.

    It is the lines' intersection, if that lies between the last sample that is certainly of line i
    and the first that is certainly of the next. Else both lines end beside the first sample that
    line i does not pass: at the ends of a plateau, if both reach it in time, or at the samples
    before and after. Arguments are those of `knots`, with the next line's earliest and latest.
    """
    if lines.speed[i] != lines.speed[i + 1]:
        apart = _at(lines, i + 1, lines.x[i]) - lines.angle[i]
        x = lines.x[i] + apart / (lines.speed[i] - lines.speed[i + 1])
        if samples.t[earliest - 1] <= x <= samples.t[latest]:
            return _add(found, n, x, _at(lines, i, x))
    k = earliest
    while k < latest and abs(_at(lines, i, samples.t[k]) - samples.angle[k]) <= half:
        k += 1
    begin, end, level = samples.t[k - 1], samples.t[k], samples.angle[k] + rest
    if abs(samples.angle[k - 1] - samples.angle[k]) < SAME:
        came, left = _when(lines, i, level), _when(lines, i + 1, level)
        if begin <= came and came <= left and left <= end:
            return _add(found, _add(found, n, came, level), left, level)
    n = _add(found, n, begin, _at(lines, i, begin))
    return _add(found, n, end, _at(lines, i + 1, end))


@compiled
def _add(found, n, t, angle):
    """Append a knot to the n knots in `found`, rows of times [s] and angles [rad].

    It is written to column n, which must exist; n + 1, the number of knots now, is returned.
    """
    found[0, n], found[1, n] = t, angle
    return n + 1


@compiled
def _at(lines, i, t):
    """Return the angle of line i at a time [rad]."""
    return lines.angle[i] + lines.speed[i] * (t - lines.x[i])


@compiled
def _when(lines, i, angle):
    """Return the time at which line i passes an angle, not finite if it has no speed [s]."""
    return lines.x[i] + (angle - lines.angle[i]) / lines.speed[i]
