# SPDX-License-Identifier: MIT
"""Simulation-based calibration: ranks of true values among posterior draws, and what they say.

Talts et al. (2018), "Validating Bayesian inference algorithms with simulation-based calibration":
where parameters are drawn from the prior and data from the model, the rank of each true value among
independent posterior draws is uniform, whatever the data.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.errors import FitError
from model.study.design import StudyDesign
from model.study.simulated_blocks import simulate_blocks
from model.study.uniformity import DRAWS, chi_square_p, ecdf_p
from model.study.weighted_fit import fit_blocks

ALARM: Final = 0.01
"""Probability that a correct fit fails a test of all parameters together."""
FEWEST: Final = 100
"""Replicates below which a bin of the histogram has fewer than five ranks on average."""
MOST_UNWEIGHED: Final = 0.1
"""Share of the fits without reliable weights above which the rest proves too little."""
_BENT = 3.0  # standard errors of mean or spread of the ranks, to name what is wrong

WRONG: Final[Mapping[str, Mapping[str, float]]] = MappingProxyType(
    {
        "independent-noise": {"noise_correlation": 0.0, "offset_spread": 0.0},
        "perfect-rig": {"radius_error": 0.0, "rolling_resistance": 0.0},
    }
)
"""What a deliberately wrong fit takes as known, by its name: noise that does not remember and runs
without offsets; radii that are exact and discs that roll freely."""


@dataclass(frozen=True)
class Replicate:
    """One replicate of a study.

    Attributes:
        seed: Seed of the study.
        index: Number of the replicate.
    """

    seed: int
    index: int


@dataclass(frozen=True)
class RankStudy:
    """What all replicates of a study share.

    Attributes:
        design: Layout, law and priors; true values are drawn from these.
        fitted: Design of the fit, with more parameters taken as known if it is wrong on purpose.
    """

    design: StudyDesign
    fitted: StudyDesign


@dataclass(frozen=True)
class RankReplicate:
    """Ranks of one replicate.

    Attributes:
        index: Number of the replicate.
        truth: True value of every parameter by name.
        ranks: Rank of each fitted parameter's true value among `DRAWS` posterior draws, by name;
            empty if the fit failed.
        pareto_k: Tail index of the importance weights; NaN if the fit failed [-].
        effective: Effective number of draws; 0 if the fit failed.
        reliable: Whether the weights can be trusted.
        failure: Why the fit failed; empty if it did not.
    """

    index: int
    truth: Mapping[str, float]
    ranks: Mapping[str, int] = field(default_factory=dict)
    pareto_k: float = float("nan")
    effective: float = 0.0
    reliable: bool = False
    failure: str = ""


def rank_replicate(study: RankStudy, task: Replicate) -> RankReplicate:
    """Draw true values, simulate, fit, and rank the truth among the posterior's draws.

    Args:
        study: Design of truth and fit.
        task: Seed and number of the replicate, which determine the result.

    Raises:
        FitError: The priors allow no curve.
    """
    rng = np.random.default_rng([task.seed, task.index])
    values = study.design.draw(rng)
    truth = study.design.named(values)
    blocks = simulate_blocks(study.design.blocks, study.design.law, values, rng=rng)
    try:
        fit = fit_blocks(study.fitted, blocks, rng)
    except (FitError, np.linalg.LinAlgError, ArithmeticError) as error:
        return RankReplicate(task.index, truth, failure=str(error))
    names = study.fitted.free
    below = np.sum(fit.values(DRAWS, rng) < [truth[name] for name in names], axis=0)
    return RankReplicate(
        task.index,
        truth,
        dict(zip(names, map(int, below), strict=True)),
        fit.draws.pareto_k,
        fit.effective,
        fit.reliable,
    )


@dataclass(frozen=True)
class Uniformity:
    """Whether the ranks of one parameter are uniform.

    Attributes:
        name: The parameter.
        ranks: Its ranks, shape (n,).
        chi_square_p: p-value of the histogram's chi-square [-].
        ecdf_p: p-value of the empirical distribution function's largest deviation [-].
        mean: Mean rank less that of uniform ranks, in standard errors [-].
        spread: Mean squared distance of the ranks from their middle less that of uniform ranks, in
            standard errors; positive where ranks pile up at the ends [-].
        limit: p-value below which a test fails: `ALARM` over the number of parameters [-].
    """

    name: str
    ranks: NDArray[np.intp]
    chi_square_p: float
    ecdf_p: float
    mean: float
    spread: float
    limit: float

    @property
    def passed(self) -> bool:
        """Whether neither test fails; the chi-square, an approximation, counts from `FEWEST` on."""
        counted = self.chi_square_p if len(self.ranks) >= FEWEST else 1.0
        return min(counted, self.ecdf_p) > self.limit

    @property
    def words(self) -> str:
        """What the ranks say, in words."""
        if self.passed:
            return "uniform" if len(self.ranks) >= FEWEST else "too few to say"
        if abs(self.spread) >= max(abs(self.mean), _BENT):
            return "intervals too narrow" if self.spread > 0 else "intervals too wide"
        if abs(self.mean) >= _BENT:
            return "estimates too low" if self.mean > 0 else "estimates too high"
        return "not uniform"


def uniformity(name: str, ranks: NDArray[np.intp], *, parameters: int) -> Uniformity:
    """Test the ranks of one parameter.

    Args:
        name: The parameter.
        ranks: Its ranks, from 0 to `DRAWS`, shape (n,), n at least 1.
        parameters: Number of parameters that are tested in the study.
    """
    n = len(ranks)
    u = (ranks - DRAWS / 2) / (DRAWS + 1)
    grid = (np.arange(DRAWS + 1) - DRAWS / 2) / (DRAWS + 1)
    return Uniformity(
        name,
        ranks,
        chi_square_p(ranks),
        ecdf_p(ranks),
        float(u.mean() / (grid.std() / np.sqrt(n))),
        float((np.mean(u**2) - np.mean(grid**2)) / ((grid**2).std() / np.sqrt(n))),
        ALARM / parameters,
    )


@dataclass(frozen=True)
class RankResult:
    """Finished study of ranks.

    Ranks of fits without reliable weights are left out. Whether a fit is left out depends on its
    data alone and not on the truth behind them, so that the ranks of the others stay uniform where
    the fit is right; but nothing is said of such data.

    Attributes:
        replicates: All replicates, in order.
        tests: Test of each parameter.
    """

    replicates: tuple[RankReplicate, ...]
    tests: tuple[Uniformity, ...]

    @property
    def ranked(self) -> int:
        """Number of fits whose ranks count."""
        return sum(each.reliable for each in self.replicates)

    @property
    def left_out(self) -> int:
        """Number of fits that failed, or whose weights cannot be trusted."""
        return len(self.replicates) - self.ranked

    @property
    def testable(self) -> bool:
        """Whether there are enough ranks, of nearly all replicates, to say that a fit is right."""
        return self.ranked >= FEWEST and self.left_out <= MOST_UNWEIGHED * len(self.replicates)

    @property
    def failed(self) -> tuple[Uniformity, ...]:
        """Tests that fail."""
        return tuple(each for each in self.tests if not each.passed)

    @property
    def headline(self) -> str:
        """The verdict in a line. A failure counts however few replicates show it."""
        if self.failed:
            said = ", ".join(f"{each.name} ({each.words})" for each in self.failed)
            return f"failed: {said}"
        if self.ranked < FEWEST:
            return f"not testable with {self.ranked} ranked fits; at least {FEWEST} are needed"
        if not self.testable:
            return (
                f"not testable: {self.left_out} of {len(self.replicates)} fits could not be "
                "weighed; the ranks of the others are uniform; narrower priors help"
            )
        return f"passed: ranks of all {len(self.tests)} parameters are uniform"


def conclude_ranks(names: Sequence[str], replicates: Sequence[RankReplicate]) -> RankResult:
    """Test the ranks of a study's parameters.

    Args:
        names: The fitted parameters.
        replicates: All replicates, in order.
    """
    kept = [each for each in replicates if each.reliable]
    if not kept:
        return RankResult(tuple(replicates), ())
    tests = tuple(
        uniformity(name, np.array([each.ranks[name] for each in kept]), parameters=len(names))
        for name in names
    )
    return RankResult(tuple(replicates), tests)
