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
from numpy.typing import NDArray
from scipy.optimize import least_squares

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.bayes.priors import Prior
from model.errors import FitError
from model.slip.definition import SlipDefinition, slip_per_radius_error
from model.slip.law import SlipLaw
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
RESAMPLES: Final = 60
"""Number of resampled fits."""
RESAMPLED_STEPS: Final = 15
"""Most evaluations of a resampled fit, which begins at the fit of all tests."""
FIRST: Final = 500
"""Largest number of rows that the search for a start looks at."""
N_TRIALS: Final = 400
"""Number of prior draws that are tried as starts."""
N_CLIMBS: Final = 5
"""Number of the best of them that are optimised."""
GAIN_SD: Final = 0.01
"""Relative error of a curve by the load cell's gain, which no resampling shows [-]."""
OFFSET_SD: Final = 0.1
"""Spread of the offset that is thought possible, over the largest force."""


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
    """

    slip: Array
    load: Array
    force: Array
    test: NDArray[np.intp]
    definition: SlipDefinition
    offset_a_run: bool = False

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
    problem: "_Problem"
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
        columns, load = np.moveaxis(values, -1, 0), float(np.median(self.rows.load))
        far = float(np.abs(self.rows.slip).max())
        slope = self.law.slip_derivative(0.0, load, columns)
        return np.log(np.stack([slope, self.law.force(far, load, columns)], axis=-1))

    def moved(self, blocks: SlipBlocks, fewer: SlipBlocks) -> float:
        """Compute how far the curve's features move where rows are other means of the samples.

        Args:
            blocks: Block means of the samples.
            fewer: Other ones.

        Returns:
            The larger difference over the standard deviation of the resampled fits, and at least
            `GAIN_SD` [-].
        """
        sd = np.hypot(self.features(self.draws).std(axis=0), GAIN_SD)
        first, second = (self.features(self._refitted(each)) for each in (blocks, fewer))
        return float(np.max(np.abs(first - second) / sd))

    def _refitted(self, blocks: SlipBlocks) -> Array:
        """Fit the law to block means, from here on; return its parameters, shape (k,).

        Not robustly: how far residuals are out depends on how many samples are averaged.
        """
        rows = replace(
            self.rows, slip=blocks.slip, load=blocks.run_mean(blocks.normal_force)[blocks.run],
            force=blocks.traction_force, test=blocks.run,
        )  # fmt: skip
        problem = replace(self.problem, rows=rows)
        return problem.values(problem.climb(self.x, most=30, loss="linear"))


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
    rows = _rows(samples, np.inf)
    problem = _Problem(law, [priors[p.name] for p in law.parameters], zero_sd, rows.some(FIRST))
    x = problem.best_of_starts(rng)
    scale = problem.slip_scale(x)
    rows = _rows(samples, scale)
    rows = replace(rows, offset_a_run=_cross_the_rise(rows, scale))
    return _finished(replace(problem, rows=rows), x, rng)


def fit_blocks(
    blocks: SlipBlocks,
    law: SlipLaw,
    *,
    priors: Mapping[str, Prior],
    zero_sd: float,
    rng: np.random.Generator,
) -> PlainFit:
    """Fit a slip law by robust least squares to block means.

    Args:
        blocks: The block means.
        law: The slip law.
        priors: Priors of the law's parameters by name, in whose coordinates is searched.
        zero_sd: Standard deviation of the relative error of the ratio of radii [-].
        rng: Source of randomness of starts.

    Raises:
        FitError: No prior draw is valid at the measured loads, or a residual overflowed.
    """
    rows = PlainRows(
        blocks.slip, blocks.normal_force, blocks.traction_force, blocks.run, blocks.definition
    )
    problem = _Problem(law, [priors[p.name] for p in law.parameters], zero_sd, rows)
    return _finished(problem, problem.best_of_starts(rng), rng)


def _finished(problem: "_Problem", x: Array, rng: np.random.Generator) -> PlainFit:
    """Refine a fit from coordinates x, shape (k + 2,)."""
    problem, x = problem.refined(x)
    zero = float(x[-1] * problem.zero_sd)
    return PlainFit(
        problem.law, problem.values(x), zero, problem.offset(x), problem.rows, problem, x,
        int(rng.integers(1 << 32)),
    )  # fmt: skip


def _rows(samples: SlipSamples, scale: float) -> PlainRows:
    """Average samples to the rows that are fitted, by the slip scale of the curve [-].

    Where slip spreads by less than `STRAIGHT` of the scale within the median run, beyond the noise
    of the speeds, rows are the means of the runs, if there are `FEWEST_TESTS`. Else neighbours are
    averaged, as long as slip spreads by as little within the mean of most and rows are too many.
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
        starts = starts[:: -(-len(starts) // MOST_ROWS)]
    ends = np.append(starts[1:], len(samples))
    ends = np.minimum(ends, np.array([part.stop for part in parts])[samples.run[starts]])

    def mean(values: Array) -> Array:
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


def _cross_the_rise(rows: PlainRows, scale: float) -> bool:
    """Return whether most runs have slips within and beyond the rise, as of `CROSSED`."""
    if rows.test[-1] == 0 or len(rows) == rows.test[-1] + 1:
        return False
    edges = np.searchsorted(rows.test, np.arange(rows.test[-1] + 1))
    size = np.abs(rows.slip) / scale
    low, high = np.minimum.reduceat(size, edges), np.maximum.reduceat(size, edges)
    return bool(np.mean((low < CROSSED[0]) & (high > CROSSED[1])) > 0.5)


@dataclass(frozen=True)
class _Problem:
    """A least-squares problem in coordinates x: the law's by its priors, offset, zero of slip.

    Attributes:
        law: The slip law.
        priors: Prior of each of its parameters.
        zero_sd: Standard deviation of the relative error of the ratio of radii [-].
        rows: The rows.
        noise: Scale of the residuals [N]; None for a twentieth of the spread of the force.
    """

    law: SlipLaw
    priors: list[Prior]
    zero_sd: float
    rows: PlainRows
    noise: float | None = None

    def values(self, x: Array) -> Array:
        """Return the law's parameters at coordinates x (k + 2,), shape (k,)."""
        return np.array([prior.value(z) for prior, z in zip(self.priors, x, strict=False)])

    def residual(self, x: Array) -> Array:
        """Compute measured minus predicted traction of each row at x, shape (n,) [N]."""
        rows = self.rows
        shift = x[-1] * self.zero_sd * slip_per_radius_error(rows.slip, rows.definition)
        with np.errstate(all="ignore"):  # a trial may be beyond all numbers
            force = self.law.force(rows.slip - shift, rows.load, self.values(x))
        left = rows.force - np.nan_to_num(force)
        if rows.offset_a_run:
            return left - self._means(left)[rows.test]
        return left - x[-2] * self._offset_sd

    def offset(self, x: Array) -> float:
        """Return the offset of traction at x, the mean one where each run has its own [N]."""
        if not self.rows.offset_a_run:
            return float(x[-2] * self._offset_sd)
        free = replace(self, rows=replace(self.rows, offset_a_run=False))
        return float(np.mean(free.residual(np.append(x[:-2], [0.0, x[-1]]))))

    def valid(self, x: Array) -> bool:
        """Return whether the law is valid at x at quantiles of the loads."""
        loads = np.quantile(self.rows.load, [0.0, 0.25, 0.5, 0.75, 1.0])
        with np.errstate(all="ignore"):
            return bool(np.all(self.law.valid(loads, self.values(x))))

    def misfit(self, x: Array) -> Array:
        """Return the scaled residuals and the coordinates, shape (n + k + 2,)."""
        scale = self.noise or max(float(np.std(self.rows.force)) / 20, 1e-300)
        return np.append(self.residual(x) / scale, x)

    def climb(self, x: Array, most: int = 100, loss: str = "soft_l1") -> Array:
        """Optimise from x, by at most some evaluations; an end that is not valid is x again."""
        found = np.asarray(least_squares(self.misfit, x, loss=loss, max_nfev=most).x)
        return found if self.valid(found) else x

    def best_of_starts(self, rng: np.random.Generator) -> Array:
        """Optimise from the best of prior draws; return the result with the least misfit.

        Raises `FitError` where no draw is valid, or where residuals overflow.
        """
        trials = np.zeros((N_TRIALS, len(self.priors) + 2))  # the first at the prior's median
        trials[1:, :-2] = rng.standard_normal((N_TRIALS - 1, len(self.priors)))

        def height(x: Array) -> float:
            return float(np.abs(self.misfit(x)).sum())

        ranked = sorted(filter(self.valid, trials), key=height)
        if not ranked:
            low, high = self.rows.load.min(), self.rows.load.max()
            raise FitError(
                f"no parameters within the priors of the law '{self.law.name}' are valid at loads "
                f"of {low:g} to {high:g} N; check the unit of the load"
            )
        try:
            return min(map(self.climb, ranked[:N_CLIMBS]), key=height)
        except ValueError as error:  # raised by scipy where a residual overflows
            raise FitError(
                f"no curve of '{self.law.name}' comes near a traction force of up to "
                f"{np.abs(self.rows.force).max():.3g} N at loads of {self.rows.load.min():.3g} to "
                f"{self.rows.load.max():.3g} N ({error}); check their units"
            ) from error

    def refined(self, x: Array) -> "tuple[_Problem, Array]":
        """Optimise from x with the scale of the residuals that are found there, twice."""
        problem = self
        for _ in range(2):
            away = np.abs(problem.residual(x))
            noise = max(1.4826 * float(np.median(away)), 1e-3 * float(np.max(away)), 1e-300)
            problem = replace(self, noise=noise)
            x = problem.climb(x)
        return problem, x

    def resampled(self, chosen: NDArray[np.intp]) -> "_Problem":
        """Return the problem of some tests, shape (m,), which may be repeated."""
        return replace(self, rows=self.rows.of_tests(chosen))

    def slip_scale(self, x: Array) -> float:
        """Compute the slip at which a line of the initial slope reaches the largest force [-]."""
        load, slip = float(np.median(self.rows.load)), np.geomspace(1e-4, 1.0, 200)
        largest = np.max(self.law.force(slip, load, self.values(x)))
        return float(largest / self.law.slip_derivative(0.0, load, self.values(x)))

    @property
    def _offset_sd(self) -> float:
        return OFFSET_SD * float(np.abs(self.rows.force).max())

    def _means(self, values: Array) -> Array:
        """Average values (n,) over each test, shape (tests,)."""
        return np.bincount(self.rows.test, values) / np.bincount(self.rows.test)
