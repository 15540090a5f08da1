# SPDX-License-Identifier: MIT
"""Reconstruction of smooth leg angles from encoder counts or noisy angles, with uncertainty.

An encoder of few counts gives little information on an angle between two counts. When the count
changes, however, the angle is the boundary between them, at a time known to one sample. Legs turn
at constant speeds for most of a cycle, so the angles here are the fewest straight lines that pass
every sample within half a count. A line that passes twenty changes of count is known far better
than one count: to some hundredths of a degree where the count is 3.6 degrees and the log 100 Hz.

Of each line all that pass its samples are equally likely, and their mean is the reconstruction.
Samples near a corner may be of either line. How many lines pass, and so the uncertainty, depends on
how speed, count and sampling meet: where a count takes a whole number of samples, as 8 at 45
degrees a second, all changes are at the same phase, and say no more than one.

Angles with noise are rebuilt likewise: by the fewest straight lines that pass every sample within
its noise. Of each line, the reconstruction is then the one of least squares. A leg that is further
from its lines than its noise turns unevenly, and is smoothed instead.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.errors import DomainError
from model.gait.lines import (
    FASTEST,
    SAME,
    SPEEDS,
    Lines,
    Passing,
    Samples,
    chosen,
    closest,
    knots,
    middle,
    passing,
    split,
)
from model.gait.reference import SampledReference
from model.gait.smoothed import SmoothedLeg

SLACK = 0.03  # of a count: tolerance of a line for rounded corners and clock jitter
# What a leg may be off a straight line in a draw, the larger of a share of a count and of what a
# servo yields to its load [rad].
ROUGH, YIELD = 0.01, np.radians(0.02)
REACH = 4.5  # standard deviations of noise, within which a line passes every sample
UNEVEN = 1.8  # times the noise off the lines: more is motion; servos under load leave up to 1.6
NEAR = 2  # samples on either side of a corner that may belong to either line
TICK = 1e-4  # s, to which times of samples are compared
DECIMALS = 6  # of a corner's time in seconds


@dataclass(frozen=True)
class LegLines:
    """Straight lines through one leg's counted or noisy angles.

    Attributes:
        samples: First and last sample of each stay at one count.
        earliest: Least index of each line's first sample, where the fewest lines that pass all
            samples are as early as they can be, then the number of samples, shape (k + 1,).
        latest: Largest such index, where lines are as late as they can be, shape (k + 1,).
        lines: For each line, all that pass its own samples, within what a leg may be off a straight
            line; of noisy angles those as far about that of least squares as its error allows.
        mean: Mean of those that pass within half a count; of noisy angles, of `lines`.
        alike: Number that lines share whose samples repeat: the same counts after the same times,
            from 0, shape (k,).
        step: Angle of one count, or twice what a sample's noise may be [rad].
    """

    samples: Samples
    earliest: NDArray[np.intp]
    latest: NDArray[np.intp]
    lines: Passing
    mean: Lines
    alike: NDArray[np.intp]
    step: float

    @classmethod
    def of(cls, t: Array, theta: Array, step: float, noise: float = 0.0) -> "LegLines":
        """Split a leg's samples into the fewest groups that a line passes; find each one's lines.

        Args:
            t: Times of the samples, shape (n,) [s].
            theta: Angles; if counted, the middles of their bins, shape (n,) [rad].
            step: Angle of one count; not used if there is noise [rad].
            noise: Standard deviation of the angles' noise, if it hides the counts; zero for counts
                without noise [rad].
        """
        step = 2 * REACH * noise if noise else step
        changes = np.abs(np.diff(theta)) > SAME
        ends = np.append(True, changes) | np.append(changes, True)
        samples = Samples(t[ends], theta[ends])
        half = (0.5 + SLACK) * step
        earliest, latest = _first_samples(samples, half)
        own = _own_samples(samples, earliest, latest, half)
        if noise:
            lines, alike = _likely_lines(samples, *own, noise), np.arange(len(own[0]))
            return cls(samples, earliest, latest, lines, middle(lines), alike, step)
        lines = _lines(samples, *own, step, max(ROUGH * step, YIELD))
        mean = middle(_lines(samples, *own, step, 0.0))
        return cls(samples, earliest, latest, lines, mean, _alike(samples, *own, step), step)

    def drawn(self, rng: np.random.Generator) -> Lines:
        """Draw one of the lines that pass, for each line, all equally likely.

        A gait whose cycle is a whole number of samples meets every count at the same phase again
        and again, so its errors repeat and do not average out. Lines whose samples repeat are
        therefore drawn alike.

        Args:
            rng: Source of randomness.
        """
        return chosen(self.lines, rng.uniform(size=(self.alike.max() + 1, 2))[self.alike])

    def corners(self, rng: np.random.Generator | None) -> tuple[Array, Array]:
        """Compute the corners between the mean lines or a draw of them, and the log's ends.

        Args:
            rng: Source of randomness, to draw lines and the angle of rests, within 0.4 counts of a
                count's middle; None for the mean lines, with rests at the middle.

        Returns:
            Times [s], which do not decrease, and angles [rad] of the m corners, shape (m,) each.
        """
        lines = self.mean if rng is None else self.drawn(rng)
        rest = 0.0 if rng is None else float(rng.uniform(-0.4, 0.4)) * self.step
        half = (0.5 + SLACK) * self.step
        t, theta = knots(self.samples, self.earliest, self.latest, lines, rest, half)
        return _through(self.samples, *_without_jumps(t, theta), half)


@dataclass(frozen=True)
class InexactLog:
    """Measured leg angles of a log: counted by an encoder, each the middle of its bin, or noisy.

    Attributes:
        t: Times, strictly increasing, shape (n,) [s].
        theta: Unwrapped angles; of an encoder whole multiples of `step` apart, shape (n, 6) [rad].
        step: Angle of one count; zero if the angles have noise alone [rad].
        noise: Standard deviation of each leg's noise, in which counts are lost, shape (6,) [rad];
            None for counts alone.

    Raises:
        DomainError: The step is not positive and finite, and there is no noise; the noise is not;
            the times do not increase, there are fewer than two, or the legs are not six.
    """

    t: Array
    theta: Array
    step: float
    noise: Array | None = None

    def __post_init__(self) -> None:
        """Check times, shapes, and that the angle of a count is positive and finite."""
        SampledReference(self.t, self.theta)
        if self.noise is not None:
            if self.noise.shape != (6,) or not np.all((self.noise > 0) & np.isfinite(self.noise)):
                raise DomainError(f"noise is {self.noise} rad; expected six of more than zero")
        elif not (self.step > 0 and np.isfinite(self.step)):
            raise DomainError(f"one count is {self.step:g} rad; expected more than zero, finite")

    @cached_property
    def _noise(self) -> Array:
        """Standard deviation of each leg's noise, zero for counts alone, shape (6,) [rad]."""
        return np.zeros(6) if self.noise is None else self.noise

    @cached_property
    def _lines(self) -> list[LegLines]:
        """Lines of each leg."""
        return [
            LegLines.of(self.t, theta, self.step, float(sd))
            for theta, sd in zip(self.theta.T, self._noise, strict=True)
        ]

    @cached_property
    def _legs(self) -> list[LegLines | SmoothedLeg]:
        """Lines of each leg, or smooth angles of one off its lines by over `UNEVEN` noises."""
        found: list[LegLines | SmoothedLeg] = []
        for leg, theta, sd in zip(self._lines, self.theta.T, self._noise, strict=True):
            off = theta - np.interp(self.t, *leg.corners(None))
            uneven = sd > 0 and np.sqrt(np.mean(off**2)) > UNEVEN * sd
            found.append(SmoothedLeg(self.t, theta) if uneven else leg)
        return found

    @property
    def lines(self) -> int:
        """Number of straight lines that make up all legs."""
        return sum(len(leg.mean.x) for leg in self._lines)

    @property
    def uneven(self) -> int:
        """Number of noisy legs that straight lines do not fit, and that are smoothed instead."""
        return sum(isinstance(leg, SmoothedLeg) for leg in self._legs)

    def smooth(self, rng: np.random.Generator | None = None) -> SampledReference:
        """Reconstruct smooth leg angles from the counts, with every leg's corners.

        Args:
            rng: Source of randomness, to draw one of the motions that the counts allow; None for
                the mean lines. A leg that never moves is drawn within its count.

        Returns:
            The angles at the log's ends and at the times of all legs' corners, to a microsecond,
            less a constant offset: whether counts are rounded or truncated, half a count, is not
            known here. Times differ from draw to draw.
        """
        legs = [leg.corners(rng) for leg in self._legs]
        # Corners of several legs within a microsecond become one, so that speeds stay accurate
        times = np.concatenate([self.t[[0, -1]], *(t for t, _ in legs)])
        times = np.unique(times.round(DECIMALS))
        return SampledReference(times, np.column_stack([np.interp(times, *leg) for leg in legs]))


def _first_samples(samples: Samples, half: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the least and the largest index of each line's first sample, shape (k + 1,) each.

    The last entry of each is the number of samples. `half` is the largest distance of a sample from
    its line [rad].

    Splitting from the last sample backwards gives as few lines, each as early as it can begin. By
    rounding it may give one more, where a line barely passes: then both are the latest.
    """
    latest = split(samples, half)
    backwards = Samples(-samples.t[::-1].copy(), samples.angle[::-1].copy())
    earliest = len(samples.t) - split(backwards, half)[::-1]
    if len(earliest) != len(latest):
        return latest, latest
    return np.minimum(earliest, latest), latest


def _lines(
    samples: Samples, begin: NDArray[np.intp], end: NDArray[np.intp], step: float, off: float
) -> Passing:
    """Return all lines that pass each group of samples, from indices `begin` to below `end`.

    A line passes if no sample is further off than half a count `step`, or than the closest line is
    if that is more, plus `off` [rad].
    """
    away = [closest(samples, *group)[1] for group in zip(begin, end, strict=True)]
    return passing(samples, begin, end, np.maximum(0.5 * step, away) + off)


def _likely_lines(
    samples: Samples, begin: NDArray[np.intp], end: NDArray[np.intp], noise: float
) -> Passing:
    """Return lines about that of least squares through each group of samples, evenly distributed.

    Angle and speed have the standard deviations that the noise [rad] leaves, hence the sqrt(3) of
    a uniform distribution; `YIELD` is added, by which a leg may be off a straight line.
    """
    k = len(begin)
    x, angle, speed = np.empty(k), np.empty((k, 2)), np.empty((k, 2))
    for i, one in enumerate(map(slice, begin, end)):
        t, theta = samples.t[one], samples.angle[one]
        x[i], spread = t.mean(), float(np.linalg.norm(t - t.mean()))
        slope = (t - x[i]) @ theta / spread**2 if spread > 0 else 0.0
        off = np.array([-1.0, 1.0]) * (np.sqrt(3.0) * noise / np.sqrt(len(t)) + YIELD)
        angle[i] = theta.mean() + off
        speed[i] = slope + (off * np.sqrt(len(t)) / spread if spread > 0 else 0.0)
    speeds = np.linspace(speed[:, 0], speed[:, 1], SPEEDS, axis=1)
    low, high = (np.repeat(each[:, None], SPEEDS, axis=1) for each in angle.T)
    return Passing(x, speeds, low, high)


def _own_samples(
    samples: Samples, earliest: NDArray[np.intp], latest: NDArray[np.intp], half: float
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return begin and end (exclusive) of each line's own samples, shape (k,) each.

    A corner lies anywhere between the earliest and the latest sample with which a line may begin:
    the middle is taken, and up to `NEAR` samples on either side are left out, since they may be of
    either line. None is left out where fewer than two would remain. If still fewer than two remain,
    or no line passes them within `half` [rad], they are those from this line's latest beginning to
    the next line's.
    """
    corner = (earliest + latest) // 2
    begin = np.minimum(corner + NEAR, latest)[:-1]
    end = np.maximum(corner - NEAR, earliest)[1:]
    for i in range(len(begin)):
        if end[i] - begin[i] < 2:
            begin[i], end[i] = corner[i], corner[i + 1]
        if end[i] - begin[i] < 2 or closest(samples, begin[i], end[i])[1] > half:
            begin[i], end[i] = latest[i], latest[i + 1]
    return begin, end


def _alike(
    samples: Samples, begin: NDArray[np.intp], end: NDArray[np.intp], step: float
) -> NDArray[np.intp]:
    """Number the groups of samples, those alike with the same number, shape (k,).

    Alike are groups of the same counts after the same times, to a tenth of a millisecond, from
    their first sample on.
    """
    numbers: dict[bytes, int] = {}
    found = []
    for one in map(slice, begin, end):
        counts = (samples.angle[one] - samples.angle[one][0]) / step
        times = (samples.t[one] - samples.t[one][0]) / TICK
        pattern = np.round([counts, times]).astype(np.int64).tobytes()
        found.append(numbers.setdefault(pattern, len(numbers)))
    return np.array(found)


def _through(samples: Samples, t: Array, theta: Array, half: float) -> tuple[Array, Array]:
    """Add corners at samples that are missed by more than `half`, so that no sample is.

    A leg that speeds up and slows down all the time has lines of few samples, which may miss
    samples beside the next line, or meet it beyond the counts before and after. The samples on
    either side become corners as well, and a corner between them from which the leg would jump is
    left out. Returns times and angles of all corners, (m,) each.
    """
    left = np.searchsorted(samples.t, t, side="right") - 1
    right = np.minimum(np.searchsorted(samples.t, t), len(samples.t) - 1)
    beside = np.stack([samples.angle[left], samples.angle[right]])
    theta = np.clip(theta, beside.min(axis=0) - half, beside.max(axis=0) + half)
    there = np.interp(samples.t, t, theta)
    held = np.clip(there, samples.angle - half, samples.angle + half)
    missed = np.abs(held - there) > SAME
    added = missed | np.append(missed[1:], False) | np.append(False, missed[:-1])
    jumps = [
        missed[k] & (np.abs(theta - held[k]) > FASTEST * np.abs(t - samples.t[k]))
        for k in (left, right)
    ]
    keep = ~np.any(jumps, axis=0) & ~np.isin(t, samples.t[added])
    t, theta = np.append(t[keep], samples.t[added]), np.append(theta[keep], held[added])
    order = np.argsort(t, kind="stable")
    return t[order], theta[order]


def _without_jumps(t: Array, theta: Array) -> tuple[Array, Array]:
    """Merge corners between which a leg would turn faster than `FASTEST`, to their mean.

    Lines through few changes of count may meet the next line before they met the one before.
    Returns times and angles of the corners that remain, (m,) each.
    """
    while (fast := np.abs(np.diff(theta)) > FASTEST * np.diff(t)).any():
        i = int(np.argmax(fast))
        t, theta = (np.r_[a[:i], a[i : i + 2].mean(), a[i + 2 :]] for a in (t, theta))
    return t, theta
