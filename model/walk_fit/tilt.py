# SPDX-License-Identifier: MIT
r"""Residuals of roll and pitch against an IMU, to identify a leg offset where a path cannot.

A leg with an offset lifts or lowers its corner of the body while it carries load. Several legs bend
a path alike, but no two legs tilt the body alike at the same time of a stride. Means over intervals
k of 0.1 s, predicted and measured, are compared without their constant part, which depends on how
the IMU is mounted,

.. math::
    r = \frac{(\hat a_k - \bar{\hat a}) - (a_k - \bar a)}{\sigma \sqrt{S}} .

The model's error is the same in each of the S strides, so all strides together count as one.
"""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.errors import InsufficientData
from model.format_distinct import format_distinct
from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference

# Standard deviation of an IMU's means [rad]. The model errs by 0.02 degrees where a tripod carries,
# by 0.5 where four legs do.
SD = np.radians(0.3)
TIME = 0.1  # s, length of the intervals over which angles are averaged
FEWEST = 10  # least number of intervals with samples of both walk and IMU


@dataclass(frozen=True)
class MeasuredTilt:
    """Roll and pitch as a walk's IMU measured them.

    Attributes:
        t: Times by the leg log's clock, increasing, shape (m,) [s].
        angles: Roll and pitch, shape (m, 2) [rad].
    """

    t: Array
    angles: Array


@dataclass(frozen=True)
class TiltMisfit:
    """Roll and pitch of an IMU, averaged over k intervals for comparison with paths.

    Intervals of `TIME` without samples of both are left out.

    Attributes:
        mean: Matrix that averages a path's n samples over the intervals, shape (k, n).
        measured: Measured roll and pitch averaged over each interval, minus their mean over all
            intervals, shape (k, 2) [rad].
        strides: Number of strides walked, at least 1.
    """

    mean: Array
    measured: Array
    strides: float

    @classmethod
    def of(cls, seen: MeasuredTilt, t: Array, legs: LegReference | InexactLog) -> "TiltMisfit":
        """Average measured roll and pitch over the intervals that have samples of path and IMU.

        Args:
            seen: Measured roll and pitch.
            t: Times of the paths' samples, shape (n,) [s].
            legs: Leg angles, from which strides are counted.

        Raises:
            InsufficientData: IMU and walk share fewer than `FEWEST` intervals.
        """
        k = int(np.floor(t[-1] / TIME)) + 1
        path, imu = _means(t, k), _means(seen.t, k)
        shared = path.any(axis=1) & imu.any(axis=1)
        if shared.sum() < FEWEST:
            first, last, start, end = format_distinct(*seen.t[[0, -1]], *t[[0, -1]])
            raise InsufficientData(
                f"IMU, {first} to {last} s, and walk, {start} to {end} s, share "
                f"samples in {shared.sum()} intervals of {TIME:g} s; expected {FEWEST} or more"
            )
        measured = imu[shared] @ seen.angles
        return cls(path[shared], measured - measured.mean(axis=0), _strides(legs, t))

    @property
    def count(self) -> float:
        """Effective number of independent residuals: those of one stride [-]."""
        return 2 * len(self.measured) / self.strides

    def residuals(self, tilt: Array) -> Array:
        """Compute residuals (m, 2 k) [-], predicted minus measured, of m paths.

        Predicted and measured means over the intervals are without their mean over all intervals;
        the difference is divided by `SD` times the root of the number of strides.

        Args:
            tilt: Roll and pitch of the paths, shape (m, n, 2) [rad].
        """
        predicted = self.mean @ tilt
        away = predicted - predicted.mean(axis=1, keepdims=True) - self.measured
        return (away / (SD * np.sqrt(self.strides))).reshape(len(tilt), -1)


def _means(t: Array, k: int) -> Array:
    """Return the matrix (k, n) that averages samples at times t (n,) over k intervals of `TIME`.

    Intervals start at time zero; the row of an interval without samples is zero.
    """
    within = np.floor(t / TIME + 1e-9).astype(int) == np.arange(k)[:, None]
    return within / np.maximum(within.sum(axis=1, keepdims=True), 1)


def _strides(legs: LegReference | InexactLog, t: Array) -> float:
    """Compute the legs' turns between the first and last time, averaged over legs; at least 1."""
    angles = legs.smooth() if isinstance(legs, InexactLog) else legs
    first, last = angles.angles(t[[0, -1]])
    return max(float(np.abs(last - first).mean()) / (2 * np.pi), 1.0)
