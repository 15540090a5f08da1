# SPDX-License-Identifier: MIT
"""Piecewise linear fit of one leg's encoder counts, compiled; see `model.gait.quantised`."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.compiled import compiled
from model.slip.law import Array

FASTEST = 60.0  # largest speed of a line, beyond any leg's [rad/s]
HALVINGS = 60  # bisections of a line's speed before it is rejected
OWN = 6  # changes of a line; of lines with so many the last may belong to the next line


class Changes(NamedTuple):
    """Changes of one leg's count: the samples just before and just after each change.

    Attributes:
        early: Time of the sample before each change, shape (n,) [s].
        late: Time of the sample after each change, shape (n,) [s].
        before: Angle counted before each change, the middle of its bin, shape (n,) [rad].
        after: Angle counted after each change, the middle of its bin, shape (n,) [rad].
    """

    early: Array
    late: Array
    before: Array
    after: Array


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


class Log(NamedTuple):
    """First and last sample of a log, and the tolerance of the counts.

    Attributes:
        begin: Time of the first sample [s].
        first: Angle counted in the first sample [rad].
        end: Time of the last sample [s].
        last: Angle counted in the last sample [rad].
        half: Half a count plus the tolerance of a line [rad].
    """

    begin: float
    first: float
    end: float
    last: float
    half: float


@compiled
def split(changes: Changes, half: float) -> NDArray[np.intp]:
    """Split the changes of count into the fewest successive groups that a straight line passes.

    A line passes a change if it lies, at the sample before, within `half` of the angle counted
    before, and at the sample after, of that after. Its speed is at most `FASTEST` either way.

    Args:
        changes: The changes, at least one.
        half: Half a count plus the tolerance of a line [rad].

    Returns:
        Index of each line's first change, then the number of changes, shape (k + 1,).
    """
    n = len(changes.early)
    first = np.empty(n + 1, dtype=np.intp)
    count, at = 1, 0
    first[0] = 0
    while at < n:
        at = _reach(changes, at, half)
        first[count] = at
        count += 1
    return first[:count].copy()


@compiled
def _reach(changes, start, half):
    """Return the index of the first change that no line through all changes from `start` on passes.

    The number of changes if there is none. A line passes a change when the line lies, at the sample
    before, within `half` of the angle before, and at the sample after, of the angle after; speeds
    are tried up to `FASTEST`.
    """
    early, late, before, after = changes
    n = len(early)
    low, high = -FASTEST, FASTEST
    m = 0.0
    for end in range(start + 2, n + 1):
        # max(lower bounds) - min(upper bounds) of the intercept is convex in the slope.
        fits = False
        a, b = low, high
        for attempt in range(HALVINGS):
            m = m if attempt == 0 else 0.5 * (a + b)
            floor, ceiling = -np.inf, np.inf
            floor_t, ceiling_t = 0.0, 0.0
            for k in range(start, end):
                for side in range(2):
                    t = early[k] if side == 0 else late[k]
                    t -= early[start]
                    value = before[k] if side == 0 else after[k]
                    if value - half - m * t > floor:
                        floor, floor_t = value - half - m * t, t
                    if value + half - m * t < ceiling:
                        ceiling, ceiling_t = value + half - m * t, t
            if floor <= ceiling:
                fits = True
                break
            # The slope of the gap is ceiling_t - floor_t: move downhill.
            if ceiling_t > floor_t:
                b = m
            else:
                a = m
        if not fits:
            return end - 1
    return n


@compiled
def fitted(changes: Changes, first: NDArray[np.intp], place: Array) -> Lines:
    """Fit a line by least squares to the times and angles of each group of changes.

    The angle of a change is halfway between its counts. Speed is zero for a single change; the last
    changes of groups of `OWN` or more are left out (`_own_end`).

    Args:
        changes: The changes.
        first: Index of each line's first change, from `split`, shape (k + 1,).
        place: Time of each change between its two samples, 0 to 1, shape (n,) [-].
    """
    n = len(first) - 1
    lines = Lines(np.empty(n), np.empty(n), np.empty(n))
    at = changes.early + place * (changes.late - changes.early)
    angle = 0.5 * (changes.before + changes.after)
    for i in range(n):
        begin, end = first[i], _own_end(first[i], first[i + 1])
        x, y = at[begin:end].mean(), angle[begin:end].mean()
        spread = slope = 0.0
        for k in range(begin, end):
            spread += (at[k] - x) ** 2
            slope += (at[k] - x) * (angle[k] - y)
        lines.x[i], lines.angle[i] = x, y
        lines.speed[i] = slope / spread if spread > 0 else 0.0
    return lines


@compiled
def drawn(
    lines: Lines,
    changes: Changes,
    first: NDArray[np.intp],
    place: Array,
    outwards: float,
    half: float,
) -> Lines:
    """Move lines towards lines fitted to other times of the changes, while they pass every change.

    A line moves at most onto the other one, and that far if it misses a change before the move.
    Changes that `_own_end` leaves out may be missed.

    Args:
        lines: Lines from `fitted` with each change halfway between its samples.
        changes: The changes.
        first: Index of each line's first change, from `split`, shape (k + 1,).
        place: Other time of each change between its two samples, 0 to 1, shape (n,) [-].
        outwards: How far to move, as a share of the largest admissible distance [-].
        half: Half a count plus the tolerance of a line [rad].

    Returns:
        The moved lines, at the same times `x`.
    """
    other = fitted(changes, first, place)
    moved = Lines(lines.x, np.empty(len(lines.x)), np.empty(len(lines.x)))
    for i in range(len(lines.x)):
        at_angle = _at(other, i, lines.x[i])
        share = outwards * _room(lines, other, i, changes, first, half)
        moved.angle[i] = lines.angle[i] + share * (at_angle - lines.angle[i])
        moved.speed[i] = lines.speed[i] + share * (other.speed[i] - lines.speed[i])
    return moved


@compiled
def _room(lines, other, i, changes, first, half):
    """Return how far line i can move towards `other` and pass all its changes, share from 0 to 1.

    The share is 1 where line i itself does not pass them: then the leg did not move along a
    straight line, and each change is known only on its own. Changes that `_own_end` leaves out of
    the fit may be missed.
    """
    room = 1.0
    for k in range(first[i], _own_end(first[i], first[i + 1])):
        for side in range(2):
            t = changes.early[k] if side == 0 else changes.late[k]
            middle = changes.before[k] if side == 0 else changes.after[k]
            here, there = _at(lines, i, t) - middle, _at(other, i, t) - middle
            if abs(here) > half:
                return 1.0
            if there > here:
                room = min(room, (half - here) / (there - here))
            elif there < here:
                room = min(room, (half + here) / (here - there))
    return room


@compiled
def rests(lines: Lines, changes: Changes, first: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Detect whether a leg rested between each line and the next.

    The count stayed the same from the first line's last change to the next line's first. A leg
    rested if in that time the first line reaches the middle of this count before the next line
    leaves it, by more than half of that time; not if a line has no speed.

    Args:
        lines: The lines, k of them.
        changes: The changes of count.
        first: Index of each line's first change, and the number of changes, shape (k + 1,).

    Returns:
        Whether the leg rested, shape (k - 1,).
    """
    rested = np.zeros(len(lines.x) - 1, dtype=np.bool_)
    for i in range(len(rested)):
        if lines.speed[i] == 0 or lines.speed[i + 1] == 0:
            continue
        early, late, angle = _stay(changes, first[i + 1])
        reached, left = _when(lines, i, angle), _when(lines, i + 1, angle)
        inside = early <= reached and reached < left and left <= late
        rested[i] = inside and left - reached > 0.5 * (late - early)
    return rested


@compiled
def knots(
    lines: Lines,
    changes: Changes,
    first: NDArray[np.intp],
    rested: NDArray[np.bool_],
    rest: float,
    log: Log,
) -> Array:
    """Compute the knots of the piecewise linear angle, where each line passes into the next.

    The first and the last knot are at the log's ends. A time before that of the knot before it is
    raised to it.

    Args:
        lines: The lines.
        changes: The changes of count.
        first: Index of each line's first change, from `split`, shape (k + 1,).
        rested: Whether the leg rested after each line but the last, from `rests`, shape (k - 1,).
        rest: Angle at which a leg rests, from the middle of its count [rad].
        log: First and last sample.

    Returns:
        Rows of times, not decreasing, [s] and of angles [rad], shape (2, m).
    """
    found = np.empty((2, 2 * len(lines.x) + 2))
    n = _end(lines, 0, log.begin, log.first, rest, log.half, found, 0)
    for i in range(len(rested)):
        early, late, angle = _stay(changes, first[i + 1])
        n = _junction(lines, i, early, late, angle + rest, rested[i], found, n)
    last = _end(lines, len(lines.x) - 1, log.end, log.last, rest, log.half, found, n)
    if last == n + 2:  # met from behind: the end before where the leg came to rest
        for row in range(2):
            found[row, n], found[row, n + 1] = found[row, n + 1], found[row, n]
    for i in range(1, last):
        found[0, i] = max(found[0, i], found[0, i - 1])
    return found[:, :last]


@compiled
def _junction(lines, i, early, late, angle, rested, found, n):
    """Add the knots between line i and the next to `found`; return the number of knots so far.

    The ends of a plateau at `angle`, if the leg rested; the lines' intersection, if that is less
    than 1.5 times its length outside the time from `early` to `late`, in which the count stayed the
    same; else line i at `early` and the next line at `late`.
    """
    if rested:
        n = _add(found, n, _when(lines, i, angle), angle)
        return _add(found, n, _when(lines, i + 1, angle), angle)
    near = 1.5 * (late - early)
    if lines.speed[i] != lines.speed[i + 1]:
        apart = _at(lines, i + 1, lines.x[i]) - lines.angle[i]
        x = lines.x[i] + apart / (lines.speed[i] - lines.speed[i + 1])
        if early - near < x < late + near:
            return _add(found, n, x, _at(lines, i, x))
    n = _add(found, n, early, _at(lines, i, early))
    return _add(found, n, late, _at(lines, i + 1, late))


@compiled
def _end(lines, i, t, theta, rest, half, found, n):
    """Add the knots at a log's first or last time t to `found`; return the number of all knots.

    One knot on line i, if at t it is within `half` of the angle theta counted there, or has no
    speed. Else the leg rests there, at theta + rest: one knot at t, one where the line passes it.
    """
    if abs(_at(lines, i, t) - theta) <= half or lines.speed[i] == 0:
        return _add(found, n, t, _at(lines, i, t))
    n = _add(found, n, t, theta + rest)
    return _add(found, n, _when(lines, i, theta + rest), theta + rest)


@compiled
def _add(found, n, t, angle):
    """Write a knot to column n of `found`; return n + 1."""
    found[0, n], found[1, n] = t, angle
    return n + 1


@compiled
def _stay(changes, change):
    """Return start, end [s] and angle [rad] of the constant count before a change (an index > 0).

    Start and end are halfway between the samples around the count's two changes.
    """
    early = 0.5 * (changes.early[change - 1] + changes.late[change - 1])
    return early, 0.5 * (changes.early[change] + changes.late[change]), changes.after[change - 1]


@compiled
def _at(lines, i, t):
    """Return the angle of line i at a time [rad]."""
    return lines.angle[i] + lines.speed[i] * (t - lines.x[i])


@compiled
def _when(lines, i, angle):
    """Return the time at which line i passes an angle [s]."""
    return lines.x[i] + (angle - lines.angle[i]) / lines.speed[i]


@compiled
def _own_end(begin, end):
    """Return `end`, less a twelfth of the changes since `begin`, at least one, if `OWN` or more."""
    return end - max(1, (end - begin) // 12) if end - begin >= OWN else end
