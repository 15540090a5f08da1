# SPDX-License-Identifier: MIT
"""Estimate of the noise of measured leg angles."""

import numpy as np

from model.slip.law import Array

ORDERS = (2, 4, 6, 8)  # of differences: they vanish for polynomials of a lower degree
MEDIAN = 0.6745  # median size of a standard normal variable
SEEN = (
    7e-5  # rad: less is left in the angles, it hardly moves a path; rounding to 4 decimals is less
)


def find_noise(t: Array, theta: Array) -> Array | None:
    """Estimate the standard deviation of white noise of each leg's angles.

    Differences of neighbouring samples, divided by their times, vanish where a leg turns evenly,
    and are small where it turns smoothly. Their median is not affected by the corners of its
    motion, unless these are in every other difference. Of several orders the least is taken: low
    orders meet few corners, high ones see through accelerations.

    Args:
        t: Times, strictly increasing, shape (n,) [s].
        theta: Unwrapped angles, shape (n, legs) [rad].

    Returns:
        Standard deviation of each leg's noise, shape (legs,) [rad]; None if the samples are too
        few to tell, or if that of no leg reaches `SEEN`.

    >>> t = np.arange(0.0, 5.0, 0.01)
    >>> noise = np.random.default_rng(0).normal(0.0, 5e-4, (500, 1))
    >>> find_noise(t, t[:, None] + noise).round(4)
    array([0.0005])
    """
    if len(t) <= 2 * max(ORDERS):
        return None
    sizes = np.stack([_size(t, theta, order) for order in ORDERS]).min(axis=0)
    return sizes if sizes.max() >= SEEN else None


def _size(t: Array, theta: Array, order: int) -> Array:
    """Return the noise's standard deviation by the median of divided differences, (legs,) [rad]."""
    near = np.lib.stride_tricks.sliding_window_view(t, order + 1)
    near = (near - near[:, :1]) / (near[:, -1:] - near[:, :1])
    apart = near[:, :, None] - near[:, None, :] + np.eye(order + 1)
    weights = 1 / apart.prod(axis=2)
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    angles = np.lib.stride_tricks.sliding_window_view(theta, order + 1, axis=0)
    return np.median(np.abs(np.einsum("nk,nlk->nl", weights, angles)), axis=0) / MEDIAN
