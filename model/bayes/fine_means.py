# SPDX-License-Identifier: MIT
"""Means of a few samples each, with the moments within them: data too many to be held as samples.

Blocks are made of such means as of samples; what the averaging has taken from their variances is
added again, so that blocks are those of the samples wherever they begin with a mean.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.checks.raw import Levels, clipped_at, outliers, top_levels
from model.bayes.faulty_samples import Clipped, Outliers
from model.bayes.samples import FineMoments, SlipSamples

_OF_MEANS = ("count", "slip_variance", "load_variance", "load_third", "slip_load_covariance")
LEVELS = 3  # the largest of a force, with how often each occurs, that tell a limit


@dataclass(frozen=True)
class RunPiece:
    """What is kept of the consecutive samples of one run that were read together.

    Attributes:
        samples: Number of samples.
        lags: Number, sum and sum of squares of the differences of slip at lags of one and two
            samples, shape (2, 3).
        outliers: Number of samples whose traction leaps from both neighbours.
        leap: Their median leap [N].
    """

    samples: int
    lags: Array
    outliers: int
    leap: float


@dataclass(frozen=True)
class Reduced:
    """Means of the samples of some runs, or of parts of runs; n means of m pieces of runs.

    Attributes:
        run: Run of each mean, non-decreasing, shape (n,).
        means: Mean slip, normal force, traction and time of each, shape (4, n); NaN for no time.
        count: Number of samples of each, shape (n,).
        moments: Variance of slip, variance and third central moment of load, covariance of slip
            and load within each, shape (4, n).
        pieces: What is kept of each run, by run, in the order of reading.
        levels: Largest and smallest values of traction and of normal force with their counts, in
            the order of `level_sides`.
    """

    run: NDArray[np.intp]
    means: Array
    count: NDArray[np.intp]
    moments: Array
    pieces: tuple[tuple[int, RunPiece], ...]
    levels: tuple[Levels, ...]


def reduce_samples(samples: SlipSamples, length: int) -> Reduced:
    """Average samples in means of `length`, none of them of two runs.

    Args:
        samples: The samples, those of a part of a run perhaps.
        length: Samples in a mean; the last of a run may have fewer.
    """
    parts = samples.slices()
    starts = np.concatenate([np.arange(part.start, part.stop, length) for part in parts])
    count = np.diff(np.append(starts, len(samples)))

    def mean(values: Array) -> Array:
        return np.add.reduceat(values, starts) / count

    slip, load = mean(samples.slip), mean(samples.normal_force)
    time = np.full(len(starts), np.nan) if samples.time is None else mean(samples.time)
    of_slip = samples.slip - np.repeat(slip, count)
    of_load = samples.normal_force - np.repeat(load, count)
    square = of_load**2
    return Reduced(
        samples.run[starts],
        np.stack([slip, load, mean(samples.traction_force), time]),
        count,
        np.stack([mean(of_slip**2), mean(square), mean(square * of_load), mean(of_slip * of_load)]),
        tuple(
            (index, _piece(samples, part))
            for index, part in enumerate(parts)
            if part.stop > part.start
        ),
        tuple(
            top_levels(sign * force, LEVELS)
            for force in (samples.traction_force, samples.normal_force)
            for sign in (1.0, -1.0)
        ),
    )


def _piece(samples: SlipSamples, part: slice) -> RunPiece:
    """Keep what is needed of the samples of one run."""
    slip, force = samples.slip[part], samples.traction_force[part]
    lags = [
        (len(d), float(d.sum()), float(d @ d)) for d in (slip[lag:] - slip[:-lag] for lag in (1, 2))
    ]
    own = SlipSamples(
        slip, samples.normal_force[part], force, np.zeros(len(slip), np.intp), ("",),
        samples.definition,
    )  # fmt: skip
    found = outliers(own, force, np.zeros(len(force)))  # true slip hardly leaps: traction does
    return RunPiece(len(slip), np.array(lags), found.count, found.size)


def fine_moments(every: Sequence[Reduced], n_runs: int) -> FineMoments:
    """Join what was reduced, in the order of the runs.

    Args:
        every: The parts, whose runs are numbered throughout, from 0.
        n_runs: Number of runs.
    """
    lags, length = np.zeros((n_runs, 2, 3)), np.zeros(n_runs, dtype=np.intp)
    leaping, leaps = np.zeros(n_runs, dtype=np.intp), []
    for run, piece in (each for part in every for each in part.pieces):
        lags[run] += piece.lags
        length[run] += piece.samples
        leaping[run] += piece.outliers
        leaps += [piece.leap] * (piece.outliers > 0)
    total = int(leaping.sum())
    found = Outliers(
        total,
        total / max(int(length.sum()), 1),
        float(np.median(leaps)) if leaps else 0.0,
        int(leaping.argmax()) if total else 0,
    )
    of_slip, of_load, third, product = np.concatenate([part.moments for part in every], axis=1)
    return FineMoments(
        count=np.concatenate([part.count for part in every]),
        slip_variance=of_slip,
        load_variance=of_load,
        load_third=third,
        slip_load_covariance=product,
        noise=_nuggets(lags),
        length=length,
        outliers=found,
        clipped=_clipped(every),
    )


def joined_moments(parts: Sequence[FineMoments]) -> FineMoments:
    """Join the moments of several tables, in the order of their runs.

    Args:
        parts: The moments of each, at least one.
    """
    first = np.cumsum([0, *(len(part.length) for part in parts)])
    worst = int(np.argmax([part.outliers.count for part in parts]))
    count = sum(part.outliers.count for part in parts)
    length = np.concatenate([part.length for part in parts])
    return FineMoments(
        **{
            name: np.concatenate([getattr(part, name) for part in parts])
            for name in (*_OF_MEANS, "noise")
        },
        length=length,
        outliers=Outliers(
            count,
            count / max(int(length.sum()), 1),
            parts[worst].outliers.size,
            int(first[worst]) + parts[worst].outliers.run,
        ),
        clipped=(
            next((part.clipped[0] for part in parts if part.clipped[0]), None),
            next((part.clipped[1] for part in parts if part.clipped[1]), None),
        ),
    )


def moments_of_runs(
    fine: FineMoments, rows: NDArray[np.bool_], runs: NDArray[np.bool_]
) -> FineMoments:
    """Return the moments of some runs; faulty samples are still those of all.

    Args:
        fine: The moments of all runs.
        rows: Whether each mean is of these runs, shape (n,).
        runs: Whether each run is one of them, shape (n_runs,).
    """
    of_means = {name: getattr(fine, name)[rows] for name in _OF_MEANS}
    return replace(fine, **of_means, noise=fine.noise[runs], length=fine.length[runs])


def _nuggets(lags: Array) -> Array:
    """Estimate the white noise of each run's slip from its differences, shape (n_runs,) [-]."""
    n, total, squares = np.moveaxis(lags, 2, 0)
    variance = squares / np.maximum(n, 1) - (total / np.maximum(n, 1)) ** 2
    return np.maximum(0.0, variance[:, 0] - 0.5 * variance[:, 1])


def _clipped(every: Sequence[Reduced]) -> tuple[Clipped | None, Clipped | None]:
    """Return where traction and normal force stop at a limit."""
    found: list[Clipped | None] = []
    for force in range(2):
        sides = []
        for side, sign in enumerate((1.0, -1.0)):
            merged: dict[float, int] = {}
            for part in every:
                for level, count in part.levels[2 * force + side]:
                    merged[level] = merged.get(level, 0) + count
            top = tuple(sorted(merged.items(), reverse=True)[:LEVELS])
            sides.append(clipped_at(top, sign))
        found.append(next((each for each in sides if each is not None), None))
    return found[0], found[1]
