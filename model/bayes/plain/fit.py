# SPDX-License-Identifier: MIT
r"""Plain fit of a slip law by robust least squares, as a student would make it.

It knows nothing of the posterior and stands beside it. With the law f, one offset b of traction and
one relative error :math:`\varepsilon` of the ratio of radii, which shifts zero slip,

.. math::
    \min \sum_i \rho\Bigl(\frac{F_i - f(\kappa_i - \varepsilon\,\partial\kappa_i, N_i) - b}{s}
    \Bigr), \qquad \rho(r) = 2(\sqrt{1 + r^2} - 1),

over the means of runs where slip is constant within runs, else over rows. Where runs cross the rise
of the curve, an offset for each run takes the place of b; elsewhere offsets of runs and the curve
cannot be told apart. How sure the fit is follows from a bootstrap of the independent tests.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.plain.rows import PlainRows, cross_the_rise, rows_of
from model.bayes.plain.search import Search
from model.bayes.priors import Prior
from model.slip.definition import slip_per_radius_error
from model.slip.law import SlipLaw
from model.slip.samples import SlipSamples

RESAMPLES: Final = 60
"""Number of resampled fits."""
RESAMPLED_STEPS: Final = 15
"""Most evaluations of a resampled fit, which begins at the fit of all tests."""
FIRST: Final = 500
"""Largest number of rows that the search for a start looks at."""
GAIN_SD: Final = 0.01
"""Relative error of a curve by the load cell's gain, which no resampling shows [-]."""


@dataclass(frozen=True)
class PlainFit:
    """Result of a plain fit.

    Attributes:
        law: The slip law, of k parameters.
        values: Its parameters, shape (k,).
        zero: Relative error of the ratio of radii, by which zero slip is off [-].
        offset: Offset of traction; the mean one where each run has its own [N].
        rows: The rows that were fitted.
        problem: The problem that was solved.
        x: Its coordinates, shape (k + 2,).
        seed: Seed of the resampling.
    """

    law: SlipLaw
    values: Array
    zero: float
    offset: float
    rows: PlainRows
    problem: Search
    x: Array
    seed: int

    @cached_property
    def draws(self) -> Array:
        """Parameters of the law fitted to resampled tests, shape (b, k); empty for one test."""
        n, rng = int(self.rows.test[-1]) + 1, np.random.default_rng(self.seed)
        draws = [
            self.problem.values(
                self.problem.resampled(rng.integers(0, n, n)).climb(self.x, most=RESAMPLED_STEPS)
            )
            for _ in range(RESAMPLES if n > 1 else 0)
        ]
        return np.reshape(draws, (-1, len(self.values)))

    def residual(self, slip: Array, load: Array, force: Array) -> Array:
        """Compute measured minus predicted traction, without offset, shape (n,) [N].

        Args:
            slip: Slip ratio in the definition of the rows, shape (n,) [-].
            load: Normal force, shape (n,) [N].
            force: Measured traction, shape (n,) [N].
        """
        return force - self.law.force(self.true_slip(slip), load, self.values)

    def true_slip(self, slip: Array) -> Array:
        """Return slip ratios, shape (n,), less what the wrong ratio of radii adds to them [-]."""
        return slip - self.zero * slip_per_radius_error(slip, self.rows.definition)

    @property
    def load(self) -> float:
        """Median load of the rows, at which curves are compared [N]."""
        return float(np.median(self.rows.load))

    @property
    def of_run_means(self) -> bool:
        """Whether the rows are means of whole runs."""
        return len(self.rows) == self.rows.test[-1] + 1

    @property
    def slip_scale(self) -> float:
        """The slip at which a line of the initial slope reaches the largest force [-]."""
        return self.problem.slip_scale(self.x)

    def features(self, values: Array) -> Array:
        """Compute what is compared of a curve: logarithms of slope at zero and of a force.

        The slope is that at the median load, the force that at the largest slip of the rows.

        Args:
            values: Parameters of the law, shape (..., k).

        Returns:
            Both logarithms, shape (..., 2) [-].
        """
        columns, load = np.moveaxis(values, -1, 0), self.load
        far = float(np.abs(self.rows.slip).max())
        slope = self.law.slip_derivative(0.0, load, columns)
        return np.log(np.stack([slope, self.law.force(far, load, columns)], axis=-1))

    def describe(self) -> str:
        """Format slope and force of the curve with 90 % intervals of resampled tests as text."""
        middle, draws, texts = self.features(self.values), self.features(self.draws), []
        for i, name in enumerate(("slope at zero slip", "force at the largest slip")):
            texts.append(f"{name} {np.exp(middle[i]):.4g} N")
            if len(draws):
                low, high = np.exp(np.quantile(draws[:, i], [0.05, 0.95]))
                texts[-1] += f" ({low:.4g} … {high:.4g})"
        rows = f"{len(self.rows)} {'means of runs' if self.of_run_means else 'rows'}"
        return f"least squares of {rows}, {' and '.join(texts)} at a load of {self.load:.4g} N"

    def moved_by_averaging(self, slip: Array, blocks: SlipBlocks) -> float:
        """Compute how far averaging moves the curve's features where nothing errs.

        The curve itself, at slip ratios without noise, is averaged over blocks, and fitted to the
        means with Gaussian slip of the spread within each block, as the posterior does.

        Args:
            slip: Slip ratios without noise, one a sample, shape (n,) [-].
            blocks: Block means of the samples.

        Returns:
            The larger difference from the features of this curve over the standard deviation of
            the resampled fits, and at least `GAIN_SD` [-].
        """
        starts = np.cumsum(blocks.count) - blocks.count
        load = blocks.run_mean(blocks.normal_force)[blocks.run]
        every = np.repeat(load, blocks.count)

        def mean(values: Array) -> Array:
            """Average one value a sample over each block."""
            return np.add.reduceat(values, starts) / blocks.count

        middle = mean(slip)
        spread = np.sqrt(np.maximum(mean(slip**2) - middle**2, 0.0))
        force = mean(self.law.force(self.true_slip(slip), every, self.values))
        rows = replace(
            self.rows, slip=middle, load=load, force=force, test=blocks.run, spread=spread,
            offset_a_run=False,
        )  # fmt: skip
        problem = replace(self.problem, rows=rows)
        known = self.x.copy()
        known[-2] = 0.0
        found = problem.values(problem.climb(known, most=30, loss="linear"))
        sd = np.hypot(self.features(self.draws).std(axis=0), GAIN_SD)
        return float(np.max(np.abs(self.features(found) - self.features(self.values)) / sd))


def plain_fit(
    samples: SlipSamples,
    law: SlipLaw,
    *,
    priors: Mapping[str, Prior],
    zero_sd: float,
    rng: np.random.Generator,
) -> PlainFit:
    """Fit a slip law by robust least squares to rows, or to the means of runs of constant slip.

    Args:
        samples: The samples.
        law: The slip law.
        priors: Priors of the law's parameters by name, in whose coordinates is searched; they
            regularise weakly.
        zero_sd: Standard deviation of the relative error of the ratio of radii [-].
        rng: Source of randomness of starts and resampling.

    Raises:
        FitError: No prior draw is valid at the measured loads, or a residual overflowed.
    """
    rows = rows_of(samples, np.inf)
    problem = Search(law, [priors[p.name] for p in law.parameters], zero_sd, rows.some(FIRST))
    x = problem.best_of_starts(rng)
    scale = problem.slip_scale(x)
    rows = rows_of(samples, scale)
    rows = replace(rows, offset_a_run=cross_the_rise(rows, scale))
    problem, x = replace(problem, rows=rows).refined(x)
    zero = float(x[-1] * problem.zero_sd)
    return PlainFit(
        law, problem.values(x), zero, problem.offset(x), problem.rows, problem, x,
        int(rng.integers(1 << 32)),
    )  # fmt: skip
