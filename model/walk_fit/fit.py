# SPDX-License-Identifier: MIT
"""Bayesian fit of leg offsets and floor to tracked walks.

Two walks cannot identify six offsets unless most of them are small. The prior therefore states
that every leg has a small offset, and that perhaps one leg has a large offset, wrongly mounted or
knocked before one walk. Each of these cases has its mode (`model.walk_fit.modes`), around which
draws are made and weighted (`model.bayes.drawing.importance`), with steering and stride integrated
out (`model.walk_fit.terms`). Paths alone often cannot identify the wrongly mounted leg; several
cases then have similar weights.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.drawing.importance import (
    Effort,
    WeightedDraws,
    importance_draws,
    pareto_smoothed,
)
from model.bayes.drawing.mixture import start_mixture
from model.errors import InsufficientData
from model.robot import Robot
from model.walk.traction import TractionTable
from model.walk_fit.misfit import WalkMisfit, walk_states
from model.walk_fit.modes import ModeSearch
from model.walk_fit.posterior import WalkPosterior, state_in
from model.walk_fit.prior import ACROSS, LINEAR, WALKED, WRONG, WalkPrior, all_cases
from model.walk_fit.terms import Terms
from model.walk_fit.tracked_walk import TrackedWalk

Progress = Callable[[float], None]

EFFORT = Effort(draws=200, wanted=150.0, rounds=10)  # a draw costs tens of milliseconds


def fit_walks(
    robot: Robot,
    table: TractionTable,
    walks: Sequence[TrackedWalk],
    *,
    prior: WalkPrior,
    rng: np.random.Generator,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> "WalkFit":
    """Fit leg offsets and floor to tracked walks of one robot on one floor.

    Args:
        robot: The robot as described.
        table: The slip law at the posterior mean of its fit to the rig's data.
        walks: The tracked walks, one or more.
        prior: The prior.
        rng: Source of randomness of all draws, also of leg angles between encoder counts.
        executor: Where draws are walked; None for here.
        progress: Called with the fraction done, from 0; ends below 1 if few rounds suffice.

    Raises:
        InsufficientData: There is no walk, or IMU and walk share less than a second.
        WalkError: A walk diverged, or the robot cannot stand at its start.
    """
    if not walks:
        raise InsufficientData("no walk was given; expected one or more with a track")
    report = progress or (lambda _: None)
    misfits = []
    for i, walk in enumerate(walks):
        report(0.05 * i / len(walks))
        misfits.append(
            WalkMisfit.of(robot, table, walk, spread=prior.spread, rng=rng, executor=executor)
        )
    search = ModeSearch(misfits, prior, executor)
    modes = search.modes(progress=lambda done: report(0.05 + 0.25 * done))
    density = _Density(misfits, prior, executor)
    start = start_mixture(
        np.stack([mode.z[WALKED] for mode in modes]),
        np.stack([mode.covariance[np.ix_(WALKED, WALKED)] for mode in modes]),
        np.array([mode.log_evidence for mode in modes]),
        np.arange(len(modes)),
    )
    drawn = importance_draws(
        start, density, effort=EFFORT, rng=rng, progress=lambda done: report(0.3 + 0.7 * done)
    )
    return WalkFit(density, drawn, tuple(walk.name for walk in walks), rng)


class _Density:
    """Posterior density with steering and stride integrated out; stores the terms of each call."""

    def __init__(
        self, misfits: Sequence[WalkMisfit], prior: WalkPrior, executor: Executor | None
    ) -> None:
        self.misfits, self.prior, self.executor = misfits, prior, executor
        self.cases = all_cases(len(misfits))
        self.rounds: list[Terms] = []

    def __call__(self, z: Array, case: NDArray[np.intp]) -> Array:
        """Compute the log posterior density up to a constant at m points, and store their terms.

        Args:
            z: Standard normal coordinates of the parameters `WALKED`, shape (m, 14).
            case: Index into `cases` of each point, shape (m,).

        Returns:
            Log density, shape (m,).
        """
        self.rounds.append(self.terms(z, case))
        return self.log_prior(z, case) + self.rounds[-1].log_likelihood()

    def log_prior(self, z: Array, case: NDArray[np.intp]) -> Array:
        """Compute the log prior density at points z (m, 14) of cases (m,), up to a constant, (m,).

        It includes the probability of each point's case.
        """
        logs = [self.prior.log_probability(c, walks=len(self.misfits)) for c in self.cases]
        return np.array(logs)[case] - 0.5 * (z**2).sum(axis=1)

    def terms(self, z: Array, case: NDArray[np.intp]) -> Terms:
        """Compute all walks at points z (m, 14) of cases (m,); return their likelihood terms."""
        values = np.zeros((len(z), WRONG + 1))
        values[:, WALKED] = z * self.prior.scale[WALKED]
        steering, stride = self.prior.scale[LINEAR]
        states = [state_in(values, case, self.cases, walk=w) for w in range(len(self.misfits))]
        walked = walk_states(self.misfits, states, executor=self.executor)
        return Terms.concat_walks([
            misfit.terms(each, steering=steering, stride=stride)
            for misfit, each in zip(self.misfits, walked, strict=True)
        ])  # fmt: skip


class WalkFit:
    """A finished fit: `posterior` of all walks; `without` computes that of all walks but one."""

    def __init__(
        self,
        density: _Density,
        drawn: WeightedDraws,
        names: tuple[str, ...],
        rng: np.random.Generator,
    ) -> None:
        self._density, self._drawn, self._names, self._rng = density, drawn, names, rng
        self._terms = Terms.concat_draws(density.rounds)
        self.posterior = self._of(range(len(names)))

    def without(self, walk: int) -> WalkPosterior:
        """Return the posterior of all walks but one: the same draws, with new weights.

        Steering and stride are drawn anew, and `best` is searched anew.

        Args:
            walk: Index of the walk that is left out; one out of range leaves none out.

        Raises:
            InsufficientData: The fit has only one walk.
            WalkError: A walk at the new mode diverged, or the robot cannot stand at its start.
        """
        if len(self._names) < 2:
            raise InsufficientData("one walk cannot be predicted from others; give two or more")
        return self._of([i for i in range(len(self._names)) if i != walk])

    def _of(self, keep: Sequence[int]) -> WalkPosterior:
        """Compute the posterior of the walks with the indices `keep` by importance weights.

        The draws of the fit stay; their weights are the density given these walks alone over the
        proposal density, Pareto-smoothed, with sum one.
        """
        density, drawn = self._density, self._drawn
        terms = self._terms.only(keep)
        log_density = density.log_prior(drawn.z, drawn.case) + terms.log_likelihood()
        weight = np.exp(pareto_smoothed(log_density - drawn.log_proposal)[0])
        values = self._values(drawn.z, *terms.conditional())
        likeliest = int(np.bincount(drawn.case, weight).argmax())
        densest = int(np.where(drawn.case == likeliest, log_density, -np.inf).argmax())
        starts = self._starts(np.where(drawn.case == likeliest, weight, 0.0), likeliest, densest)
        best, misfit = self._best(starts, likeliest, keep)
        return WalkPosterior(
            prior=density.prior,
            walks=self._names,
            cases=density.cases,
            values=values,
            case=drawn.case,
            weight=weight,
            best=best,
            best_case=density.cases[likeliest],
            misfit=misfit,
        )

    def _values(self, z: Array, mean: Array, covariance: Array) -> Array:
        """Draw steering and stride given all else; return all parameters, shape (m, 16).

        `z` (m, 14), `mean` (m, 2) and `covariance` (m, 2, 2) are in standard normal coordinates;
        the result is in the units of the parameters, the further offset of a wrongly mounted leg
        last.
        """
        noise = self._rng.standard_normal((len(z), 2, 1))
        scale = self._density.prior.scale
        values = np.zeros((len(z), WRONG + 1))
        values[:, WALKED] = z * scale[WALKED]
        values[:, LINEAR] = (mean + (np.linalg.cholesky(covariance) @ noise)[..., 0]) * scale[
            LINEAR
        ]
        return values

    def _starts(self, weight: Array, case: int, densest: int) -> list[Array]:
        """Return two starting points z (16,) of a case's optimisation, in standard coordinates.

        The first is zero, the second is the draw `densest`, at which the posterior is highest.

        In the first, a wrongly mounted leg's further offset is its mean by `weight`, which is zero
        for other cases: a scan over the offset has several maxima, and the draws show which of them
        is the highest.
        """
        plain, drawn = np.zeros(WRONG + 1), np.zeros(WRONG + 1)
        if self._density.cases[case] is not None:
            plain[WRONG] = (weight @ self._drawn.z / weight.sum())[WALKED.index(WRONG)]
        drawn[WALKED] = self._drawn.z[densest]
        drawn[ACROSS] = 0.0
        return [plain, drawn]

    def _best(
        self, starts: Sequence[Array], case: int, keep: Sequence[int]
    ) -> tuple[Array, tuple[float, ...]]:
        """Maximise a case's posterior from several starts; return the mode and all walks' misfits.

        Only the walks `keep` are fitted, with lateral traction equal to longitudinal. The mode is
        taken, not the posterior mean: on a kink of the posterior the mean lies on the side on which
        the walk does not change, and its walk differs from the draws' walks. On a kink an
        optimisation may also end early, so the best of several is refined at the finer time step.
        The mode is in the units of the parameters; a misfit is the mean squared whitened
        residual [-].
        """
        density, which = self._density, self._density.cases[case]
        misfits = [density.misfits[w] for w in keep]
        search, finer = (
            ModeSearch(walks, density.prior, density.executor, numbers=keep, held=ACROSS)
            for walks in (misfits, [each.finer() for each in misfits])
        )
        tops = [search.climb(which, start)[0].z for start in starts]
        best = min(tops, key=lambda top: search.cost(top, which))
        z = finer.climb(which, best)[0].z  # the single path is walked by the finer step
        terms = density.terms(z[WALKED][None], np.array([case]))
        counts = [misfit.count for misfit in density.misfits]
        misfit = terms.squares_at(z[LINEAR][None])[0] / counts
        return z * density.prior.scale, tuple(float(each) for each in misfit)
