# SPDX-License-Identifier: MIT
"""Resolution of measured leg angles: the angle of one count, or their noise."""

import numpy as np

from model.arrays import Array

LARGEST_STEP = np.radians(10.0)  # of one count
SMALLEST_STEP = 1.5e-4  # rad, 42,000 counts a turn: finer ones move a radius by 0.1 %
# rad: angles no further apart may be of one count; of two, angles rounded to 4 decimals are
UNCHANGED = (0.9e-4, 1e-3)
FEWEST_CHANGES = 8  # of count, to estimate the angle of one count
MOST_COUNTS = 30  # of a change that tells whether angles are whole counts
ORDERS = (2, 4, 6, 8)  # of differences: they vanish for polynomials of a lower degree
MEDIAN = 0.6745  # median size of a standard normal variable
SEEN = 7e-5  # rad: less hardly moves a path, and is left in the angles, as rounding to 4 decimals
LARGEST_NOISE = np.radians(1.0)  # more is motion between samples that are too far apart
AGREE = 2.3  # times the least of all orders: the second of white noise is no larger
HELD = 0.05  # of all samples begin to repeat, where angles come less often than the log is written


def find_noise(t: Array, theta: Array, step: float = 0.0) -> Array | None:
    """Estimate the standard deviation of white noise of each leg's angles.

    Differences of neighbouring samples, divided by their times, vanish where a leg turns evenly,
    and are small where it turns smoothly. Their median is not affected by the corners of its
    motion, unless these are in every other difference. Of several orders the least is taken: low
    orders meet few corners, high ones see through accelerations. White noise has the same size in
    all orders that see through the motion, so two must agree, or the samples are too far apart.

    Args:
        t: Times, strictly increasing, shape (n,) [s].
        theta: Unwrapped angles, shape (n, legs) [rad].
        step: Angle of one count, whose noise may exceed `LARGEST_NOISE`; zero if not counted [rad].

    Returns:
        Standard deviation of each leg's noise, shape (legs,) [rad]; None if the samples are too
        few to tell, or if that of no leg reaches `SEEN`. It is nan of a leg whose samples are too
        far apart, or repeat too often, to tell noise from motion.

    >>> t = np.arange(0.0, 5.0, 0.01)
    >>> noise = np.random.default_rng(0).normal(0.0, 5e-4, (500, 1))
    >>> find_noise(t, t[:, None] + noise).round(4)
    array([0.0005])
    """
    if len(t) <= 2 * max(ORDERS):
        return None
    least, second = np.sort([_size(t, theta, order) for order in ORDERS], axis=0)[:2]
    if least.max() < SEEN:
        return None
    told = (second <= AGREE * least) & (least <= max(LARGEST_NOISE, step))
    if not step:
        told &= not _held(theta)
    return np.where(told | (least < SEEN), least, np.nan)


def _held(theta: Array) -> bool:
    """Return whether angles come less often than the log is written.

    Then all legs repeat theirs: at more than `HELD` of the samples a repetition begins.
    """
    still = ~np.any(np.diff(theta, axis=0), axis=1)
    return bool((still[1:] & ~still[:-1]).mean() > HELD)


def _size(t: Array, theta: Array, order: int) -> Array:
    """Estimate each leg's noise from its divided differences of one order, shape (legs,) [rad].

    Each is scaled to have the noise's standard deviation, which is then the median of their sizes
    over `MEDIAN`; they vanish where the motion is a polynomial of lower degree.
    """
    near = np.lib.stride_tricks.sliding_window_view(t, order + 1)
    near = (near - near[:, :1]) / (near[:, -1:] - near[:, :1])
    apart = near[:, :, None] - near[:, None, :] + np.eye(order + 1)
    weights = 1 / apart.prod(axis=2)
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    angles = np.lib.stride_tricks.sliding_window_view(theta, order + 1, axis=0)
    return np.median(np.abs(np.einsum("nk,nlk->nl", weights, angles)), axis=0) / MEDIAN


def find_step(theta: Array) -> float | None:
    """Estimate the angle of one count from changes that differ by it from those on either side.

    A leg of constant speed changes by n or n + 1 counts from sample to sample, and the rarer of the
    two always stands alone. Angles that are not counted have no such changes.

    Args:
        theta: Unwrapped angles, shape (n, legs) [rad].

    Returns:
        The step [rad]; None with fewer than 8 such changes, if 2 % or more of all changes of up to
        `MOST_COUNTS` counts are no multiple, or if the step is not between `SMALLEST_STEP` and 10
        degrees. A multiple may be off by 2 %, by a tenth of a count at most, and by a twentieth in
        any case: for angles that were rounded when they were printed.

    >>> counted = np.radians(3.6) * np.arange(0.0, 20.0, 0.4).round()[:, None]
    >>> float(np.degrees(find_step(counted)).round(3))
    3.6
    """
    change = np.diff(theta, axis=0)
    more = np.abs(change[1:-1] - change[:-2])
    alone = np.abs(change[2:] - change[:-2]) < 0.2 * more
    for least in UNCHANGED:
        single = more[alone & (more > least)]
        step = _common_step(single, np.abs(change)) if len(single) >= FEWEST_CHANGES else None
        if step is not None and SMALLEST_STEP < step < LARGEST_STEP:
            return step
    return None


def _common_step(single: Array, change: Array) -> float | None:
    """Fit the step of which changes are whole multiples; None if 2 % of them or more are not [rad].

    Args:
        single: Changes that should be of one count, from whose median the fit starts [rad].
        change: All changes from sample to sample, without their sign [rad].
    """
    step = float(np.median(single))
    for most in (1.5, 10.5, MOST_COUNTS):  # counts, of which the step is known ever better
        few = change[(0.5 * step < change) & (change < most * step)]
        few = np.append(few, single[single < 1.5 * step])
        counts = np.maximum((few / step).round(), 1.0)
        step = float(few @ counts / (counts @ counts))
    counts = change[change < MOST_COUNTS * step] / step
    counts = np.append(counts[counts > 0.1], single / step)
    whole = np.abs(counts - counts.round()) < np.clip(0.02 * counts, 0.05, 0.1)
    # Almost no difference of a leg that turns freely would be a multiple of another.
    return step if whole.mean() > 0.98 else None
