# SPDX-License-Identifier: MIT
"""Coverage: how often intervals hold a truth that is known, over simulated experiments."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from scipy.special import bdtr

from model.bayes.blocks import SlipBlocks
from model.errors import FitError
from model.study.design import StudyDesign
from model.study.ranks import ALARM, MOST_UNWEIGHED, Replicate
from model.study.simulated_blocks import simulate_blocks
from model.study.weighted_fit import RESAMPLED, fit_blocks

LEVELS: Final = (0.5, 0.9)
"""Probabilities of the intervals."""
FEWEST_FITS: Final = 20
"""Fits below which nine of ten intervals may hold by luck."""
RIG: Final = ("gain_traction", "gain_normal", "bias_normal", "crosstalk", "radius_error",
              "rolling_resistance")  # fmt: skip
"""Errors of load cell and rig, drawn from their priors for each replicate."""
SLIP_ERRORS: Final = ("slip_error_scale", "slip_scatter")
"""Errors of slip, drawn as well where blocks are simulated; of samples they have no true value."""


@dataclass(frozen=True)
class CoverageStudy:
    """What all replicates of a study share.

    Attributes:
        design: Layout, law and priors.
        truth: True value of each parameter but those of `RIG` and `SLIP_ERRORS`, by name.
    """

    design: StudyDesign
    truth: Mapping[str, float]


@dataclass(frozen=True)
class CoverageReplicate:
    """Intervals of one replicate, by the parameter's name.

    Attributes:
        index: Number of the replicate.
        truth: True values.
        held: Whether the interval of each of `LEVELS` holds the truth.
        score: Posterior mean less the truth over the posterior standard deviation [-].
        half: Half width of the interval of the last of `LEVELS`, in the parameter's unit.
        pareto_k: Tail index of the importance weights; NaN if the fit failed [-].
        effective: Effective number of draws; 0 if the fit failed.
        reliable: Whether the weights can be trusted.
        failure: Why the fit failed; empty if it did not.
    """

    index: int
    truth: Mapping[str, float]
    held: Mapping[str, tuple[bool, ...]] = field(default_factory=dict)
    score: Mapping[str, float] = field(default_factory=dict)
    half: Mapping[str, float] = field(default_factory=dict)
    pareto_k: float = float("nan")
    effective: float = 0.0
    reliable: bool = False
    failure: str = ""


def coverage_replicate(study: CoverageStudy, task: Replicate) -> CoverageReplicate:
    """Simulate blocks of the true law on a rig drawn from the priors, fit them, and compare.

    Args:
        study: Design and true values.
        task: Seed and number of the replicate, which determine the result.
    """
    rng = np.random.default_rng([task.seed, task.index])
    design = study.design
    truth = {**study.truth, **draw_rig(design, rng, (*RIG, *SLIP_ERRORS))}
    values = np.array([truth[p.name] for p in design.posterior(design.blocks).parameters])
    blocks = simulate_blocks(design.blocks, design.law, values, rng=rng)
    return compare_fit(design, blocks, truth, task.index, rng)


def draw_rig(
    design: StudyDesign, rng: np.random.Generator, names: tuple[str, ...] = RIG
) -> dict[str, float]:
    """Draw errors of load cell and rig from their priors, by name.

    Args:
        design: Design with the priors.
        rng: Source of randomness.
        names: The errors.
    """
    return {name: float(design.priors[name].value(rng.standard_normal())) for name in names}


def compare_fit(
    design: StudyDesign,
    blocks: SlipBlocks,
    truth: Mapping[str, float],
    index: int,
    rng: np.random.Generator,
) -> CoverageReplicate:
    """Fit simulated blocks, and compare the intervals with the truth where it is known.

    Args:
        design: Law and priors of the fit.
        blocks: The blocks, with their traction.
        truth: True values by name; parameters without one are not compared.
        index: Number of the replicate.
        rng: Source of randomness.
    """
    try:
        fit = fit_blocks(design, blocks, rng)
    except (FitError, np.linalg.LinAlgError, ArithmeticError) as error:
        return CoverageReplicate(index, truth, failure=str(error))
    held: dict[str, tuple[bool, ...]] = {}
    score: dict[str, float] = {}
    half: dict[str, float] = {}
    for name, draws in zip(design.free, fit.values(RESAMPLED, rng).T, strict=True):
        if name not in truth:
            continue
        ends = [np.quantile(draws, [0.5 - level / 2, 0.5 + level / 2]) for level in LEVELS]
        held[name] = tuple(bool(low < truth[name] < high) for low, high in ends)
        score[name] = float((draws.mean() - truth[name]) / draws.std())
        half[name] = float(ends[-1][1] - ends[-1][0]) / 2
    return CoverageReplicate(
        index, truth, held, score, half, fit.draws.pareto_k, fit.effective, fit.reliable
    )


@dataclass(frozen=True)
class Covered:
    """Coverage of one parameter's intervals.

    Attributes:
        name: The parameter.
        held: How many intervals of each of `LEVELS` hold the truth.
        n: Number of intervals.
        band: Exact binomial 99 % interval of each count, ends included.
        joint: Interval of each count that all counts of a correct fit keep with 99 %.
        bias: Mean of posterior mean less truth over posterior standard deviation [-].
        half: Mean half width of the interval of the last of `LEVELS`, in the parameter's unit.
        truth: True value; None where it is drawn for each replicate.
    """

    name: str
    held: tuple[int, ...]
    n: int
    band: tuple[tuple[int, int], ...]
    joint: tuple[tuple[int, int], ...]
    bias: float
    half: float
    truth: float | None

    @property
    def passed(self) -> bool:
        """Whether no count lies below its joint interval.

        A count above is no failure: where data say little of a parameter whose truth stays the
        same, the prior's middle holds it every time.
        """
        return all(count >= low for count, (low, _) in zip(self.held, self.joint, strict=True))

    @property
    def words(self) -> str:
        """What the counts say, in words."""
        if not self.passed:
            return "intervals too narrow, or off"
        if self.n < FEWEST_FITS:
            return "too few to say"
        if any(count > high for count, (_, high) in zip(self.held, self.joint, strict=True)):
            return "more often than stated"
        inside = all(
            low <= count <= high for count, (low, high) in zip(self.held, self.band, strict=True)
        )
        return "as stated" if inside else "as stated, within the chance of all counts together"


def binomial_band(n: int, share: float, outside: float) -> tuple[int, int]:
    """Return the central interval of a binomial count, each tail at most half of `outside`.

    Args:
        n: Number of trials.
        share: Probability of each [-].
        outside: Probability of a count outside, at most [-].

    >>> binomial_band(100, 0.9, 0.01)
    (82, 97)
    """
    below = bdtr(np.arange(n + 1), n, share)  # probability of at most each count
    low = int(np.searchsorted(below, outside / 2, side="right"))
    high = int(np.searchsorted(below, 1 - outside / 2))
    return low, high


@dataclass(frozen=True)
class CoverageResult:
    """Finished study of coverage.

    Attributes:
        replicates: All replicates, in order.
        covered: Coverage of each parameter whose truth is known.
    """

    replicates: tuple[CoverageReplicate, ...]
    covered: tuple[Covered, ...]

    @property
    def counted(self) -> int:
        """Number of fits whose intervals count."""
        return sum(each.reliable for each in self.replicates)

    @property
    def left_out(self) -> int:
        """Number of fits that failed, or whose weights cannot be trusted."""
        return len(self.replicates) - self.counted

    @property
    def testable(self) -> bool:
        """Whether there are enough intervals, of nearly all replicates, to say that they hold."""
        few = self.left_out > MOST_UNWEIGHED * len(self.replicates)
        return self.counted >= FEWEST_FITS and not few

    @property
    def failed(self) -> tuple[Covered, ...]:
        """Parameters whose intervals do not hold the truth as often as they state."""
        return tuple(each for each in self.covered if not each.passed)

    @property
    def headline(self) -> str:
        """The verdict in a line. A failure counts however few replicates show it."""
        if self.failed:
            said = ", ".join(f"{each.name} ({each.words})" for each in self.failed)
            return f"failed: {said}"
        if self.counted < FEWEST_FITS:
            return f"not testable with {self.counted} fits; at least {FEWEST_FITS} are needed"
        if not self.testable:
            return (
                f"not testable: {self.left_out} of {len(self.replicates)} fits could not be "
                "weighed; the intervals of the others hold the truth as often as they state"
            )
        return f"passed: intervals of all {len(self.covered)} parameters hold as often as stated"


def conclude_coverage(replicates: Sequence[CoverageReplicate]) -> CoverageResult:
    """Count the intervals that hold the truth.

    Args:
        replicates: All replicates, in order.
    """
    kept = [each for each in replicates if each.reliable]
    names = list(kept[0].held) if kept else []
    tests = len(LEVELS) * max(len(names), 1)
    return CoverageResult(tuple(replicates), tuple(_covered(name, kept, tests) for name in names))


def _covered(name: str, kept: Sequence[CoverageReplicate], tests: int) -> Covered:
    """Count one parameter's intervals; `tests` counts share the chance of a false alarm."""
    n = len(kept)
    held = np.sum([each.held[name] for each in kept], axis=0)
    truths = {each.truth[name] for each in kept}
    return Covered(
        name,
        tuple(map(int, held)),
        n,
        tuple(binomial_band(n, level, ALARM) for level in LEVELS),
        tuple(binomial_band(n, level, ALARM / tests) for level in LEVELS),
        float(np.mean([each.score[name] for each in kept])),
        float(np.mean([each.half[name] for each in kept])),
        truths.pop() if len(truths) == 1 else None,
    )
