# SPDX-License-Identifier: MIT
"""Reconstruction of smooth leg angles from encoder counts, with their uncertainty.

An encoder of few counts gives little information on an angle between two counts. When the count
changes, however, the angle is the boundary between them, at a time known to one sample. Legs turn
at constant speeds for most of a cycle, so the angles here are the fewest straight lines that pass
every boundary at its time. A line through twenty boundaries is known far better than one count: to
about a tenth of a degree where the count is 3.6 degrees and the log 100 Hz.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from model.errors import DomainError
from model.gait.lines import FASTEST, Changes, Lines, Log, drawn, fitted, knots, rests, split
from model.gait.reference import SampledReference
from model.slip.law import Array

SAME = 1e-9  # rad: angles no further apart are one count
LARGEST_STEP = np.radians(10.0)  # of one count
FEWEST_CHANGES = 8  # of count, to estimate the angle of one count
SLACK = 0.03  # of a count: tolerance of a line for rounded corners and clock jitter
DECIMALS = 6  # of a corner's time in seconds


@dataclass(frozen=True)
class CountedLeg:
    """Straight lines through one leg's changes of count.

    Attributes:
        changes: The changes, at least one.
        first: Index of each line's first change, then the number of changes, shape (k + 1,).
        lines: The k lines, fitted with each change halfway between its two samples.
        rested: Whether the leg rested between each line and the next, shape (k - 1,).
        log: First and last sample, and the tolerance of a line.
    """

    changes: Changes
    first: NDArray[np.intp]
    lines: Lines
    rested: NDArray[np.bool_]
    log: Log

    @classmethod
    def of(cls, t: Array, theta: Array, step: float) -> "CountedLeg | None":
        """Split the changes of count into the fewest groups that a line passes; fit a line to each.

        Args:
            t: Times of the samples, shape (n,) [s].
            theta: Counted angles, middles of their bins, shape (n,) [rad].
            step: Angle of one count [rad].

        Returns:
            The leg with its lines; None where the count never changes.
        """
        at = np.flatnonzero(np.abs(np.diff(theta)) > SAME)
        if len(at) == 0:
            return None
        half = (0.5 + SLACK) * step
        changes = Changes(t[at], t[at + 1], theta[at], theta[at + 1])
        first = split(changes, half)
        lines = fitted(changes, first, np.full(len(at), 0.5))
        log = Log(float(t[0]), float(theta[0]), float(t[-1]), float(theta[-1]), half)
        return cls(changes, first, lines, rests(lines, changes, first), log)

    def drawn(self, step: float, rng: np.random.Generator) -> Lines:
        """Draw lines that still pass every change, by random deviations from `lines`.

        A line that does not pass its changes is moved all the same (`model.gait.lines.drawn`).

        Twenty changes confine a line to a small polygon of offset and speed, far smaller than
        twenty independent errors would leave. A direction is therefore taken from changes that fall
        anywhere between their samples, and along it a point such that the polygon is filled evenly.

        A gait whose cycle is a whole number of samples meets every count at the same phase again
        and again, so its errors repeat and do not average out. A draw therefore takes one place for
        each count, and one distance for the leg.

        Args:
            step: Angle of one count [rad].
            rng: Source of randomness.
        """
        turn = max(round(2 * np.pi / step), 1)
        places = rng.uniform(0.0, 1.0, 2 * turn)
        twice = np.round((self.changes.before + self.changes.after) / step).astype(int)
        outwards = float(np.sqrt(rng.uniform()))
        return drawn(
            self.lines, self.changes, self.first, places[twice % (2 * turn)], outwards,
            self.log.half,
        )  # fmt: skip

    def corners(self, step: float, rng: np.random.Generator | None) -> tuple[Array, Array]:
        """Compute the corners between the fitted lines or a draw of them, and the log's ends.

        Args:
            step: Angle of one count [rad].
            rng: Source of randomness, to draw lines and the angle of rest, within 0.4 counts of a
                count's middle; None for the fitted lines, with rests at the middle.

        Returns:
            Times [s], which do not decrease, and angles [rad] of the m corners, shape (m,) each.
        """
        lines = self.lines if rng is None else self.drawn(step, rng)
        rest = 0.0 if rng is None else float(rng.uniform(-0.4 * step, 0.4 * step))
        t, theta = knots(lines, self.changes, self.first, self.rested, rest, self.log)
        return _without_jumps(np.minimum(t, self.log.end), theta)


@dataclass(frozen=True)
class QuantisedLog:
    """Leg angles of a log as an encoder counts them, each the middle of its bin.

    Attributes:
        t: Times, strictly increasing, shape (n,) [s].
        theta: Unwrapped angles, whole multiples of `step` apart, shape (n, 6) [rad].
        step: Angle of one count [rad].

    Raises:
        DomainError: The step is not positive and finite, the times do not increase, there are
            fewer than two, or the legs are not six.
    """

    t: Array
    theta: Array
    step: float

    def __post_init__(self) -> None:
        """Check times, shapes, and that the angle of a count is positive and finite."""
        SampledReference(self.t, self.theta)
        if not (self.step > 0 and np.isfinite(self.step)):
            raise DomainError(f"one count is {self.step:g} rad; expected more than zero, finite")

    @cached_property
    def _legs(self) -> list[CountedLeg | None]:
        """Fitted lines of each leg; None for a leg that never moves."""
        return [CountedLeg.of(self.t, theta, self.step) for theta in self.theta.T]

    def smooth(self, rng: np.random.Generator | None = None) -> SampledReference:
        """Reconstruct smooth leg angles from the counts, with every leg's corners.

        Args:
            rng: Source of randomness, to draw one of the motions that the counts allow; None for
                the fitted lines. A leg that never moves is drawn within its count.

        Returns:
            The angles at the log's ends and at the times of all legs' corners, to a microsecond,
            less a constant offset: whether counts are rounded or truncated, half a count, is not
            known here. Times differ from draw to draw.
        """
        legs = [
            self._still(theta, rng) if leg is None else leg.corners(self.step, rng)
            for theta, leg in zip(self.theta.T, self._legs, strict=True)
        ]
        # Corners of several legs within a microsecond become one, so that speeds stay accurate
        times = np.concatenate([self.t[[0, -1]], *(t for t, _ in legs)])
        times = np.unique(times.round(DECIMALS))
        return SampledReference(times, np.column_stack([np.interp(times, *leg) for leg in legs]))

    def _still(self, theta: Array, rng: np.random.Generator | None) -> tuple[Array, Array]:
        """Return times and angles at the log's ends of a leg that never moves.

        The angle is drawn within half a count of the counted one; unchanged if `rng` is None.
        """
        half = 0.5 * self.step
        shift = 0.0 if rng is None else rng.uniform(-half, half)
        return self.t[[0, -1]], theta[[0, -1]] + shift


def _without_jumps(t: Array, theta: Array) -> tuple[Array, Array]:
    """Merge corners between which a leg would turn faster than `FASTEST`, to their mean.

    Lines through few changes of count may meet the next line before they met the one before.
    """
    while (fast := np.abs(np.diff(theta)) > FASTEST * np.diff(t)).any():
        i = int(np.argmax(fast))
        t, theta = (np.r_[a[:i], a[i : i + 2].mean(), a[i + 2 :]] for a in (t, theta))
    return t, theta


def find_step(theta: Array) -> float | None:
    """Estimate the angle of one count: that of which nearly all differences are multiples.

    Args:
        theta: Unwrapped angles, shape (n, legs) [rad].

    Returns:
        The step [rad]; None with fewer than 8 changes (over 1e-4 rad from sample to sample), if 2 %
        or more of them are no multiple to within 2 %, or if the step is not between 0.001 rad and
        10 degrees.

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
