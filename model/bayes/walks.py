# SPDX-License-Identifier: MIT
r"""What tracked walks say of the legs and the floor: each leg's offset, grip, slip stiffness.

Each walk is predicted from its leg angles and its first tracked pose. Differences from the other
poses have the tracker's noise, that of the first pose, what counted angles leave open and what the
walking model itself gets wrong; the last three are the same all along a walk, so its poses are
strongly correlated,

.. math::
    r \sim N(0,\; V + J_0 V_0 J_0^T + \sigma_d^2\, d d^T + \sigma_c^2\, c c^T + Q) .

Two walks cannot tell six offsets apart unless most are small. So a prior says: every leg is off by
a little, and perhaps one, mounted wrong, by a lot. Each of these seven cases is a Gaussian in
standard normal coordinates; the posterior is a Gaussian at the mode of each, weighted by evidence.
Paths alone often cannot name the leg: one middle leg turned forward leads about where the other
turned back does; the weights say so.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from model.errors import InsufficientData
from model.gait.quantised import QuantisedLog
from model.gait.reference import LegReference
from model.metrics.poses import wrap
from model.predict import ENSEMBLE_STEP, LegState, ModelSpread, bent, scaled_table, states_at
from model.robot import N_LEGS, Robot
from model.slip.law import Array
from model.walk.ensemble import PathEnsemble, WalkDraw, walk_ensemble
from model.walk.traction import TractionTable

NAMES = (
    *(f"leg_offset{leg}" for leg in range(1, N_LEGS + 1)),
    "grip",
    "slip_stiffness",
    "common_offset",
)
RECONSTRUCTIONS = 16  # of counted angles, for the spread they leave
# Offsets by a tenth of a degree, factors by 5 %: contacts are not smooth below.
DIFFERENCE = np.array([*[np.radians(0.1)] * N_LEGS, 0.05, 0.05, np.radians(0.1)])
MOST_MOVES = 20
STUCK = 0.5  # of a prior's standard deviation: a longer step that does not help is a failure
SETTLED = 0.02  # of a prior's standard deviation
CASES: tuple[int | None, ...] = (None, *range(N_LEGS))
UNINFORMED = 0.1  # contraction of variance below which walks said nothing


@dataclass(frozen=True)
class TrackedWalk:
    """A walk that was tracked.

    Attributes:
        name: Its name.
        legs: Its leg angles from time zero on.
        t: Times of the tracked poses in the same clock, the first of which starts the prediction,
            shape (n,) [s].
        states: Tracked x, y [m] and yaw [rad], shape (n, 3).
        covariance: The tracker's covariance of each, shape (n, 3, 3).

    Raises:
        InsufficientData: There are fewer than three poses.
    """

    name: str
    legs: LegReference | QuantisedLog
    t: Array
    states: Array
    covariance: Array

    def __post_init__(self) -> None:
        """Refuse a track that says nothing."""
        if len(self.t) < 3:
            raise InsufficientData(
                f"walk '{self.name}' has {len(self.t)} tracked poses; expected three or more"
            )


@dataclass(frozen=True)
class WalkPrior:
    """What is believed before any walk.

    Attributes:
        offset_sd: Standard deviation of each leg's own offset [rad].
        common_sd: That of the offset all share: whether counts are rounded or cut is half a count
            [rad].
        wrong_sd: That of a leg that is mounted wrong [rad].
        wrong: Probability that one leg is [-].
        grip_sd: Standard deviation of the logarithm of the factor on traction: floor and rig differ
            [-].
        stiffness_sd: That of the factor on slip stiffness [-].
        spread: What the walking model gets wrong.
    """

    offset_sd: float = float(np.radians(0.2))
    common_sd: float = float(np.radians(1.0))
    wrong_sd: float = float(np.radians(5.0))
    wrong: float = 0.2
    grip_sd: float = 0.3
    stiffness_sd: float = 0.5
    spread: ModelSpread = field(default_factory=ModelSpread)

    def scale(self, case: int | None) -> Array:
        """Return standard deviations in the order of `NAMES`, shape (9,) [rad, -].

        Args:
            case: Index of the leg that is mounted wrong; None for no leg.
        """
        scale = np.array(
            [*[self.offset_sd] * N_LEGS, self.grip_sd, self.stiffness_sd, self.common_sd]
        )
        if case is not None:
            scale[case] = self.wrong_sd
        return scale

    def log_probability(self, case: int | None) -> float:
        """Return the log of a case's probability."""
        return float(np.log(1 - self.wrong if case is None else self.wrong / N_LEGS))

    @property
    def sd(self) -> Array:
        """Standard deviations over all cases, shape (9,)."""
        weights = np.exp([self.log_probability(case) for case in CASES])
        variance = np.stack([self.scale(case) ** 2 for case in CASES])
        return np.sqrt(weights @ variance)


def legs_of(values: Array) -> LegState:
    """Turn parameters in the order of `NAMES`, shape (m, 9), into the legs' state."""
    offset = values[:, :N_LEGS] + values[:, 8:]
    return LegState(offset, np.exp(values[:, 6]), np.exp(values[:, 7]))


@dataclass(frozen=True)
class Contraction:
    """Prior against posterior of one parameter.

    Attributes:
        name: One of `NAMES`; offsets in radians, factors as logarithms.
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
        """One minus posterior over prior variance; zero where walks said nothing [-]."""
        return 1 - (self.sd / self.prior_sd) ** 2

    @property
    def informed(self) -> bool:
        """Tell whether the walks said anything of it."""
        return self.contraction > UNINFORMED


@dataclass(frozen=True)
class Mode:
    """The posterior in one case.

    Attributes:
        wrong_leg: Index of the leg that is mounted wrong; None for no leg.
        mean: Parameters in the order of `NAMES`, shape (9,) [rad, -].
        covariance: Their covariance, shape (9, 9).
        log_evidence: Log of the case's probability times its evidence.
        converged: Whether the search settled.
        misfit: Mean squared whitened residual of each walk, at most about 1 [-].
    """

    wrong_leg: int | None
    mean: Array
    covariance: Array
    log_evidence: float
    converged: bool
    misfit: tuple[float, ...]


@dataclass(frozen=True)
class WalkPosterior:
    """The posterior after walks: a mixture of Gaussians, a case each.

    Attributes:
        prior: The prior.
        modes: One a case.
    """

    prior: WalkPrior
    modes: tuple[Mode, ...]

    @property
    def weights(self) -> Array:
        """Probability of each case, shape (7,) [-]."""
        log = np.array([mode.log_evidence for mode in self.modes])
        weights = np.exp(log - log.max())
        return weights / weights.sum()

    @property
    def likeliest(self) -> Mode:
        """The likeliest case."""
        return self.modes[int(np.argmax(self.weights))]

    def draw(self, n: int, *, rng: np.random.Generator) -> LegState:
        """Draw states of the legs for `model.predict.walk_draws`."""
        counts = rng.multinomial(n, self.weights)
        parts = [
            rng.multivariate_normal(mode.mean, mode.covariance, size=count, method="eigh")
            for mode, count in zip(self.modes, counts, strict=True)
        ]
        return legs_of(rng.permutation(np.concatenate(parts)))

    def contractions(self) -> tuple[Contraction, ...]:
        """Compare prior and posterior of every parameter, over all cases."""
        means = np.stack([mode.mean for mode in self.modes])
        squares = np.stack([mode.mean**2 + np.diag(mode.covariance) for mode in self.modes])
        mean = self.weights @ means
        sd = np.sqrt(self.weights @ squares - mean**2)
        return tuple(
            Contraction(name, float(p), float(m), float(s))
            for name, p, m, s in zip(NAMES, self.prior.sd, mean, sd, strict=True)
        )


def fit_walks(
    robot: Robot,
    table: TractionTable,
    walks: Sequence[TrackedWalk],
    *,
    prior: WalkPrior,
    rng: np.random.Generator,
    threads: int = 2,
) -> WalkPosterior:
    """Fit leg offsets, grip and slip stiffness to tracked walks.

    Args:
        robot: The robot as described.
        table: The slip law at the rig's posterior mean.
        walks: Walks of the same robot and floor.
        prior: What is believed before.
        rng: Source of randomness, for what counted angles leave open.
        threads: Walks computed at once.

    Raises:
        InsufficientData: There is no walk.
        WalkError: A walk diverged.
    """
    if not walks:
        raise InsufficientData("no walk to fit; name one or more with a track")
    fits = [_Fit.of(robot, table, walk, prior.spread, rng, threads) for walk in walks]
    return WalkPosterior(prior, tuple(_fit_case(fits, prior, case, threads) for case in CASES))


def _fit_case(fits: Sequence["_Fit"], prior: WalkPrior, case: int | None, threads: int) -> Mode:
    """Climb to the mode of a case by Gauss-Newton, with steps shortened while they overshoot."""
    scale = prior.scale(case)

    def residuals(z: Array) -> Array:
        return np.concatenate([fit.whitened(z * scale, threads) for fit in fits], axis=1)

    z = np.zeros(len(NAMES))
    r, J = _linearised(residuals, z, DIFFERENCE / scale)
    converged = False
    for _ in range(MOST_MOVES):
        move = -np.linalg.solve(J.T @ J + np.eye(len(z)), J.T @ r + z)
        trials = z + move * np.array([1.0, 0.5, 0.25, 0.1])[:, None]
        cost = (residuals(trials) ** 2).sum(axis=1) + (trials**2).sum(axis=1)
        best = int(np.argmin(cost))
        if cost[best] >= r @ r + z @ z:
            converged = bool(np.abs(move).max() < STUCK)
            break
        step, z = np.abs(trials[best] - z).max(), trials[best]
        r, J = _linearised(residuals, z, DIFFERENCE / scale)
        if step < SETTLED:
            converged = True
            break
    covariance = np.linalg.inv(J.T @ J + np.eye(len(z)))
    evidence = -0.5 * (r @ r + z @ z) + 0.5 * np.linalg.slogdet(covariance)[1]
    ends = np.cumsum([len(fit.root) for fit in fits])[:-1]
    return Mode(
        case,
        z * scale,
        covariance * np.outer(scale, scale),
        float(evidence) + prior.log_probability(case),
        converged,
        tuple(float(np.mean(part**2)) for part in np.split(r, ends)),
    )


@dataclass(frozen=True)
class _Fit:
    """One walk, ready to be compared: its forward model and the root of its precision."""

    robot: Robot
    table: TractionTable
    walk: TrackedWalk
    root: Array

    @classmethod
    def of(
        cls,
        robot: Robot,
        table: TractionTable,
        walk: TrackedWalk,
        spread: ModelSpread,
        rng: np.random.Generator,
        threads: int,
    ) -> "_Fit":
        fit = cls(robot, table, walk, np.eye(3 * (len(walk.t) - 1)))
        covariance = fit._covariance(spread, rng, threads)
        # With L L^T the covariance, L^-1 makes the residuals' covariance the identity.
        return replace(fit, root=np.linalg.inv(np.linalg.cholesky(covariance)))

    def whitened(self, values: Array, threads: int) -> Array:
        """Compute residuals of unit covariance at m parameter vectors, shape (m, 3 (n - 1))."""
        state = legs_of(values)
        angles = _middle(self.walk.legs)
        draws = [
            WalkDraw(
                replace(self.robot, leg_offset=self.robot.leg_offset + offset),
                angles,
                scaled_table(self.table, grip=float(grip), stiffness=float(stiffness)),
            )
            for offset, grip, stiffness in zip(
                state.offset, state.grip, state.stiffness, strict=True
            )
        ]
        return self._difference(self._walked(draws, threads)) @ self.root.T

    def _walked(self, draws: Sequence[WalkDraw], threads: int) -> PathEnsemble:
        t = np.linspace(0.0, float(self.walk.t[-1]), max(round(self.walk.t[-1] / 0.05), 2) + 1)
        return walk_ensemble(draws, t, options=ENSEMBLE_STEP, threads=threads)

    def _difference(self, paths: PathEnsemble) -> Array:
        """Predict from the first pose, subtract what was tracked; shape (m, 3 (n - 1))."""
        states = from_first(states_at(paths, self.walk.t), self.walk.states[0])
        difference = states[:, 1:] - self.walk.states[1:]
        difference[..., 2] = wrap(difference[..., 2])
        return difference.reshape(len(states), -1)

    def _covariance(self, spread: ModelSpread, rng: np.random.Generator, threads: int) -> Array:
        walk, n = self.walk, len(self.walk.t) - 1
        legs = walk.legs
        several = (
            [legs.smooth(rng) for _ in range(RECONSTRUCTIONS)]
            if isinstance(legs, QuantisedLog)
            else [legs]
        )
        paths = self._walked([WalkDraw(self.robot, each, self.table) for each in several], threads)
        first = PathEnsemble(paths.t, paths.position[:1], paths.yaw[:1])
        nothing, one = np.zeros(1), np.ones(1)
        small = 1e-3
        here = self._difference(first)[0]
        longer = self._difference(bent(first, distance=small * one, curvature=nothing))[0]
        curved = self._difference(bent(first, distance=nothing, curvature=small * one))[0]
        d, c = (longer - here) / small, (curved - here) / small
        states = here.reshape(n, 3) + walk.states[1:]
        away = states[:, :2] - walk.states[0, :2]
        J0 = np.tile(np.eye(3), (n, 1, 1))
        J0[:, 0, 2], J0[:, 1, 2] = -away[:, 1], away[:, 0]
        J0 = J0.reshape(3 * n, 3)
        total = J0 @ walk.covariance[0] @ J0.T + 1e-12 * np.eye(3 * n)
        total += spread.distance**2 * np.outer(d, d) + spread.curvature**2 * np.outer(c, c)
        for i in range(n):
            total[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] += walk.covariance[i + 1]
        if len(several) > 1:
            total += np.cov(self._difference(paths).T)
        return total


def from_first(states: Array, first: Array) -> Array:
    """Move paths so that they begin at a pose.

    Args:
        states: x, y, yaw of m paths at n times, shape (m, n, 3) [m, m, rad].
        first: The pose, shape (3,).
    """
    turn = first[2] - states[:, :1, 2]
    away = states[..., :2] - states[:, :1, :2]
    c, s = np.cos(turn), np.sin(turn)
    x = first[0] + c * away[..., 0] - s * away[..., 1]
    y = first[1] + s * away[..., 0] + c * away[..., 1]
    return np.stack([x, y, states[..., 2] + turn], axis=-1)


def _middle(legs: LegReference | QuantisedLog) -> LegReference:
    return legs.smooth() if isinstance(legs, QuantisedLog) else legs


def _linearised(residuals: Callable[[Array], Array], z: Array, step: Array) -> tuple[Array, Array]:
    """Return residuals and their Jacobian by central differences, in one batch."""
    steps = np.diag(step)
    rows = residuals(np.concatenate([z[None], z + steps, z - steps]))
    plus, minus = rows[1 : len(z) + 1], rows[len(z) + 1 :]
    return rows[0], ((plus - minus) / (2 * step[:, None])).T
