# SPDX-License-Identifier: MIT
"""Magic Formula through the samples of a slip curve at one load, by least squares."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import least_squares
from scipy.special import expit

from model.arrays import Array
from model.errors import DomainError
from model.slip.magic_formula import curvature_from_peak, magic_formula

FEWEST_SAMPLES: Final = 6
"""Samples that four coefficients and a misfit need."""
_STEEPNESS = (0.5, 2.0, 5.0)  # B times the slip of the largest sample, of the starts
_SHAPES = (1.3, 1.7)  # C of the starts
_MOST_CURVATURE = 0.9  # E of a start
_UNKNOWN = 1e-8  # ratio of singular values, below which differences of residuals are rounding


@dataclass(frozen=True)
class FittedCoefficients:
    """Magic Formula that is closest to the samples of a curve.

    Attributes:
        values: B [-], C [-], D [N] and E [-].
        errors: Their standard errors from the scatter about the formula; infinite where the samples
            do not determine one.
        misfit: Root-mean-square difference of samples and formula [N].
    """

    values: tuple[float, float, float, float]
    errors: tuple[float, float, float, float]
    misfit: float


def fitted_coefficients(kappa: Array, force: Array) -> FittedCoefficients:
    """Fit B, C, D and E of the Magic Formula to samples by least squares, from several starts.

    B and D are positive, C lies between 1 and 2 and E below 1, so that the curve has one peak. All
    samples weigh the same, and their errors are taken as independent for the standard errors.

    Args:
        kappa: Slip ratios, increasing from zero or above, shape (n,) [-].
        force: Traction force, with its largest sample inside the range, shape (n,) [N].

    Raises:
        DomainError: There are fewer than `FEWEST_SAMPLES`.
    """
    if len(kappa) < FEWEST_SAMPLES:
        raise DomainError(
            f"{len(kappa)} samples of a curve; four coefficients need {FEWEST_SAMPLES} or more"
        )
    scale = float(force.max())

    def residual(free: Array) -> Array:
        B, C, D, E = _coefficients(free)
        return magic_formula(kappa, B, C, D * scale, E) / scale - force / scale

    fits = [
        least_squares(residual, start, xtol=1e-12, ftol=1e-14, gtol=1e-14, max_nfev=2000)
        for start in _starts(float(kappa[np.argmax(force)]))
    ]
    best = min(fits, key=lambda fit: fit.cost)
    B, C, D, E = (float(x) for x in _coefficients(best.x))
    variance = 2 * best.cost / (len(kappa) - 4)
    slopes = np.array([B, (C - 1) * (2 - C), D * scale, 1 - E])  # of values over free coordinates
    errors = slopes * _standard_errors(np.asarray(best.jac), variance)
    misfit = scale * float(np.sqrt(2 * best.cost / len(kappa)))
    first, second, third, fourth = (float(x) for x in errors)
    return FittedCoefficients((B, C, D * scale, E), (first, second, third, fourth), misfit)


def _coefficients(free: Array) -> tuple[Array, Array, Array, Array]:
    """Map four unbounded coordinates to B, C, D and E: log B, logit (C - 1), log D, log (1 - E)."""
    b, c, d, e = free
    return np.exp(b), 1 + expit(c), np.exp(d), 1 - np.exp(e)


def _starts(top: float) -> list[Array]:
    """Return starting points of the search for a curve with its largest sample at slip `top`."""
    starts = []
    for steepness in _STEEPNESS:
        for C in _SHAPES:
            E = min(float(curvature_from_peak(steepness / top, C, top)), _MOST_CURVATURE)
            starts.append(
                np.array([np.log(steepness / top), np.log((C - 1) / (2 - C)), 0.0, np.log(1 - E)])
            )
    return starts


def _standard_errors(jacobian: Array, variance: float) -> Array:
    """Compute standard errors of the coordinates, shape (4,), from residuals' Jacobian (n, 4).

    Infinite for every coordinate with a share in a direction that the samples do not determine.
    """
    _, singular, rows = np.linalg.svd(jacobian, full_matrices=False)
    known = singular > _UNKNOWN * singular[0]
    errors = np.sqrt(variance * np.sum((rows[known].T / singular[known]) ** 2, axis=1))
    lost = np.any(np.abs(rows[~known]) > 1e-6, axis=0)
    return np.where(lost, np.inf, errors)
