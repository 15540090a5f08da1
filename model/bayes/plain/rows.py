# SPDX-License-Identifier: MIT
"""Rows that a plain fit takes of samples: means of runs of constant slip, or of neighbours."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.slip.definition import SlipDefinition
from model.slip.samples import SlipSamples

MOST_ROWS: Final = 3000
"""Largest number of rows; of more, neighbours are averaged where the curve is straight."""
STRAIGHT: Final = 0.2
"""Spread of slip over the slip scale, up to which the mean of the curve is the curve of means."""
FEWEST_TESTS: Final = 8
"""Least number of runs whose means are fitted instead of rows."""
STEADY_LOAD: Final = 0.05
"""Spread of load over its mean, up to which a run has one load."""
CROSSED: Final = (0.3, 1.0)
"""Least and largest slip of a run over the slip scale, which crosses the rise."""


@dataclass(frozen=True)
class PlainRows:
    """Rows that are fitted.

    Attributes:
        slip: Slip ratio, shape (n,) [-].
        load: Normal force, shape (n,) [N].
        force: Traction force, shape (n,) [N].
        test: Index of each row's independent test, non-decreasing from 0, shape (n,).
        definition: Definition of the slip ratios.
        offset_a_run: Whether each test has an offset of force of its own.
        spread: Standard deviation of slip within each row, over which the curve is averaged,
            shape (n,) [-]; None where it is not.
    """

    slip: Array
    load: Array
    force: Array
    test: NDArray[np.intp]
    definition: SlipDefinition
    offset_a_run: bool = False
    spread: Array | None = None

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.slip)

    def some(self, most: int) -> "PlainRows":
        """Return up to `most` of the rows, evenly spaced, each a test of its own."""
        every = slice(None, None, -(-len(self) // most))
        slip, load, force = self.slip[every], self.load[every], self.force[every]
        return replace(self, slip=slip, load=load, force=force, test=np.arange(len(slip)))

    def of_tests(self, chosen: NDArray[np.intp]) -> "PlainRows":
        """Return the rows of some tests, which may be repeated, each as a test of its own.

        Args:
            chosen: Indices of the tests, shape (m,).
        """
        edges = np.searchsorted(self.test, np.arange(self.test[-1] + 2))
        parts = [np.arange(edges[i], edges[i + 1]) for i in chosen]
        rows, sizes = np.concatenate(parts), [len(part) for part in parts]
        return replace(
            self, slip=self.slip[rows], load=self.load[rows], force=self.force[rows],
            test=np.repeat(np.arange(len(parts)), sizes),
        )  # fmt: skip


def rows_of(samples: SlipSamples, scale: float) -> PlainRows:
    """Average samples to the rows that are fitted, by the slip scale of the curve [-].

    Where slip spreads by less than `STRAIGHT` of the scale within the median run, beyond the noise
    of the speeds, rows are the means of the runs, if there are `FEWEST_TESTS`. Else neighbours are
    averaged, as long as slip spreads by as little within the mean of most and rows are too many; of
    more than `MOST_ROWS` the rest is left out.
    """
    parts = samples.slices()
    lengths = np.array([part.stop - part.start for part in parts])
    noise = slip_noise_variance(samples)
    spread = np.array([np.var(samples.slip[part]) for part in parts]) - noise
    steady = np.sqrt(max(float(np.median(spread)), 0.0)) < STRAIGHT * scale
    if steady and np.isfinite(scale) and samples.n_runs >= FEWEST_TESTS:
        starts = np.array([part.start for part in parts])
    else:
        together = max(1, len(samples) // MOST_ROWS)
        while together > 1 and not _straight(samples, together, STRAIGHT * scale):
            together //= 2
        counts = np.maximum(1, lengths // together)
        starts = np.concatenate(
            [
                part.start + np.linspace(0, length, count, endpoint=False).astype(int)
                for part, length, count in zip(parts, lengths, counts, strict=True)
            ]
        )
    ends = np.append(starts[1:], len(samples))
    ends = np.minimum(ends, np.array([part.stop for part in parts])[samples.run[starts]])
    every = -(-len(starts) // MOST_ROWS)  # of what is still too many, some are left out
    starts, ends = starts[::every], ends[::every]

    def mean(values: Array) -> Array:
        """Average one value a sample over each row."""
        sums = np.append(0.0, np.cumsum(values))
        return (sums[ends] - sums[starts]) / (ends - starts)

    load = mean(samples.normal_force)
    of_run = np.array([samples.normal_force[part].mean() for part in parts])
    varies = np.array([np.std(samples.normal_force[part]) for part in parts])
    one = (varies < STEADY_LOAD * of_run)[samples.run[starts]]
    run = samples.run[starts]
    return PlainRows(
        mean(samples.slip), np.where(one, of_run[run], load), mean(samples.traction_force),
        run if samples.n_runs > 1 else np.arange(len(starts)), samples.definition,
    )  # fmt: skip


def _straight(samples: SlipSamples, together: int, most: float) -> bool:
    """Return whether slip spreads by less than `most` in most groups of neighbours [-]."""
    n = len(samples) // together * together
    spread = np.std(samples.slip[:n].reshape(-1, together), axis=1)
    return bool(np.median(spread) < most)


def cross_the_rise(rows: PlainRows, scale: float) -> bool:
    """Return whether most runs have slips within and beyond the rise, as of `CROSSED`."""
    if rows.test[-1] == 0 or len(rows) == rows.test[-1] + 1:
        return False
    edges = np.searchsorted(rows.test, np.arange(rows.test[-1] + 1))
    size = np.abs(rows.slip) / scale
    low, high = np.minimum.reduceat(size, edges), np.maximum.reduceat(size, edges)
    return bool(np.mean((low < CROSSED[0]) & (high > CROSSED[1])) > 0.5)
