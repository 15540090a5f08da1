# SPDX-License-Identifier: MIT
r"""Modes of the posterior of legs and floor in every case, by Gauss-Newton and scans.

Residuals are nearly linear in all parameters but a wrongly mounted leg's offset. The posterior of
the case without a wrongly mounted leg is therefore maximised first. At its mode, and at the prior
mode, a scan changes the offset of one leg at a time over the whole range, while all other
parameters follow linearly,

.. math::
    -2 \log p(\delta) = r'^T (I + J J^T)^{-1} r' + (\delta / \sigma)^2, \quad
    r' = r(\delta) - J \hat z ,

The scan finds every relevant case, however far its offset is from zero. The posterior of the most
probable cases is then maximised from the results of both scans: at kinks an optimisation may end
early, and the better of the two results is kept.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.robot import N_LEGS
from model.walk_fit.misfit import WalkMisfit, walk_states
from model.walk_fit.prior import WRONG, Case, WalkPrior, WrongLeg, legs_of, wrong_legs

# Steps of differences: offsets 0.1 degree, factors 5 %. Below, contacts are not smooth.
DIFFERENCE = np.array([
    *[np.radians(0.1)] * N_LEGS, 0.05, 0.05, 0.1, 0.05, 0.05, np.radians(0.1), np.radians(1.0),
    1e-3, 1e-3, np.radians(0.2),
])  # fmt: skip
MOST_MOVES = 8
SETTLED = 0.05  # of a prior's standard deviation: a smaller move ends the optimisation
GAINED = 0.3  # of twice the log posterior density: a smaller gain ends the optimisation
SCANNED = np.radians(np.linspace(-12.0, 12.0, 17))  # offsets at which walks are computed
FINE = np.radians(np.linspace(-12.0, 12.0, 241))  # offsets to which residuals are interpolated
CLIMBED = 4  # largest number of cases that are optimised after the scans
UNLIKELY = 8.0  # log evidence below the best at which a case is not optimised; margin for the scans


@dataclass(frozen=True)
class CaseMode:
    """The posterior in one case as a Gaussian, in standard normal coordinates.

    Attributes:
        z: Mode or mean of the posterior in this case, shape (d,).
        covariance: Covariance of the posterior in this case, shape (d, d).
        log_evidence: Log of the case's prior probability times its evidence, up to a constant.
        case: The wrongly mounted leg; None for no leg.
    """

    z: Array
    covariance: Array
    log_evidence: float
    case: Case


def _evidence(mode: CaseMode) -> float:
    """Return a mode's log evidence, as a key to sort by."""
    return mode.log_evidence


class ModeSearch:
    """Residuals of all walks in standard normal coordinates, and the searches for modes.

    Args:
        misfits: Misfit of each walk.
        prior: The prior.
        executor: Where walks are computed; None for here.
        numbers: Index by which cases refer to each of these walks; 0, 1, ... when None.
        held: Indices of parameters that are not varied: they end at the middle of their prior.
    """

    def __init__(
        self,
        misfits: Sequence[WalkMisfit],
        prior: WalkPrior,
        executor: Executor | None = None,
        numbers: Sequence[int] | None = None,
        held: Sequence[int] = (),
    ) -> None:
        self.misfits, self.prior, self.executor = misfits, prior, executor
        self.numbers = range(len(misfits)) if numbers is None else numbers
        self.ends = np.cumsum([misfit.size for misfit in misfits])
        self.varied = prior.scale > 0
        self.varied[list(held)] = False

    def modes(self, *, progress: Callable[[float], None]) -> list[CaseMode]:
        """Find the Gaussian of every case, in the order of `all_cases`, by scans and optimisation.

        The case without a wrongly mounted leg is optimised, and up to `CLIMBED` others whose log
        evidence by the scans is the largest and within `UNLIKELY` of the best. All others keep the
        better scan's Gaussian. `progress` gets the share done.

        Raises:
            WalkError: A walk diverged, or the robot cannot stand at its start.
        """
        plain, J = self.climb(None, np.zeros(WRONG + 1))
        progress(0.1)
        scans = self.scan(plain, J), self._scan_at_rest()
        modes = [max(found, key=_evidence) for found in zip(*scans, strict=True)]
        modes[0] = plain
        progress(0.2)
        order = sorted(range(1, len(modes)), key=lambda i: -modes[i].log_evidence)[:CLIMBED]
        best = max(map(_evidence, modes))
        for k, i in enumerate(order):
            progress(0.2 + 0.8 * k / len(order))
            if modes[i].log_evidence > best - UNLIKELY:
                tops = [self.climb(scan[i].case, scan[i].z)[0] for scan in scans]
                modes[i] = min(tops, key=lambda top: self.cost(top.z, top.case))
        return modes

    def _scan_at_rest(self) -> list[CaseMode]:
        """Estimate every case's Gaussian by a scan about the prior mode, in order of `all_cases`.

        At the mode of the first case the other parameters have already absorbed part of the effect
        of a wrongly mounted leg. The log evidence of the first case is -inf.
        """
        rest = np.zeros(WRONG + 1)
        _, J = self._linearised(rest, None)
        return self.scan(self._mode(None, rest, np.eye(WRONG + 1), -np.inf), J)

    def residuals(self, z: Array, case: Case) -> Array:
        """Compute the whitened residuals of all walks at m points.

        Args:
            z: Points in standard normal coordinates, shape (m, 16).
            case: The wrongly mounted leg, or None.

        Returns:
            Residuals of one walk after the other, shape (m, n) [-].

        Raises:
            WalkError: A walk diverged, or the robot cannot stand at its start.
        """
        values = z * self.prior.scale
        states = [legs_of(values, case, walk=w) for w in self.numbers]
        walked = walk_states(self.misfits, states, executor=self.executor)
        return np.concatenate(
            [
                misfit.residuals(state, each)
                for misfit, state, each in zip(self.misfits, states, walked, strict=True)
            ],
            axis=1,
        )

    def cost(self, z: Array, case: Case) -> float:
        """Compute twice the negative log posterior density at a point, up to a constant.

        Args:
            z: The point in standard normal coordinates, shape (16,).
            case: The wrongly mounted leg, or None.
        """
        return float((self.residuals(z[None], case)[0] ** 2).sum() + z @ z)

    def climb(self, case: Case, z: Array) -> tuple[CaseMode, Array]:
        """Find the mode of a case by Gauss-Newton with a line search, `MOST_MOVES` moves at most.

        Args:
            case: The wrongly mounted leg, or None.
            z: Starting point in standard normal coordinates, shape (16,).

        Returns:
            The mode as a Gaussian, and the Jacobian of the residuals at the mode, shape (n, 16).

        Raises:
            WalkError: A walk diverged, or the robot cannot stand at its start.
        """
        r, J = self._linearised(z, case)
        for _ in range(MOST_MOVES):
            move = -np.linalg.solve(J.T @ J + np.eye(len(z)), J.T @ r + z)
            if np.abs(move).max() < SETTLED:
                break
            trials = z + move * np.array([1.0, 0.5, 0.25, 0.1])[:, None]
            cost = (self.residuals(trials, case) ** 2).sum(axis=1) + (trials**2).sum(axis=1)
            best = int(np.argmin(cost))
            gained = r @ r + z @ z - cost[best]
            if gained <= 0:
                break
            z = trials[best]
            r, J = self._linearised(z, case)
            if gained < GAINED:
                break
        covariance = np.linalg.inv(J.T @ J + np.eye(len(z)))
        evidence = -0.5 * (r @ r + z @ z) + 0.5 * np.linalg.slogdet(covariance)[1]
        return self._mode(case, z, covariance, float(evidence)), J

    def scan(self, plain: CaseMode, J: Array) -> list[CaseMode]:
        """Estimate the Gaussian of every case by a scan over the offset of one leg at a time.

        If a leg is wrong in a single walk, the residuals of the other walks stay as at `plain`.

        Args:
            plain: Point without a wrongly mounted leg about which the scan is made.
            J: Jacobian of the residuals at that point, shape (n, 16).

        Returns:
            The Gaussians in the order of `all_cases`; the first is `plain`.
        """
        z = plain.z
        follow = np.linalg.inv(np.eye(len(J)) + J @ J.T)
        at_rest = self.residuals(z[None], None)[0]
        moved = [self._moved(leg, z) for leg in range(N_LEGS)]
        bounds = np.concatenate([[0], self.ends])
        modes = [plain]
        for case in wrong_legs(len(self.misfits)):
            r = moved[case.leg].copy()
            if case.walk is not None:
                other = np.ones(r.shape[1], dtype=bool)
                other[bounds[case.walk] : bounds[case.walk + 1]] = False
                r[:, other] = at_rest[other]
            modes.append(self._scanned(case, r - J @ z, J, follow))
        return modes

    def _moved(self, leg: int, z: Array) -> Array:
        """Compute residuals at z (16,) with a leg's further offset at each of `FINE`, (241, n).

        Walks are computed at the offsets `SCANNED`; residuals are interpolated between them.
        """
        points = np.tile(z, (len(SCANNED), 1))
        points[:, WRONG] = SCANNED / self.prior.wrong_sd
        walked = self.residuals(points, WrongLeg(leg))
        return np.stack([np.interp(FINE, SCANNED, column) for column in walked.T], axis=1)

    def _scanned(
        self, case: WrongLeg, r: Array, J: Array, follow: NDArray[np.floating]
    ) -> CaseMode:
        """Compute the Gaussian of a case, with its evidence, from one leg's scan.

        Args:
            case: The wrongly mounted leg.
            r: Residuals at each of the offsets `FINE`, with all other parameters moved linearly, by
                `J`, to the middle of their prior, shape (241, n).
            J: Jacobian of the residuals, shape (n, 16).
            follow: Inverse of I + J J^T, shape (n, n).
        """
        wrong = FINE / self.prior.wrong_sd
        log = -0.5 * ((r @ follow) * r).sum(axis=1) - 0.5 * wrong**2
        weight = np.exp(log - log.max())
        area = weight.sum() * (wrong[1] - wrong[0]) / np.sqrt(2 * np.pi)
        weight /= weight.sum()
        inner = np.linalg.inv(J.T @ J + np.eye(J.shape[1]))
        evidence = log.max() + np.log(area) + 0.5 * np.linalg.slogdet(inner)[1]
        z = -r @ J @ inner
        z[:, WRONG] = wrong
        inner[WRONG, WRONG] = 0.0  # its variance is that of the scan, below
        mean = weight @ z
        covariance = inner + (z - mean).T @ ((z - mean) * weight[:, None])
        return self._mode(case, mean, covariance, float(evidence))

    def _mode(
        self, case: Case, z: Array, covariance: NDArray[np.floating], evidence: float
    ) -> CaseMode:
        """Build a mode; `evidence` is its log evidence without the case's prior probability."""
        log_probability = self.prior.log_probability(case, walks=len(self.misfits))
        return CaseMode(z, np.asarray(covariance, dtype=float), evidence + log_probability, case)

    def _linearised(self, z: Array, case: Case) -> tuple[Array, Array]:
        """Compute residuals (n,) at z (16,), and their Jacobian (n, 16) by central differences.

        Without a wrongly mounted leg the column of its further offset is zero, and so are those of
        parameters that are held.
        """
        varied = self.varied.copy()
        varied[WRONG] &= case is not None  # without a wrongly mounted leg its offset moves nothing
        columns = np.flatnonzero(varied)
        step = DIFFERENCE[columns] / self.prior.scale[columns]
        steps = np.eye(len(z))[columns] * step[:, None]
        rows = self.residuals(np.concatenate([z[None], z + steps, z - steps]), case)
        k = len(step)
        J = np.zeros((rows.shape[1], len(z)))
        J[:, columns] = ((rows[1 : k + 1] - rows[k + 1 :]) / (2 * step[:, None])).T
        return rows[0], J
