# SPDX-License-Identifier: MIT
"""Comparison of slip laws by their predictions of left-out runs and of left-out loads."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import load_levels, nearest_level
from model.bayes.drawing.weighted import weighted_draws
from model.bayes.fit import CLEAR_WIN, PreparedFit
from model.bayes.left_out import (
    DRAWS,
    ENOUGH,
    ByWeights,
    LeftOut,
    Refit,
    Refitted,
    by_weights,
    refit_without,
)
from model.errors import DomainError, InsufficientData
from model.slip.law import SlipLaw
from model.tasks import compute_tasks

SMALL = 4.0
"""Difference of log density below which its standard error is no guide (Sivula et al. 2020)."""
FEW_RUNS = 10
"""Runs below which the scatter between them is no measure of a difference's error."""
CLEAR_EVIDENCE = 10.0
"""Log evidence by which a law must be better where runs are few; priors are known less well."""
CURVES = 200  # draws of each law that are kept, for its curves


@dataclass(frozen=True)
class LawScore:
    """How one law predicts data that it was not fitted to.

    Attributes:
        name: Name that the law is reported under.
        law: The law, of k parameters.
        runs: Predictions of each run without it.
        loads: Predictions of each run without all runs at its load; None for one load.
        values: Posterior draws of the law's parameters, shape (`CURVES`, k).
    """

    name: str
    law: SlipLaw
    runs: LeftOut
    loads: LeftOut | None
    values: Array

    @property
    def unreliable(self) -> int:
        """Number of left-out runs and loads whose predictions are not reliable."""
        return self.runs.unreliable + (0 if self.loads is None else self.loads.unreliable)


@dataclass(frozen=True)
class Difference:
    """Log predictive density of a law minus another's.

    Attributes:
        value: The difference, summed over runs [-].
        error: Its standard error [-].
    """

    value: float
    error: float

    @property
    def clearly_worse(self) -> bool:
        """Whether it is below zero by more than two standard errors and by more than `SMALL`."""
        return self.value < -max(CLEAR_WIN * self.error, SMALL)


@dataclass(frozen=True)
class LawScores:
    """Scores of several laws on the same blocks.

    Attributes:
        laws: Score of each law, by rising number of parameters.
        levels: Loads that were left out, shape (n_levels,) [N].
        best: Index of the law that predicts left-out runs best.
        chosen: Index of the law that is fitted: the first of `told_together`.
        told_together: Indices of the laws that `choose_law` did not drop as clearly worse.
    """

    laws: tuple[LawScore, ...]
    levels: Array
    best: int
    chosen: int
    told_together: tuple[int, ...]

    def runs(self, index: int, against: int) -> Difference:
        """Compare two laws' predictions of left-out runs; the error is that over runs."""
        excess = self.laws[index].runs.log_density - self.laws[against].runs.log_density
        return Difference(float(excess.sum()), _standard_error(excess))

    def loads(self, index: int, against: int) -> Difference | None:
        """Compare two laws' predictions of left-out loads; None for one load.

        The error is the larger of that over runs and that over loads.
        """
        mine, other = self.laws[index].loads, self.laws[against].loads
        if mine is None or other is None:
            return None
        excess = mine.log_density - other.log_density
        by_load = np.bincount(mine.group, excess).astype(float)
        error = max(_standard_error(excess), _standard_error(by_load))
        return Difference(float(excess.sum()), error)


def _standard_error(differences: Array) -> float:
    """Compute the standard error of the sum of independent differences from their scatter."""
    return float(np.sqrt(len(differences)) * np.std(differences, ddof=1))


def load_groups(blocks: SlipBlocks) -> tuple[NDArray[np.intp], Array]:
    """Group runs by the one of `load_levels` that is nearest to the mean load of their blocks.

    Args:
        blocks: The block means.

    Returns:
        Group of each run from 0, (n_runs,), and the load of each group, the median of its blocks'
        loads [N].
    """
    nearest = nearest_level(np.maximum(blocks.run_mean(blocks.normal_force), 1e-9),
                            load_levels(blocks))  # fmt: skip
    used, group = np.unique(nearest, return_inverse=True)
    of_block = group[blocks.run]
    loads = [float(np.median(blocks.normal_force[of_block == i])) for i in range(len(used))]
    return np.asarray(group, dtype=np.intp), np.array(loads)


@dataclass(frozen=True)
class WeighedLaw:
    """A law whose predictions of left-out runs and loads are known but for the refits they need.

    Attributes:
        name: Name that the law is reported under.
        law: The law, of k parameters.
        runs: Predictions of each run without it.
        loads: Predictions of each run without all runs at its load; None for one load.
        values: Posterior draws of the law's parameters, shape (`CURVES`, k).
    """

    name: str
    law: SlipLaw
    runs: ByWeights
    loads: ByWeights | None
    values: Array

    @property
    def refits(self) -> tuple[Refit, ...]:
        """The refits, of left-out runs first."""
        return (*self.runs.refits, *(() if self.loads is None else self.loads.refits))

    def scored(self, found: Sequence[Refitted]) -> LawScore:
        """Return the score with the results of `refits`, in their order."""
        n = len(self.runs.refits)
        loads = None if self.loads is None else self.loads.with_refits(found[n:])
        return LawScore(self.name, self.law, self.runs.with_refits(found[:n]), loads, self.values)


def weigh_law(name: str, fit: PreparedFit, *, rng: np.random.Generator) -> WeighedLaw:
    """Predict each run, and each load, by weighted draws of a law that was fitted to all.

    Args:
        name: Name that the law is reported under.
        fit: The fit of the law to all runs.
        rng: Source of randomness of the weighted draws, of which each refit has its own.

    Raises:
        InsufficientData: There is one run.
    """
    posterior, approximation = fit.posterior, fit.approximation
    blocks, k = posterior.blocks, len(posterior.law.parameters)
    if blocks.n_runs < 2:
        raise InsufficientData(
            "laws are compared by runs that are left out, and these data are one run; expected two "
            "at least: name one law, or separate the data into runs ([runs] in columns.toml)"
        )
    draws = weighted_draws(posterior.log_density, approximation, n=DRAWS, wanted=ENOUGH, rng=rng)

    def predicted(group: NDArray[np.intp]) -> ByWeights:
        """Predict each group of runs, (n_runs,), without its data."""
        return by_weights(posterior, draws, group, approximation=approximation, rng=rng)

    group, loads = load_groups(blocks)
    return WeighedLaw(
        name=name,
        law=posterior.law,
        runs=predicted(np.arange(blocks.n_runs)),
        loads=predicted(group) if len(loads) > 1 else None,
        values=posterior.values(draws.resample(CURVES, rng=rng))[:, :k],
    )


def score_laws(
    weighed: Sequence[WeighedLaw],
    *,
    executor: Executor | None = None,
    progress: Callable[[float], object] = lambda _: None,
    explaining: Callable[[SlipLaw], AbstractContextManager[None]] = lambda _: nullcontext(),
) -> list[LawScore]:
    """Refit all laws without the runs and loads whose weights are bad, as tasks side by side.

    Args:
        weighed: The laws.
        executor: Where the refits are computed; None for here.
        progress: Called with the share of the refits done, after each.
        explaining: Context in which the refits of a law are awaited, for its errors.

    Raises:
        FitError: A fit without a run or load failed.
    """
    tasks = [refit for each in weighed for refit in each.refits]
    found: list[Refitted] = []
    results = compute_tasks(executor, refit_without, tasks)
    for task in tasks:
        with explaining(task.posterior.law):
            found.append(next(results))
        progress(len(found) / len(tasks))
    scores = []
    for each in weighed:
        n = len(each.refits)
        scores.append(each.scored(found[:n]))
        found = found[n:]
    return scores


def choose_law(scores: Sequence[LawScore], levels: Array) -> LawScores:
    """Choose the simplest law that predicts left-out runs and loads no worse than the others.

    Laws that predict left-out runs clearly worse than the best are dropped; of the others those
    that predict left-out loads clearly worse than the best of these. The first that is left, the
    one of the fewest parameters, is chosen.

    Args:
        scores: Score of each law, on the same blocks, one at least; of as many parameters the
            preferred law first.
        levels: Loads that were left out, shape (n_levels,) [N].
    """
    laws = tuple(sorted(scores, key=lambda score: len(score.law.parameters)))
    best = int(np.argmax([score.runs.log_density.sum() for score in laws]))
    found = LawScores(laws, levels, best, best, (best,))
    left = [i for i in range(len(laws)) if not found.runs(i, best).clearly_worse]
    of_loads = [laws[i].loads for i in left]
    totals = [-np.inf if loads is None else loads.log_density.sum() for loads in of_loads]
    top = left[int(np.argmax(totals))]
    kept = [
        i for i in left if (against := found.loads(i, top)) is None or not against.clearly_worse
    ]
    return LawScores(laws, levels, best, kept[0], tuple(kept))


@dataclass(frozen=True)
class LawComparison:
    """Comparison of laws by cross-validation.

    Attributes:
        names: Name of each law.
        log_density: Log predictive density of all left-out runs under each law; 0 without
            cross-validation [-].
        difference: Log predictive density of each law minus the chosen law's [-].
        standard_error: Standard error of that difference, from the scatter between runs [-].
        chosen: Index of the chosen law.
    """

    names: tuple[str, ...]
    log_density: tuple[float, ...]
    difference: tuple[float, ...]
    standard_error: tuple[float, ...]
    chosen: int


def compare(names: Sequence[str], fits: Sequence[PreparedFit]) -> LawComparison:
    """Compare laws by the log predictive density of left-out runs, and choose one.

    Starting with the first, a later law replaces the chosen one if its density is larger by more
    than `CLEAR_WIN` standard errors. Fewer than `FEW_RUNS` runs do not tell that error: each may be
    the only one at its load. There a larger density is enough where the evidence of all runs, by
    Laplace's approximation, is larger by `CLEAR_EVIDENCE` too. Without cross-validation the first
    law is chosen.

    Args:
        names: Name of each law, simplest first.
        fits: A fit for each law, all on the same blocks.

    Raises:
        DomainError: The fits have different numbers of blocks.
    """
    lengths = sorted({len(fit.posterior.blocks) for fit in fits})
    if len(lengths) > 1:
        raise DomainError(
            f"the laws were fitted to {' and '.join(map(str, lengths))} blocks; expected the same "
            "blocks; pass the first fit's block_choice to the others"
        )
    validations = [fit.cross_validation for fit in fits]
    n_runs = fits[0].posterior.blocks.n_runs
    density = np.stack([np.zeros(n_runs) if v is None else v.log_density for v in validations])
    chosen = 0
    for index in range(1, len(fits)):
        gain = density[index] - density[chosen]
        evidence = fits[index].laplace.log_evidence() - fits[chosen].laplace.log_evidence()
        told = n_runs < FEW_RUNS and gain.sum() > 0 and evidence > CLEAR_EVIDENCE
        if told or gain.sum() > CLEAR_WIN * _error_of_sum(gain):
            chosen = index
    excess = density - density[chosen]
    return LawComparison(
        names=tuple(names),
        log_density=tuple(density.sum(axis=1)),
        difference=tuple(excess.sum(axis=1)),
        standard_error=tuple(_error_of_sum(row) for row in excess),
        chosen=chosen,
    )


def choose_by_runs(
    fits: Mapping[str, PreparedFit],
) -> tuple[PreparedFit, LawComparison | None]:
    """Return the fit that `compare` chooses, and the comparison, which is None for one law.

    Args:
        fits: Fit of each law by its name, simplest first.
    """
    each = list(fits.values())
    if len(each) == 1:
        return each[0], None
    comparison = compare(list(fits), each)
    return each[comparison.chosen], comparison


def _error_of_sum(differences: np.ndarray) -> float:
    """Compute the standard error of the sum of one difference a run, from their own scatter.

    Unlike `_standard_error` by the standard deviation over n, not n - 1.
    """
    return float(np.sqrt(len(differences)) * np.std(differences))
