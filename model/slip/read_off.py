# SPDX-License-Identifier: MIT
"""Read the Magic Formula's coefficients off a slip curve: by its features, then least squares."""

import warnings
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.errors import DomainError
from model.slip.magic_formula import curvature_from_peak, magic_formula

FEWEST_SAMPLES: Final = 6
"""Samples that four coefficients and a misfit need."""
_RISE_TERMS = 3  # kappa, kappa³, kappa⁵: the slope is then within 0.1 % up to half the peak
_STEEPER = (1.0, 2.0, 5.0)  # starts: slope at zero slip over the steepest of origin to sample
_MOST_CURVATURE = 0.9  # starts: largest E
_BOUNDS = ([0.0, 1.0, 0.0, -np.inf], [np.inf, 2.0, np.inf, 1.0])  # one peak, and one sign


@dataclass(frozen=True)
class ReadOff:
    """Plain coefficients of the Magic Formula at one load, read off a slip curve.

    Attributes:
        B: Stiffness factor [-].
        C: Shape factor [-].
        D: Peak force [N].
        E: Curvature factor [-].
        errors: Standard errors of B, C, D and E from the scatter about the formula; infinite where
            the samples do not determine them.
        misfit: Root-mean-square difference of samples and formula [N].
    """

    B: float
    C: float
    D: float
    E: float
    errors: tuple[float, ...]
    misfit: float


def shape_factor(y_a: ArrayLike, D: ArrayLike) -> Array:
    r"""Compute the Magic Formula's shape factor C from peak and asymptote, Eq. (4-25).

    .. math::
        C = 1 + \Bigl(1 - \frac{2}{\pi} \arcsin\frac{y_a}{D}\Bigr)

    The thesis's text lost the leading 1 (Pacejka has it): without it C would be below one and the
    curve without a peak. Inverts y_a = D sin(pi C/2), which Eq. (4-23) tends to for E < 1.

    Args:
        y_a: Force towards infinite slip, from 0 to D [N].
        D: Peak force [N].

    Returns:
        Shape factor, in [1, 2] [-].

    >>> float(shape_factor(0.6326, 1.0).round(3))
    1.564
    """
    return 2 - 2 / np.pi * np.arcsin(np.asarray(y_a, dtype=float) / np.asarray(D, dtype=float))


def stiffness_factor(H: ArrayLike, C: ArrayLike, D: ArrayLike) -> Array:
    r"""Compute the Magic Formula's stiffness factor B from the slope at zero slip, Eq. (4-26).

    .. math::
        B = \frac{H}{C D}

    Args:
        H: Slope of the force at zero slip [N].
        C: Shape factor [-].
        D: Peak force [N].

    Returns:
        Stiffness factor B [-].
    """
    return np.asarray(H, dtype=float) / (np.asarray(C) * np.asarray(D))


def read_off(slip: ArrayLike, force: ArrayLike) -> ReadOff:
    """Read the Magic Formula's coefficients off the samples of a slip curve at one load.

    Peak, asymptote and slope at zero slip give coefficients by Eq. (4-25) to (4-27), from which
    least squares over all samples start, since a grid such as the thesis's 62 slip ratios from 0 to
    1 has too few samples on the rise for its slope.

    Args:
        slip: Slip ratio, increasing from zero or above, shape (n,) [-].
        force: Traction force, positive, shape (n,) [N].

    Raises:
        DomainError: The arrays are no curve of `FEWEST_SAMPLES` or more, have no positive peak
            inside their range, or end before twice the peak's slip.
        RuntimeError: Least squares did not converge (raised by scipy).
    """
    kappa, f = _as_curve(slip, force)
    top = int(np.argmax(f))
    x_m, D = float(kappa[top]), float(f[top])
    if top in (0, len(f) - 1) or D <= 0:
        raise DomainError(
            f"no peak within slip {kappa[0]:.4g} to {kappa[-1]:.4g}: the greatest force, "
            f"{D:.4g} N, is at slip {x_m:.4g}; expected a positive one between other "
            "samples: check its sign, measure beyond it, or fit a law without a peak"
        )
    if kappa[-1] < 2 * x_m:
        raise DomainError(
            f"the curve ends at slip {kappa[-1]:.4g} with its peak at {x_m:.4g}: too near to see "
            "what it falls to; measure to twice the peak's slip"
        )
    if len(f) < FEWEST_SAMPLES:
        raise DomainError(
            f"{len(f)} samples of a curve; four coefficients need {FEWEST_SAMPLES} or more"
        )
    fits = [_least_squares(kappa, f / D, start) for start in _starts(kappa, f / D)]
    (best, covariance), misfit = min(fits, key=lambda fit: fit[1])
    scale = np.array([1.0, 1.0, D, 1.0])
    errors = scale * np.sqrt(np.diag(covariance))
    B, C, D, E = (best * scale).tolist()
    return ReadOff(B, C, D, E, tuple(errors.tolist()), float(f.max()) * misfit)


def _least_squares(
    kappa: Array, f: Array, start: tuple[float, float, float, float]
) -> tuple[tuple[Array, Array], float]:
    """Fit B, C, D and E by least squares from one start, within `_BOUNDS`.

    Args:
        kappa: Slip ratios, shape (n,) [-].
        f: Force over its largest, shape (n,) [-].
        start: B, C, D and E to start from.

    Returns:
        The coefficients with their covariance, and the root-mean-square residual [-].

    Raises:
        RuntimeError: Least squares did not converge (raised by scipy).
    """
    from scipy.optimize import OptimizeWarning, curve_fit

    with warnings.catch_warnings():  # of a covariance that samples do not tell: it is infinite then
        warnings.simplefilter("ignore", OptimizeWarning)
        found = curve_fit(
            magic_formula, kappa, f, start, bounds=_BOUNDS, x_scale="jac", ftol=1e-14, xtol=1e-12,
            gtol=1e-14, max_nfev=2000,
        )  # fmt: skip
    return found, float(np.sqrt(np.mean((f - magic_formula(kappa, *found[0])) ** 2)))


def _starts(kappa: Array, f: Array) -> list[tuple[float, float, float, float]]:
    """Return starting values of B, C, D and E by Eq. (4-25) to (4-27), one set for each slope.

    Samples may be too sparse for the slope at zero slip, so `_STEEPER` times that of the steepest
    line from the origin to a sample are tried.

    Args:
        kappa: Slip ratios, shape (n,) [-].
        f: Force over its largest, shape (n,) [-].
    """
    C = float(np.clip(shape_factor(np.clip(f[-1], 0.0, 1.0), 1.0), 1.05, 1.95))
    x_m, rising = float(kappa[np.argmax(f)]), kappa > 0
    slope = float(np.max(f[rising] / kappa[rising]))
    starts = []
    for H in (slope * steeper for steeper in _STEEPER):
        B = float(stiffness_factor(H, C, 1.0))
        E = min(float(curvature_from_peak(B, C, x_m)), _MOST_CURVATURE)
        starts.append((B, C, 1.0, E))
    return starts


def initial_slope(slip: ArrayLike, force: ArrayLike) -> float:
    """Estimate the slope at zero slip of a slip curve at one load [N].

    It is that of an odd quintic fitted to the samples up to half the largest force.

    Args:
        slip: Slip ratio, increasing from zero or above, shape (n,) [-].
        force: Traction force, positive, shape (n,) [N].

    Raises:
        DomainError: The samples are no curve, or fewer than three beyond zero slip lie before half
            the largest force.
    """
    kappa, f = _as_curve(slip, force)
    rise = slice(int(kappa[0] == 0), int(np.argmax(f > f.max() / 2)))
    x, reach = kappa[rise], kappa[rise.stop]
    if len(x) < _RISE_TERMS:
        raise DomainError(
            f"{len(x)} samples between zero slip and {reach:.4g}, where the force passes half its "
            f"peak; the slope at zero slip needs {_RISE_TERMS}: measure smaller slip ratios"
        )
    odd = (x[:, None] / reach) ** (2 * np.arange(_RISE_TERMS) + 1)
    return float(np.linalg.lstsq(odd, f[rise])[0][0] / reach)


def _as_curve(slip: ArrayLike, force: ArrayLike) -> tuple[Array, Array]:
    """Convert slip and force to arrays (n,); raise `DomainError` if they are no curve.

    A curve is 1-D arrays of one length, finite, of two samples or more, with slip increasing from
    zero or above.
    """
    kappa, f = np.asarray(slip, dtype=float), np.asarray(force, dtype=float)
    if kappa.ndim != 1 or kappa.shape != f.shape:
        raise DomainError(
            f"slip has shape {kappa.shape} and force {f.shape}; one curve is two arrays of "
            "one shape (n,)"
        )
    if not (np.all(np.isfinite(kappa)) and np.all(np.isfinite(f))):
        raise DomainError("the curve has NaN or infinite samples; leave them out")
    if len(kappa) < 2 or kappa[0] < 0 or np.any(np.diff(kappa) <= 0):
        raise DomainError(
            f"found {len(kappa)} slip ratios; expected two or more, increasing from zero or above: "
            "sort them, average repeated ones, and read the braking side off as (-slip, -force)"
        )
    return kappa, f
