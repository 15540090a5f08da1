# SPDX-License-Identifier: MIT
"""Posterior of leg offsets and floor after tracked walks, as weighted draws of several cases."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.leg_state import LegState
from model.robot import N_LEGS
from model.walk_fit.prior import (
    FLOOR,
    NAMES,
    WRONG,
    Case,
    WalkPrior,
    describe,
    leg_offsets,
    legs_of,
)

UNINFORMED = 0.1  # contraction up to which a parameter counts as not constrained by the walks
FEW = 30  # least effective sample size of a reliable posterior


@dataclass(frozen=True)
class Contraction:
    """Prior and posterior of one parameter; units are those of `model.walk_fit.prior.UNITS`.

    Attributes:
        name: One of `NAMES`; grip and slip stiffness are logarithms of factors.
        prior_sd: Prior standard deviation; 0 for a parameter that is not fitted.
        mean: Posterior mean.
        sd: Posterior standard deviation.
    """

    name: str
    prior_sd: float
    mean: float
    sd: float

    @property
    def contraction(self) -> float:
        """1 minus posterior over prior variance; negative if it grew, 0 if not fitted [-]."""
        return 0.0 if self.prior_sd == 0 else 1 - (self.sd / self.prior_sd) ** 2

    @property
    def informed(self) -> bool:
        """Whether the walks reduce the parameter's variance by more than the share `UNINFORMED`."""
        return self.contraction > UNINFORMED


@dataclass(frozen=True)
class CaseFound:
    """Posterior probability of a case, and the offset of its wrongly mounted leg.

    Attributes:
        case: The wrongly mounted leg; None for no leg.
        name: The case as text, as by `describe`.
        probability: Posterior probability of the case [-].
        offset: Posterior mean of the leg's own plus further offset, without the offset that all
            legs share; zero for no leg [rad].
        sd: Posterior standard deviation of that offset; zero for no leg [rad].
    """

    case: Case
    name: str
    probability: float
    offset: float
    sd: float


@dataclass(frozen=True)
class WalkPosterior:
    """The posterior of leg offsets and floor after tracked walks.

    Attributes:
        prior: The prior.
        walks: Names of all walks of the fit, one left out included, in the order of the cases' walk
            indices.
        cases: The cases: each a wrongly mounted leg, or None.
        values: Draws of the parameters in the order of `NAMES`, then the further offset of a
            wrongly mounted leg, shape (n, 16), in the units of `model.walk_fit.prior.UNITS` and
            rad.
        case: Index into `cases` of each draw, shape (n,).
        weight: Weight of each draw, with sum one, shape (n,) [-].
        best: Parameters at the mode of the likeliest case with lateral traction as longitudinal,
            in the order of `values`, shape (16,).
        best_case: The likeliest case.
        misfit: Mean squared whitened residual of each walk, one left out included, at `best`; about
            1 or less if the model holds [-].
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
        """Effective sample size of the weighted draws, 1 over the sum of squared weights [-]."""
        return float(1 / np.sum(self.weight**2))

    @property
    def reliable(self) -> bool:
        """Whether the effective sample size is at least `FEW`."""
        return self.effective >= FEW

    def draw(self, n: int, *, rng: np.random.Generator, walk: int | None = None) -> LegState:
        """Draw states of the legs for `model.predict.walk_draws`, by weight, with replacement.

        Args:
            n: Number of draws.
            rng: Source of randomness.
            walk: Index of the walk that the states are for; None for a walk to come, in which only
                a leg wrongly mounted in all walks has its further offset.
        """
        chosen = rng.choice(len(self.weight), size=n, p=self.weight)
        return state_in(self.values[chosen], self.case[chosen], self.cases, walk=walk)

    def most_likely(self, *, walk: int | None = None) -> LegState:
        """Return one state of the legs, at the mode of the likeliest case.

        Args:
            walk: Index of the walk that the state is for; None for a walk to come, in which only a
                leg wrongly mounted in all walks has its further offset.
        """
        return legs_of(self.best[None], self.best_case, walk=walk)

    def with_wrong_legs(self) -> Array:
        """Return all draws of the parameters in the order of `NAMES`, shape (n, 15).

        A leg's offset includes the further offset of a leg that is wrongly mounted in every walk.
        """
        values = self.values[:, :WRONG].copy()
        for i, case in enumerate(self.cases):
            rows = self.case == i
            values[rows, :N_LEGS] = leg_offsets(self.values[rows], case)
        return values

    def contractions(self) -> tuple[Contraction, ...]:
        """Compute prior and posterior moments of every parameter over all cases, as in `NAMES`.

        A leg's offset includes the further offset of a leg wrongly mounted in all walks.
        """
        values = self.with_wrong_legs()
        mean = self.weight @ values
        sd = np.sqrt(self.weight @ (values - mean) ** 2)
        prior = self.prior.sd(len(self.walks))
        return tuple(
            Contraction(name, float(p), float(m), float(s))
            for name, p, m, s in zip(NAMES, prior, mean, sd, strict=True)
        )

    def found(self) -> list[CaseFound]:
        """Compute posterior probability and leg offset of each case, likeliest first.

        Cases without weight are left out.
        """
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
        """Return the posterior for another robot on the same floor.

        Only the parameters `FLOOR` keep their draws, with the same weights; all other parameters
        are drawn from the prior, no leg is wrongly mounted, and `best` is zero but for `FLOOR`.

        Args:
            rng: Source of randomness of the prior's draws.
        """
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
    """Convert draws of several cases to m draws of the legs' state in a walk.

    Args:
        values: Draws of the parameters, as those of `WalkPosterior`, shape (m, 16).
        case: Index into `cases` of each draw, shape (m,).
        cases: The cases: each a wrongly mounted leg, or None.
        walk: Index of the walk; None for a walk to come.
    """
    state = legs_of(values, None, walk=walk)
    for i in np.unique(case):
        rows = case == i
        state.offset[rows] = legs_of(values[rows], cases[i], walk=walk).offset
    return state
