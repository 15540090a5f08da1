# SPDX-License-Identifier: MIT
r"""Whitened residuals between a tracked walk and its prediction.

Each walk is predicted from its leg angles and its first tracked pose. Differences r from the later
poses contain the tracker's errors e of all poses, of joint covariance :math:`V`, that of the first
pose by its lever arm :math:`J_0`; the model's errors of distance (derivative d) and curvature
(derivative c), and of stiffness and damping of contacts, :math:`H`; and the spread that counted
angles leave, or else the time step's error, :math:`Q`. The model's errors are the same all along a
walk, so the walk's poses are strongly correlated,

.. math::
    r \sim N(0,\; M V M^T + \sigma_d^2\, d d^T + \sigma_c^2\, c c^T + H + Q) , \qquad
    M = [J_0 \;\; {-1}] .
"""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from model.errors import WalkError
from model.gait.reference import LegReference
from model.leg_state import LegState, law_in, robot_in
from model.path_draws import bent, states_at
from model.poses import Poses, moved_onto, wrap
from model.predict import FINE, ModelSpread, ensemble_step, motions
from model.robot import N_LEGS, Robot
from model.tasks import compute_tasks
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import (
    PlanarWalk,
    WalkDraw,
    WalkedTimes,
    planar,
    walk_draw,
    walk_ensemble,
)
from model.walk.traction import TractionTable
from model.walk_fit.terms import Terms
from model.walk_fit.tilt import TiltMisfit
from model.walk_fit.tracked_walk import TrackedWalk, middle

RECONSTRUCTIONS = 16  # motions drawn from counted angles; or walks that show the step's error
# s; with a wrongly mounted leg 5 ms turns by 3 % more and saves a third of the time
LARGEST_STEP = 0.0025
OFFSETS_SD = np.radians(0.2)  # sd of leg offsets in walks that show the step's error [rad]
SAMPLING = 0.05  # s between the poses kept of a path
FINE_SAMPLING = 0.02  # s, where roll and pitch are compared
_BEND = 1e-3  # step in distance and curvature for finite differences


@dataclass(frozen=True)
class WalkMisfit:
    """One tracked walk with the covariance of its differences from a prediction.

    Attributes:
        robot: The robot as described.
        table: The slip law at the posterior mean of its fit to the rig's data.
        walk: The tracked walk, n poses.
        options: Time step and contacts with which walks are computed.
        root: Whitening matrix: inverse of the lower Cholesky factor of the covariance of the
            differences, shape (k, k), with k = 3 (n - 1).
        tilt: Roll and pitch by the IMU, for comparison with walks; None without an IMU.
    """

    robot: Robot
    table: TractionTable
    walk: TrackedWalk
    options: DynamicsOptions
    root: Array
    tilt: TiltMisfit | None = None

    @classmethod
    def of(
        cls,
        robot: Robot,
        table: TractionTable,
        walk: TrackedWalk,
        *,
        spread: ModelSpread,
        rng: np.random.Generator,
        executor: Executor | None = None,
    ) -> "WalkMisfit":
        """Build the misfit of a walk: choose the time step and compute the whitening matrix.

        Args:
            robot: The robot as described.
            table: The slip law at the posterior mean of its fit to the rig's data.
            walk: The walk.
            spread: Errors of the walking model in one walk.
            rng: Source of randomness, for leg angles that encoder counts leave undetermined.
            executor: Where walks are computed; None for here.

        Raises:
            WalkError: A walk diverged, or the robot cannot stand at its start.
            InsufficientData: IMU and walk share less than a second.
        """
        plain = WalkDraw(robot, middle(walk.legs), table)
        chosen = ensemble_step([plain], duration=float(walk.t[-1]))
        options = replace(chosen, dt=min(chosen.dt, LARGEST_STEP))
        misfit = cls(robot, table, walk, options, np.eye(3 * (len(walk.t) - 1)))
        if walk.tilt is not None:
            tilt = TiltMisfit.of(walk.tilt, misfit._times(), walk.legs)
            misfit = replace(misfit, tilt=tilt)
        covariance = misfit._covariance(spread, rng, executor)
        # With L L^T the covariance, L^-1 makes the residuals' covariance the identity.
        return replace(misfit, root=np.linalg.inv(np.linalg.cholesky(covariance)))

    def finer(self) -> "WalkMisfit":
        """Return the same misfit with walks computed by `model.predict.FINE`, and the same root."""
        return replace(self, options=FINE)

    @property
    def size(self) -> int:
        """Number of residuals: three for each pose but the first, and those of roll and pitch."""
        return len(self.root) + (0 if self.tilt is None else self.tilt.measured.size)

    @property
    def count(self) -> float:
        """Effective number of independent residuals.

        Those of the poses count in full, those of roll and pitch as many as one stride has.
        """
        return len(self.root) + (0.0 if self.tilt is None else self.tilt.count)

    def residuals(self, state: LegState, walked: PlanarWalk) -> Array:
        """Compute the whitened residuals, predicted minus tracked, for m states of the legs.

        Args:
            state: The m states.
            walked: Their walks by `walk_states`, which the states' steering and stride then bend.

        Returns:
            Residuals of x, y and yaw of each pose after the first, then of roll and pitch if there
            is an IMU, shape (m, size) [-].
        """
        paths = bent(walked.poses, distance=state.stride, curvature=state.steering)
        return self._with_tilt(self._difference(paths) @ self.root.T, walked)

    def terms(self, walked: PlanarWalk, *, steering: float, stride: float) -> Terms:
        """Compute the likelihood terms of this walk for m states of the legs.

        Args:
            walked: The walks of the states, by `walk_states`, without steering and stride.
            steering: Prior standard deviation of steering, its unit in the terms [rad/m].
            stride: Prior standard deviation of stride, its unit in the terms [-].
        """
        no = np.zeros(len(walked.poses.states))
        here = self._difference(walked.poses)
        bends = [
            self._difference(bent(walked.poses, distance=no, curvature=no + steering)) - here,
            self._difference(bent(walked.poses, distance=no + stride, curvature=no)) - here,
        ]
        residuals = self._with_tilt(here @ self.root.T, walked)
        by_bend = np.zeros((*residuals.shape, len(bends)))  # roll and pitch do not depend on them
        for i, bend in enumerate(bends):
            by_bend[:, : len(self.root), i] = bend @ self.root.T
        return Terms.of(residuals, by_bend)

    def _with_tilt(self, residuals: Array, walked: PlanarWalk) -> Array:
        """Append the residuals of roll and pitch, if any, to the poses' residuals (m, k)."""
        if self.tilt is None or walked.tilt is None:
            return residuals
        return np.concatenate([residuals, self.tilt.residuals(walked.tilt)], axis=1)

    def tasks(self, state: LegState) -> "list[StateToWalk]":
        """Return the tasks that walk each of m states of the legs, without steering and stride.

        Args:
            state: The m states.
        """
        times = WalkedTimes(self._times(), self.options, self.tilt is not None)
        legs = middle(self.walk.legs)
        parts = [state.part(slice(i, i + 1)) for i in range(len(state))]
        return [StateToWalk(self.robot, legs, self.table, times, part) for part in parts]

    def joined(self, walked: Sequence[Array]) -> PlanarWalk:
        """Join what the tasks of m states have walked, in their order.

        Args:
            walked: Results of `tasks`, by `walk_state`.
        """
        return planar(self._times(), np.stack(walked))

    def _walked(self, draws: Sequence[WalkDraw], executor: Executor | None) -> PlanarWalk:
        """Compute every draw's walk at `_times`, with roll and pitch if there is an IMU."""
        tilted = self.tilt is not None
        return walk_ensemble(
            draws, self._times(), options=self.options, executor=executor, tilt=tilted
        )

    def _times(self) -> Array:
        """Return evenly spaced times from 0 to the last tracked pose [s]; finer with an IMU."""
        end = float(self.walk.t[-1])
        step = SAMPLING if self.walk.tilt is None else FINE_SAMPLING
        return np.linspace(0.0, end, max(round(end / step), 2) + 1)

    def _difference(self, paths: Poses) -> Array:
        """Move m paths onto the first tracked pose; return predicted minus later tracked poses.

        The shape is (m, 3 (n - 1)): x, y [m] and wrapped yaw [rad] of one pose after the other.
        """
        states = states_at(paths, self.walk.t)
        states = moved_onto(states, states[:, 0], self.walk.states[0])
        difference = states[:, 1:] - self.walk.states[1:]
        difference[..., 2] = wrap(difference[..., 2])
        return difference.reshape(len(states), -1)

    def _covariance(
        self, spread: ModelSpread, rng: np.random.Generator, executor: Executor | None
    ) -> Array:
        """Compute the covariance (k, k) of predicted minus tracked poses: the module's equation."""
        several = motions(self.walk.legs, RECONSTRUCTIONS, rng)
        draws = [WalkDraw(self.robot, each, self.table) for each in several]
        paths = self._walked(draws, executor).poses
        one = paths.draws(slice(1))
        total = self._of_tracker(self._difference(one)[0])
        # Without the small term an exact tracker would leave nothing to invert.
        total += self._of_model(one, spread) + 1e-12 * np.eye(len(total))
        total += self._of_contacts(spread, executor)
        if len(several) > 1:  # their spread includes the error of the step
            return total + np.cov(self._difference(paths).T)
        return total + self._of_step(several[0], rng, executor)

    def _of_step(
        self, legs: LegReference, rng: np.random.Generator, executor: Executor | None
    ) -> Array:
        """Compute the covariance (k, k) of the time step's error, from walks at it and at half.

        The walks have small random leg offsets, since the error differs from path to path.
        """
        draws = [
            WalkDraw(replace(self.robot, leg_offset=self.robot.leg_offset + each), legs, self.table)
            for each in OFFSETS_SD * rng.standard_normal((RECONSTRUCTIONS, N_LEGS))
        ]
        half = replace(self, options=replace(self.options, dt=0.5 * self.options.dt))
        coarse, fine = (
            each._difference(each._walked(draws, executor).poses) for each in (self, half)
        )
        return (coarse - fine).T @ (coarse - fine) / RECONSTRUCTIONS

    def _of_tracker(self, difference: Array) -> Array:
        """Compute the covariance (k, k) of the tracker's errors, the first pose's by its lever arm.

        Args:
            difference: Predicted minus tracked poses after the first, shape (k,).
        """
        walk, n = self.walk, len(self.walk.t) - 1
        predicted = difference.reshape(n, 3) + walk.states[1:]
        away = predicted[:, :2] - walk.states[0, :2]
        J0 = np.tile(np.eye(3), (n, 1, 1))
        J0[:, 0, 2], J0[:, 1, 2] = -away[:, 1], away[:, 0]
        M = np.hstack((J0.reshape(3 * n, 3), -np.eye(3 * n)))
        return M @ walk.joint.dense @ M.T

    def _of_model(self, path: Poses, spread: ModelSpread) -> Array:
        """Compute the covariance (k, k) due to the model's errors of distance and curvature.

        Derivatives are forward differences of `path`, which has one draw.
        """
        no, small = np.zeros(1), np.full(1, _BEND)
        here = self._difference(path)[0]
        d = (self._difference(bent(path, distance=small, curvature=no))[0] - here) / _BEND
        c = (self._difference(bent(path, distance=no, curvature=small))[0] - here) / _BEND
        return spread.distance**2 * np.outer(d, d) + spread.curvature**2 * np.outer(c, c)

    def _of_contacts(self, spread: ModelSpread, executor: Executor | None) -> Array:
        """Compute the covariance (k, k) due to uncertain stiffness and damping of contacts.

        Each is moved by one standard deviation of its logarithm up and down, and half the
        difference of the paths is taken as the error. The effect depends on the gait: where
        four legs are on the ground, contact stiffness determines how they share the load, and so
        the turn.
        """
        factors = np.exp(spread.contacts * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]]))
        plain = WalkDraw(self.robot, middle(self.walk.legs), self.table)
        draws = [replace(plain, stiffness=k, damping=c) for k, c in factors]
        paths = self._difference(self._walked(draws, executor).poses)
        moved = 0.5 * (paths[::2] - paths[1::2])
        return moved.T @ moved


@dataclass(frozen=True)
class StateToWalk:
    """A state of the legs in one walk, to be walked: an independent task.

    Attributes:
        robot: The robot as described.
        legs: Leg angles.
        table: The slip law as calibrated.
        times: Times of the poses to keep, step and contacts, and whether roll and pitch are kept.
        state: The state, of one draw.
    """

    robot: Robot
    legs: LegReference
    table: TractionTable
    times: WalkedTimes
    state: LegState

    @property
    def draw(self) -> WalkDraw:
        """The state as a draw of a walk, without steering and stride."""
        return WalkDraw(
            robot_in(self.robot, self.state, 0), self.legs, law_in(self.table, self.state, 0)
        )


def walk_state(task: StateToWalk) -> Array:
    """Walk a state of the legs; result and errors are those of `model.walk.ensemble.walk_draw`.

    Args:
        task: The state.
    """
    return walk_draw(task.times, task.draw)


def walk_states(
    misfits: Sequence[WalkMisfit], states: Sequence[LegState], *, executor: Executor | None = None
) -> list[PlanarWalk]:
    """Walk states of the legs in each of several walks, as tasks of all walks side by side.

    Args:
        misfits: The walks.
        states: The states of the legs in each of them, at least one.
        executor: Where states are walked; None for here.

    Raises:
        WalkError: A walk diverged, or the robot cannot stand at its start.
    """
    pairs = zip(misfits, states, strict=True)
    tasks = [misfit.tasks(state) for misfit, state in pairs]
    each = [task for of_walk in tasks for task in of_walk]
    results = compute_tasks(executor, walk_state, each)
    return [
        misfit.joined([_next_states(results, misfit.walk.name) for _ in of_walk])
        for misfit, of_walk in zip(misfits, tasks, strict=True)
    ]


def _next_states(results: Iterator[Array], name: str) -> Array:
    """Return the next task's result; name the walk in the `WalkError` of a task that fails."""
    try:
        return next(results)
    except WalkError as error:
        raise WalkError(f"walk '{name}': {error}") from error
