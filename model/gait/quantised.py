# SPDX-License-Identifier: MIT
"""Smooth leg angles out of an encoder's counts, and how far they may be off.

An encoder of few counts says little about an angle between two counts, but when the count changes
the angle is the boundary between them, known to the time between samples. Legs turn at constant
speeds for most of a cycle, so the angles here are the fewest straight lines that pass every
boundary when the log says so. A line through twenty boundaries is known far better than one count:
to about a tenth of a degree where the count is 3.6 degrees and the log 100 Hz.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.compiled import compiled
from model.errors import DomainError
from model.gait.reference import SampledReference
from model.slip.law import Array

SAME = 1e-9  # rad: angles no further apart are one count
LARGEST_STEP = np.radians(10.0)
FEWEST_CHANGES = 8
SLACK = 0.03  # of a count: corners are round, clocks jitter, and a line still goes on
FASTEST = 60.0  # rad/s, beyond any leg
HALVINGS = 60


class Line(NamedTuple):
    """A leg at constant speed: a time [s], the angle there [rad], the speed [rad/s]."""

    x: float
    angle: float
    speed: float

    def at(self, t: float) -> float:
        """Return the angle at a time [rad]."""
        return self.angle + self.speed * (t - self.x)

    def when(self, angle: float) -> float:
        """Return the time of an angle [s]."""
        return self.x + (angle - self.angle) / self.speed


class Stay(NamedTuple):
    """A time over which the count stayed the same, and the angle a leg rests at if it does."""

    early: float
    late: float
    angle: float


class Changes(NamedTuple):
    """Changes of one leg's count: the sample before and the one after each.

    Attributes:
        early: Times of the samples before, shape (n,) [s].
        late: Times of the samples after, shape (n,) [s].
        before: Angles before: middles of their bins, shape (n,) [rad].
        after: Angles after, shape (n,) [rad].
    """

    early: Array
    late: Array
    before: Array
    after: Array

    @property
    def angle(self) -> Array:
        """Angle at which the count changed; the middle of those that were skipped [rad]."""
        return 0.5 * (self.before + self.after)


@dataclass(frozen=True)
class QuantisedLog:
    """Leg angles as an encoder counts them, each the middle of its bin.

    Attributes:
        t: Times, strictly increasing, shape (n,) [s].
        theta: Unwrapped angles, whole multiples of `step` apart, shape (n, 6) [rad].
        step: Angle of one count [rad].

    Raises:
        DomainError: The step is not positive.
    """

    t: Array
    theta: Array
    step: float

    def __post_init__(self) -> None:
        """Refuse a step that is none."""
        if not (self.step > 0 and np.isfinite(self.step)):
            raise DomainError(f"a count of {self.step:g} rad; expected more than zero")

    @cached_property
    def _legs(self) -> list[tuple[Changes, NDArray[np.intp]]]:
        """Changes of every leg with the first change of each line, and their number at the end."""
        legs = []
        for theta in self.theta.T:
            at = np.flatnonzero(np.abs(np.diff(theta)) > SAME)
            changes = Changes(self.t[at], self.t[at + 1], theta[at], theta[at + 1])
            legs.append((changes, _split(changes, self.step)))
        return legs

    def smooth(self, rng: np.random.Generator | None = None) -> SampledReference:
        """Reconstruct the angles, at the log's times.

        Args:
            rng: Draws one of the motions that the counts allow. None takes the middle one.

        Returns:
            The angles. Whether bins are rounded or cut is not known here: that half count is a
            constant offset of the leg.
        """
        columns = [
            _along_lines(self.t, theta, changes, first, self.step, rng)
            for theta, (changes, first) in zip(self.theta.T, self._legs, strict=True)
        ]
        return SampledReference(self.t, np.column_stack(columns))


def find_step(theta: Array) -> float | None:
    """Find the angle of a count when angles look counted: all differences are multiples of it.

    Args:
        theta: Unwrapped angles, shape (n, legs) [rad].

    Returns:
        The step, or None for angles that were not counted, or counted finely [rad].

    >>> counted = np.radians(3.6) * np.arange(20.0).round()[:, None]
    >>> float(np.degrees(find_step(counted)).round(3))
    3.6
    """
    change = np.abs(np.diff(theta, axis=0)).ravel()
    change = change[change > 1e-4]
    if len(change) < FEWEST_CHANGES:
        return None
    ones = change[change < 1.5 * np.quantile(change, 0.02)]
    step = float(ones.mean())
    counts = change / step
    whole = np.abs(counts - counts.round()) < 0.02 * np.maximum(counts, 1.0)
    # Almost no difference of a leg that turns freely would be a multiple of another.
    return step if whole.mean() > 0.98 and 1e-3 < step < LARGEST_STEP else None


def _split(changes: Changes, step: float) -> NDArray[np.intp]:
    """Return the first change of each of the fewest lines, and the number of changes."""
    half = (0.5 + SLACK) * step
    n = len(changes.early)
    first, at = [0], 0
    while at < n:
        at = int(reach(*changes, at, half))
        first.append(at)
    return np.array(first, dtype=np.intp)


@compiled
def reach(early, late, before, after, start, half):
    """Return the first change that no line from the change `start` on still passes.

    A line passes a change when it lies in the count before at the sample before, and in the count
    after at the sample after.
    """
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
            # The slope of the gap is ceiling_t - floor_t: go down it.
            if ceiling_t > floor_t:
                b = m
            else:
                a = m
        if not fits:
            return end - 1
    return n


def _along_lines(
    t: Array,
    theta: Array,
    changes: Changes,
    first: NDArray[np.intp],
    step: float,
    rng: np.random.Generator | None,
) -> Array:
    """Fit each line to its changes and let each pass into the next where they meet."""
    if len(changes.early) == 0:
        return theta + (0.0 if rng is None else rng.uniform(-0.5 * step, 0.5 * step))
    at = changes.early + 0.5 * (changes.late - changes.early)
    middle = [_line(at, changes.angle, int(a), int(b)) for a, b in pairwise(first)]
    lines = middle if rng is None else _drawn(middle, changes, first, step, rng)
    rest = 0.0 if rng is None else float(rng.uniform(-0.4 * step, 0.4 * step))
    knots = _start(float(t[0]), float(theta[0]), lines[0], step, rest)
    for i, begin in enumerate(first[1:-1]):
        stay = Stay(float(at[begin - 1]), float(at[begin]), float(changes.after[begin - 1]))
        rested = _rested(middle[i], middle[i + 1], stay)  # the same in every draw
        stay = stay._replace(angle=stay.angle + rest)
        knots += _junction(lines[i], lines[i + 1], stay, rested=rested)
    # The end is the start of time run backwards.
    x, y, m = lines[-1]
    ending = _start(-float(t[-1]), float(theta[-1]), Line(-x, y, -m), step, rest)
    knots += [(-when, angle) for when, angle in reversed(ending)]
    times, angles = np.array(knots).T
    return np.interp(t, np.maximum.accumulate(times), angles)


def _drawn(
    middle: Sequence[Line],
    changes: Changes,
    first: NDArray[np.intp],
    step: float,
    rng: np.random.Generator,
) -> list[Line]:
    """Draw lines that still pass every change, from the middle ones outwards.

    Twenty changes confine a line to a small polygon of offset and speed, far smaller than what
    independent errors of as many would leave. So a direction is taken from changes that fall
    anywhere between their samples, and along it a point that makes a polygon evenly filled.

    A gait whose cycle is a whole number of samples meets every count at the same phase again and
    again: its errors repeat and do not average out. So a draw takes one place for each count, and
    one distance for the leg.
    """
    turn = max(round(2 * np.pi / step), 1)
    places = rng.uniform(0.0, 1.0, 2 * turn)
    place = places[np.round(2 * changes.angle / step).astype(int) % (2 * turn)]
    at, outwards = changes.early + place * (changes.late - changes.early), np.sqrt(rng.uniform())
    lines = []
    for line, (a, b) in zip(middle, pairwise(first.tolist()), strict=True):
        other = _line(at, changes.angle, a, b)
        passed = Changes(*(each[a : _last(a, b)] for each in changes))
        share = outwards * _room(line, other, passed, step)
        angle = line.angle + share * (other.at(line.x) - line.angle)
        lines.append(Line(line.x, angle, line.speed + share * (other.speed - line.speed)))
    return lines


def _room(line: Line, other: Line, changes: Changes, step: float) -> float:
    """Return how far towards another line one may go and still pass all changes, at most 1.

    All the way, where not even the line itself passes them: then the leg went no straight line, and
    nothing is known but each change on its own.
    """
    half, room = (0.5 + SLACK) * step, 1.0
    for t, middle in ((changes.early, changes.before), (changes.late, changes.after)):
        here = line.angle + line.speed * (t - line.x) - middle
        there = other.angle + other.speed * (t - other.x) - middle
        if np.any(np.abs(here) > half):
            return 1.0
        away = there - here
        left = np.where(away > 0, half - here, half + here)
        moving = np.abs(away) > 0
        room = min(room, float(np.min(left[moving] / np.abs(away[moving]), initial=1.0)))
    return room


def _line(at: Array, angle: Array, begin: int, end: int) -> Line:
    """Fit a line to changes; the last ones may belong to the next line and are left out."""
    end = _last(begin, end)
    x, y = at[begin:end], angle[begin:end]
    middle, height = float(x.mean()), float(y.mean())
    d = x - middle
    spread = float(d @ d)
    return Line(middle, height, float(d @ (y - height) / spread) if spread > 0 else 0.0)


def _last(begin: int, end: int) -> int:
    """Return where a line's own changes end."""
    return end - max(1, (end - begin) // 12) if end - begin >= 6 else end


def _junction(one: Line, other: Line, stay: Stay, *, rested: bool) -> list[tuple[float, float]]:
    """Return the knots at which one line passes into the next.

    A plateau, if the leg rested between them; where they meet, if that is about where the count
    stayed the same; else the ends of both.
    """
    early, late, angle = stay
    near = 1.5 * (late - early)
    if rested:
        return [(one.when(angle), angle), (other.when(angle), angle)]
    if one.speed != other.speed:
        x = one.x + (other.at(one.x) - one.angle) / (one.speed - other.speed)
        if early - near < x < late + near:
            return [(x, one.at(x))]
    return [(early, one.at(early)), (late, other.at(late))]


def _rested(one: Line, other: Line, stay: Stay) -> bool:
    """Tell whether a leg reached its resting angle well before it left it again."""
    if one.speed == 0 or other.speed == 0:
        return False
    reached, left = one.when(stay.angle), other.when(stay.angle)
    return bool(
        stay.early <= reached < left <= stay.late
        and left - reached > 0.5 * (stay.late - stay.early)
    )


def _start(
    t: float, theta: float, line: Line, step: float, rest: float
) -> list[tuple[float, float]]:
    """Return the log's first knots: on the first line, or at rest until that line is reached."""
    if abs(line.at(t) - theta) <= (0.5 + SLACK) * step or line.speed == 0:
        return [(t, line.at(t))]
    return [(t, theta + rest), (line.when(theta + rest), theta + rest)]
