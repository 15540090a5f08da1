# SPDX-License-Identifier: MIT
"""Tails of a posterior that reach farther than the Gaussian at its mode, each with its Gaussian.

A parameter that may be nearly zero, such as the scatter of unseen slip, has a posterior with a flat
tail on one side; two parameters that make up for each other have one along a curve. Draws from the
Gaussian at the mode hardly reach these, so that importance weights of the few draws there are large
and jumps of a sampler to such draws rare. A further Gaussian in each tail mends both.
"""

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.drawing.laplace import (
    Laplace,
    LaplaceMixture,
    LogDensity,
    covariance_at,
    find_modes,
    gradients,
)

STRIDE = 1.25  # of a walk outward, in standard deviations of the Gaussian
FIRST = 2  # strides after which a tail is told from a Gaussian's
HEAVY = 1.25  # log density above the Gaussian's, both from the mode, in a heavy tail [nat]
FALLEN = 2.0  # fall of log density at which a heavy tail's Gaussian is centred [nat]
EDGE = 3.0  # coordinate, of standard normal prior, at which it is centred at the latest
LOST = 6.0  # fall of log density at which the walk has left the posterior [nat]
SHARES = (0.0, 1.0, 0.5, 0.25, 0.1)  # of a Newton step that are tried


def approximate(log_density: LogDensity, starts: Array) -> LaplaceMixture:
    """Approximate a density by Gaussians at its modes and in their heavy tails.

    Args:
        log_density: Log density of coordinates (w, d), standard normal a priori, -inf out of
            support.
        starts: Starting points of the searches for modes, shape (m, d).

    Raises:
        FitError: No start lies inside the support.
    """
    modes = find_modes(log_density, starts)
    tails = [tail for mode in modes for tail in find_tails(log_density, mode)]
    return LaplaceMixture(modes, tuple(tails))


def find_tails(log_density: LogDensity, mode: Laplace) -> tuple[Laplace, ...]:
    """Find heavy tails of a density: directions in which it falls less than the Gaussian there.

    From the mode each coordinate is moved outward to both sides, by strides of `STRIDE` standard
    deviations, and the others follow to about where the density is highest. A direction is a heavy
    tail if after `FIRST` strides the log density has fallen by less than the Gaussian's, with a
    difference above `HEAVY`. Only in these the walk goes on, until the log density has fallen by
    more than `FALLEN` or the coordinate is beyond `EDGE`.

    Args:
        log_density: Log density of coordinates (w, d), -inf out of support.
        mode: The Laplace approximation at the mode.

    Returns:
        A Gaussian where the walk in each heavy tail ended, with the covariance there; none where
        the log density has fallen by `LOST` or more. Of those within a standard deviation of each
        other, the first.
    """
    d = len(mode.mode)
    index = np.repeat(np.arange(d), 2)
    side = np.tile([-1.0, 1.0], d)
    z, height = np.tile(mode.mode, (2 * d, 1)), np.full(2 * d, mode.log_density)
    for _ in range(FIRST):
        z, height = _stride(log_density, mode, z, index, side)
    gaussian_fall = 0.5 * np.array([mode.distance(each) for each in z]) ** 2
    heavy = gaussian_fall - (mode.log_density - height) > HEAVY
    z, height, index, side = z[heavy], height[heavy], index[heavy], side[heavy]
    tails: list[Laplace] = []
    while len(z):
        coordinate = z[np.arange(len(z)), index]
        there = (mode.log_density - height > FALLEN) | (np.abs(coordinate) > EDGE)
        for at, top in zip(z[there], height[there], strict=True):
            close = any(known.distance(at) <= 1 for known in tails)
            if mode.log_density - top < LOST and not close:
                tails.append(Laplace(at, covariance_at(log_density, at), float(top)))
        z, index, side = z[~there], index[~there], side[~there]
        if len(z):
            z, height = _stride(log_density, mode, z, index, side)
    return tuple(tails)


def _stride(
    log_density: LogDensity, mode: Laplace, z: Array, index: NDArray[np.intp], side: Array
) -> tuple[Array, Array]:
    """Move one coordinate of each point outward, the others to about the highest density there.

    The one moves by `STRIDE` standard deviations and the others by their regression on it. Then the
    others alone make a damped Newton step: of the `SHARES` of a step the one is taken that leads to
    the highest density. Entries of the gradient that are not finite count as 0.

    Args:
        log_density: Log density of coordinates (w, d).
        mode: Gaussian that gives stride, regression, and the covariance of the others given the
            one, with which the Newton step is made.
        z: Points, shape (m, d).
        index: The coordinate that moves, of each point, shape (m,).
        side: Sign of its move, shape (m,).

    Returns:
        The points and the log densities there, shapes (m, d) and (m,).
    """
    C = mode.covariance
    regression = C[index] / np.sqrt(np.diag(C)[index])[:, None]
    z = z + STRIDE * side[:, None] * regression
    # The covariance of the others given the one, C - c c^T / c_i, has no part along the one.
    slopes = gradients(log_density, z)
    slopes = np.where(np.isfinite(slopes), slopes, 0.0)
    moves = slopes @ C - regression * np.sum(regression * slopes, axis=1)[:, None]
    trials = z[:, None] + moves[:, None] * np.array(SHARES)[:, None]
    heights = log_density(trials.reshape(-1, z.shape[1])).reshape(len(z), len(SHARES))
    best = np.argmax(heights, axis=1)
    rows = np.arange(len(z))
    return trials[rows, best], heights[rows, best]
