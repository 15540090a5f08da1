# SPDX-License-Identifier: MIT
"""Errors of roll and pitch of a walk against an IMU's."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.errors import InsufficientData

FEWEST = 10  # least number of measurements within the walk


@dataclass(frozen=True)
class TiltErrors:
    """Errors, predicted minus measured, of roll and pitch; arrays of shape (2,), roll first [rad].

    Attributes:
        samples: Number of measurements compared.
        bias: Mean error, of which the IMU's mounting angle is a part.
        rms: Root mean square error, bias included.
        rms_unbiased: Root mean square error after subtraction of the bias.
        swing: Standard deviation of the measured angles over time, to compare errors with.
    """

    samples: int
    bias: Array
    rms: Array
    rms_unbiased: Array
    swing: Array


def tilt_errors(
    t: Array, predicted: Array, measured_t: Array, measured: Array
) -> tuple[TiltErrors, NDArray[np.bool_]]:
    """Compute errors of predicted roll and pitch at the measurements' times within the walk.

    Args:
        t: Times of the walk, increasing, shape (n,) [s].
        predicted: Predicted roll and pitch, interpolated linearly, shape (n, 2) [rad].
        measured_t: Times of the measurements, shape (m,) [s].
        measured: Measured roll and pitch, shape (m, 2) [rad].

    Returns:
        The errors, and whether each measurement was compared, shape (m,).

    Raises:
        InsufficientData: Fewer than ten measurements lie within the walk's times.
    """
    inside = (measured_t >= t[0]) & (measured_t <= t[-1])
    if inside.sum() < FEWEST:
        raise InsufficientData(
            f"{inside.sum()} of {len(measured_t)} measured tilts lie within the walk's {t[0]:g} to "
            f"{t[-1]:g} s; {FEWEST} are needed: do both keep the same clock?"
        )
    at = measured_t[inside]
    at_measured = np.column_stack([np.interp(at, t, column) for column in predicted.T])
    difference = at_measured - measured[inside]
    bias = difference.mean(axis=0)
    return TiltErrors(
        samples=int(inside.sum()),
        bias=bias,
        rms=np.sqrt(np.mean(difference**2, axis=0)),
        rms_unbiased=difference.std(axis=0),
        swing=measured[inside].std(axis=0),
    ), inside
