# SPDX-License-Identifier: MIT
"""Smooth planar poses at irregular times (Gaussian-process smoother); gaps stay gaps.

Between photographs the robot is assumed to keep its twist (forward speed, sideways speed, turning
rate in its own frame), disturbed by white noise (`tracking.constant_twist`). A constant twist is an
arc, so the corners of a turning path are not cut. `tracking.chain_fit` has the least squares.

The noise densities of the twist and the gait's sway, unless they are given, are means (of standard
deviations) over the marginal likelihood (Laplace's approximation) with a wide prior. Where poses
are uncertain, any small density explains them: the likeliest one may be next to none, and the path
would be claimed to be as smooth as that.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize

from model.arrays import Array
from tracking.chain_fit import Chain, ChainProblem, SharedInput
from tracking.constant_twist import Process
from tracking.errors import PathError

_LONGEST_SEARCH = 200  # poses of a segment from which densities are estimated
# Prior of the densities and the sway: a walking robot's, and standard deviations of logarithms
_USUAL, _USUAL_SD = Process(1e-4, 1e-3, 1.0), np.array([4.0, 4.0, 1.0])
_OF_SD = np.array([0.5, 0.5, 1.0])  # powers that make standard deviations: densities are variances
_AROUND = np.linspace(-8.0, 6.0, 15)  # logarithms of densities over the likeliest


@dataclass(frozen=True)
class SmoothPath:
    """A smoothed path at the times of the photographs.

    Attributes:
        poses: x, y [m] and yaw [rad], yaw continuous within a segment, shape (n, 3).
        covariance: Covariance of `poses`, shape (n, 3, 3).
        twist: Forward speed, speed to the left [m/s] and turning rate [rad/s], shape (n, 3).
        segment: Number, from 0, of the stretch without gap that each sample is in, shape (n,).
        suspect: True where the squared Mahalanobis distance of a measured pose, with the estimated
            shared errors added, from the path exceeds 25, by the covariance of the measurement (3
            degrees of freedom), shape (n,).
        process: The noise densities used, given or estimated.
        own: Covariance of pose and twist if the shared errors were known, shape (n, 6, 6).
        following: The same between each sample and the next, shape (n - 1, 6, 6); zero over gaps.
        gain: Derivative of all poses by the measured ones' shared errors, as a function: it takes
            F, shape (n, 3, q), and returns the derivative of the smoothed poses, (n, 3, q).
        log_likelihood: Log marginal likelihood (Laplace) of the measured poses, up to a constant.
        shared: Estimate of u, shape (r,).
        shared_covariance: Covariance of u, shape (r, r).
    """

    poses: Array
    covariance: Array
    twist: Array
    segment: NDArray[np.int64]
    suspect: NDArray[np.bool_]
    process: Process
    own: Array
    following: Array
    gain: Callable[[Array], Array]
    log_likelihood: float
    shared: Array
    shared_covariance: Array

    @property
    def gap_before(self) -> NDArray[np.bool_]:
        """True for the first sample of every segment but the first, shape (n,)."""
        return np.diff(self.segment, prepend=self.segment[:1]) > 0


def smooth(
    t: ArrayLike,
    poses: ArrayLike,
    *,
    covariance: ArrayLike,
    time_sd: ArrayLike = 0.0,
    gap: float | None = None,
    process: Process | None = None,
    start: Process | None = None,
    shared: SharedInput | None = None,
    average: bool = True,
) -> SmoothPath:
    """Smooth measured poses by least squares with a constant-twist motion model.

    Args:
        t: Times, strictly increasing, shape (n,) [s].
        poses: Measured x, y [m] and yaw [rad], shape (n, 3); yaw may wrap.
        covariance: Covariance of each measured pose, independent of each other, shape (n, 3, 3).
        time_sd: Standard deviation of each time, shape () or (n,) [s]; multiplied by the measured
            rate of change of the pose and squared, it is added to `covariance`.
        gap: Interval longer than which the path is interrupted [s]; None means 3.5 times the
            median interval.
        process: Noise densities of the motion model; None estimates them, or takes 1e-3 m²/s³ and
            1e-2 rad²/s³ where no segment has three poses.
        start: Noise densities near those to be estimated; None if none are known.
        shared: Errors that the measured poses share; None for none.
        average: Whether what is estimated is a mean of standard deviations over the likelihood;
            False takes the likeliest, in half the time.

    Returns:
        The path, at the times `t` only.

    Raises:
        PathError: When there is no pose, times do not increase, shapes disagree, a covariance is
            not positive definite, or standard deviations and intervals of time differ by more than
            numbers can hold.
    """
    times, measured, spread = _checked(t, poses, covariance)
    stamp_sd = np.broadcast_to(np.asarray(time_sd, dtype=float), times.shape)
    known = SharedInput.none(len(times)) if shared is None else shared
    segment = _segments(times, gap)
    rows = [np.flatnonzero(segment == number) for number in np.unique(segment)]
    parts = [
        Chain.of(times[part], measured[part], spread[part], stamp_sd[part], known.by_error[part])
        for part in rows
    ]
    problem = ChainProblem(parts, known)
    try:
        found = process or _estimated(problem, start, average)
        solved = problem.solve(found)
    except np.linalg.LinAlgError as error:
        raise PathError(
            "no path can be computed through these poses: standard deviations and intervals of "
            "time differ by more than numbers can hold; correct the times (--times)"
        ) from error
    state, own = np.concatenate(solved.states), np.concatenate(solved.covariances)
    by_error = problem.gain(solved, known.by_error)
    # `own` is the covariance if the shared errors were known; this is what they add.
    common = by_error @ solved.shared_covariance @ by_error.transpose(0, 2, 1)
    corrected = np.concatenate([part.corrected(solved.shared) for part in parts])
    residual = state[:, :3] - corrected
    noise = np.concatenate([part.spread for part in parts])
    far = np.einsum("ni,nij,nj->n", residual, np.linalg.inv(noise), residual) > 25
    following = np.zeros((max(len(times) - 1, 0), 6, 6))
    for part, cross in zip(rows, solved.following, strict=True):
        following[part[:-1]] = cross
    return SmoothPath(
        state[:, :3], own[:, :3, :3] + common, state[:, 3:], segment, far, found, own, following,
        lambda by_error: problem.gain(solved, by_error), solved.log_likelihood, solved.shared,
        solved.shared_covariance,
    )  # fmt: skip


def _checked(t: ArrayLike, poses: ArrayLike, covariance: ArrayLike) -> tuple[Array, Array, Array]:
    """Return times (n,), poses (n, 3) and covariances (n, 3, 3) as arrays of floats.

    Raises:
        PathError: There is no pose, shapes disagree, times do not increase, or a covariance is not
            positive definite.
    """
    times, measured = np.asarray(t, dtype=float), np.asarray(poses, dtype=float)
    spread = np.asarray(covariance, dtype=float)
    n = len(times)
    if n == 0 or measured.shape != (n, 3) or spread.shape != (n, 3, 3):
        raise PathError(
            f"{n} times, poses of shape {measured.shape} and covariances of shape {spread.shape} "
            f"do not belong together; expected (n,), (n, 3) and (n, 3, 3), n at least 1"
        )
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size:
        k = int(late[0])
        raise PathError(
            f"pose {k + 2} is at {times[k + 1]:g} s and the one before it at {times[k]:g} s; times "
            f"must increase: correct them (--times), or delete one (`zebro-lab annotate --delete`)"
        )
    _require_definite(spread)
    return times, measured, spread


def _require_definite(spread: Array) -> None:
    """Raise `PathError` for the first covariance that is not positive definite.

    Their correlations are tested, since metres and radians have no common scale.
    """
    sd = np.sqrt(np.maximum(np.diagonal(spread, axis1=1, axis2=2), 0.0))
    unit = np.where(sd > 0, sd, 1.0)
    scaled = spread / (unit[:, :, None] * unit[:, None, :])
    bad = np.flatnonzero(~(np.linalg.eigvalsh(scaled)[:, 0] > 1e-12))
    if bad.size:
        k = int(bad[0])
        raise PathError(
            f"the covariance of pose {k + 1} is not positive definite (standard deviations "
            f"{sd[k, 0]:.3g} m, {sd[k, 1]:.3g} m, {sd[k, 2]:.3g} rad); expected above 0 in every "
            "direction"
        )


def _segments(times: Array, gap: float | None) -> NDArray[np.int64]:
    """Number the segments, which intervals longer than `gap` separate, shape (n,).

    Without a `gap` it is 3.5 times the median interval.
    """
    intervals = np.diff(times)
    if intervals.size == 0:
        return np.zeros(len(times), dtype=np.int64)
    longest = 3.5 * float(np.median(intervals)) if gap is None else gap
    return np.concatenate(([0], np.cumsum(intervals > longest))).astype(np.int64)


def _estimated(problem: ChainProblem, near: Process | None, average: bool) -> Process:
    """Estimate the noise densities by marginal likelihood, with a wide prior.

    Of each segment the first `_LONGEST_SEARCH` poses are used; segments of one or two poses are
    not. Without a segment of three poses the densities are 1e-3 m²/s³ and 1e-2 rad²/s³.

    The likeliest densities are searched from `near`, or from a walking robot's if it is None. With
    `average`, each is replaced by the mean of its standard deviation over the posterior along
    `_AROUND`, the other two held at their likeliest.
    """
    used = [part.head(_LONGEST_SEARCH) for part in problem.parts if len(part.times) > 2]
    if not used:
        return Process(1e-3, 1e-2)
    searched = ChainProblem(used, problem.known)
    point = [searched.start()]

    def minus_log_likelihood(logs: Array) -> float:
        """Return minus the log posterior of the logarithms (3,) of a `Process`.

        Infinite where the normal equations are not positive definite.
        """
        # A wide prior around a walking robot's values keeps a path that shows no disturbance
        # at all (all its scatter is measurement noise) from sending them to zero.
        prior = 0.5 * float(np.sum(((logs - np.log(_USUAL)) / _USUAL_SD) ** 2))
        process = Process(*(float(q) for q in np.exp(logs)))
        try:
            fitted = searched.fit(process, point[0])
        except np.linalg.LinAlgError:
            return np.inf  # far from any walk: densities that numbers cannot hold
        point[0] = fitted.point
        return prior - fitted.log_likelihood

    start, reach = (np.log(_USUAL), 2.0) if near is None else (np.log(near), 0.4)
    simplex = start + reach * np.vstack((np.zeros(3), np.diag([1.0, 1.0, -0.5])))
    options = {"xatol": 0.05, "fatol": 0.05, "maxfev": 120, "initial_simplex": simplex}
    fit = minimize(minus_log_likelihood, start, method="Nelder-Mead", options=options)
    if not average:
        return Process(*np.exp(fit.x).tolist())
    means = []
    for axis in np.eye(3):  # given the others at their likeliest
        costs = np.array([minus_log_likelihood(fit.x + log * axis) for log in _AROUND])
        weights = np.exp(costs.min() - costs)
        power = _OF_SD @ axis
        means.append((weights @ np.exp(power * _AROUND) / np.sum(weights)) ** (1 / power))
    return Process(*(np.exp(fit.x) * means).tolist())
