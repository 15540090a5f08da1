# SPDX-License-Identifier: MIT
"""Posterior of leg offsets and floor after tracked walks, as weighted draws of several cases."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.bayes.walks.prior import (
    FLOOR,
    NAMES,
    WRONG,
    Case,
    WalkPrior,
    describe,
    leg_offsets,
    legs_of,
)
from model.leg_state import LegState
from model.robot import N_LEGS
from model.slip.law import Array

UNINFORMED = 0.1  # contraction of variance below which the walks do not inform a parameter
FEW = 30  # effective draws; below, the posterior is not reliable


@dataclass(frozen=True)
class Contraction:
    """Prior against posterior of one parameter.

    Attributes:
        name: One of `NAMES`; factors as logarithms.
        prior_sd: Prior standard deviation.
        mean: Posterior mean.
        sd: Posterior standard deviation.
    """

    name: str
    prior_sd: float
    mean: float
    sd: float

    @property
    def contraction(self) -> float:
        """One minus posterior over prior variance; zero where the walks hold no information [-]."""
        return 1 - (self.sd / self.prior_sd) ** 2

    @property
    def informed(self) -> bool:
        """Whether the walks inform this parameter."""
        return self.contraction > UNINFORMED


@dataclass(frozen=True)
class CaseFound:
    """Posterior probability of a case.

    Attributes:
        case: Which leg is wrong; None for no leg.
        name: The case as text.
        probability: Its posterior probability [-].
        offset: The leg's whole offset, without the common one; zero for no leg [rad].
        sd: Its standard deviation [rad].
    """

    case: Case
    name: str
    probability: float
    offset: float
    sd: float


@dataclass(frozen=True)
class WalkPosterior:
    """The posterior after tracked walks.

    Attributes:
        prior: The prior.
        walks: Names of the walks, in the order that cases count them.
        cases: The cases, each a leg that may be wrong or none.
        values: Draws of the parameters in the order of `NAMES` and of the wrong leg's offset, shape
            (n, 14) [rad, -].
        case: Index of each draw's case, shape (n,).
        weight: Weight of each draw, with sum one, shape (n,) [-].
        best: The mode of the likeliest case, shape (14,).
        best_case: That case.
        misfit: Mean squared whitened residual of each walk there, at most about 1 [-].
    """

    prior: WalkPrior
    walks: tuple[str, ...]
    cases: tuple[Case, ...]
    values: Array
    case: NDArray[np.intp]
    weight: Array
    best: Array
    best_case: Case
    misfit: tuple[float, ...]

    @property
    def effective(self) -> float:
        """Effective sample size of the weighted draws."""
        return float(1 / np.sum(self.weight**2))

    @property
    def reliable(self) -> bool:
        """Whether the effective sample size suffices."""
        return self.effective >= FEW

    def draw(self, n: int, *, rng: np.random.Generator, walk: int | None = None) -> LegState:
        """Draw states of the legs for `model.predict.walk_draws`.

        Args:
            n: Number of draws.
            rng: Source of randomness.
            walk: Index of the walk they are for; None for a walk to come.
        """
        chosen = rng.choice(len(self.weight), size=n, p=self.weight)
        return state_in(self.values[chosen], self.case[chosen], self.cases, walk=walk)

    def most_likely(self, *, walk: int | None = None) -> LegState:
        """Return the state of the legs at the mode of the likeliest case."""
        return legs_of(self.best[None], self.best_case, walk=walk)

    def with_wrong_legs(self) -> Array:
        """Return draws in the order of `NAMES`, shape (n, 13).

        A leg's offset includes the further offset of a leg that is wrong in every walk.
        """
        values = self.values[:, :WRONG].copy()
        for i, case in enumerate(self.cases):
            rows = self.case == i
            values[rows, :N_LEGS] = leg_offsets(self.values[rows], case)
        return values

    def contractions(self) -> tuple[Contraction, ...]:
        """Compare prior and posterior of every parameter, over all cases."""
        values = self.with_wrong_legs()
        mean = self.weight @ values
        sd = np.sqrt(self.weight @ (values - mean) ** 2)
        prior = self.prior.sd(len(self.walks))
        return tuple(
            Contraction(name, float(p), float(m), float(s))
            for name, p, m, s in zip(NAMES, prior, mean, sd, strict=True)
        )

    def found(self) -> list[CaseFound]:
        """List the cases with non-zero weight, likeliest first."""
        rows = []
        for i, case in enumerate(self.cases):
            weight = np.where(self.case == i, self.weight, 0.0)
            total = float(weight.sum())
            if total == 0:
                continue
            mean = sd = 0.0
            if case is not None:
                offset = self.values[:, case.leg] + self.values[:, WRONG]
                mean = float(weight @ offset / total)
                sd = float(np.sqrt(weight @ (offset - mean) ** 2 / total))
            rows.append(CaseFound(case, describe(case, self.walks), total, mean, sd))
        return sorted(rows, key=lambda row: -row.probability)

    def of_floor_alone(self, *, rng: np.random.Generator) -> "WalkPosterior":
        """Return draws for another robot on the same floor, with leg parameters from the prior."""
        keep = [NAMES.index(name) for name in FLOOR]
        values = rng.standard_normal(self.values.shape) * self.prior.scale
        best = np.zeros_like(self.best)
        values[:, keep], best[keep] = self.values[:, keep], self.best[keep]
        nothing = np.zeros_like(self.case)
        return WalkPosterior(
            self.prior, self.walks, (None,), values, nothing, self.weight, best, None, self.misfit
        )


def state_in(
    values: Array, case: NDArray[np.intp], cases: tuple[Case, ...], *, walk: int | None
) -> LegState:
    """Convert draws of several cases to the state of the legs in a walk.

    Args:
        values: Draws, shape (m, 14).
        case: Index of each one's case, shape (m,).
        cases: The cases.
        walk: The walk's index; None for a walk to come.
    """
    state = legs_of(values, None, walk=walk)
    for i in np.unique(case):
        rows = case == i
        state.offset[rows] = legs_of(values[rows], cases[i], walk=walk).offset
    return state
