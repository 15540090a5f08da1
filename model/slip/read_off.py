# SPDX-License-Identifier: MIT
"""Read the Magic Formula's coefficients off a slip curve, from features or by least squares."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.errors import DomainError
from model.slip.magic_formula import curvature_from_peak, magic_formula
from model.slip.sampled_curve import fitted_coefficients

_UNSETTLED = 0.05  # of the peak: largest drop that may remain at the end of a curve
_RISE_TERMS = 3  # kappa, kappa³, kappa⁵: the slope is then within 0.1 % up to half the peak


@dataclass(frozen=True)
class CurveFeatures:
    """Features of a slip curve at one load, Fig. 4-5: peak, asymptote and initial slope.

    Attributes:
        peak_force: D, greatest force [N].
        peak_slip: x_m, slip ratio of the greatest force [-].
        asymptote: y_a, force towards infinite slip [N].
        slope: H, slope at zero slip [N].
    """

    peak_force: float
    peak_slip: float
    asymptote: float
    slope: float


@dataclass(frozen=True)
class Coefficients:
    """Plain coefficients of the Magic Formula at one load.

    Attributes:
        B: Stiffness factor [-].
        C: Shape factor [-].
        D: Peak force [N].
        E: Curvature factor [-].
    """

    B: float
    C: float
    D: float
    E: float


@dataclass(frozen=True)
class ReadOff(Coefficients):
    """Coefficients read off a slip curve, with how they were found and how well they describe it.

    Attributes:
        method: "features" for Eq. (4-25) to (4-27), "least squares" where the rise has too few
            samples for its slope.
        misfit: Root-mean-square difference of samples and formula [N].
        errors: Standard errors of B, C, D and E from the scatter about the formula, by least
            squares; None for features. Infinite where the samples do not determine the coefficient.
    """

    method: Literal["features", "least squares"]
    misfit: float
    errors: tuple[float, float, float, float] | None


def shape_factor(y_a: ArrayLike, D: ArrayLike, *, has_peak: bool = True) -> Array:
    r"""Compute the Magic Formula's shape factor C from peak and asymptote, Eq. (4-25).

    .. math::
        C = 1 \pm \Bigl(1 - \frac{2}{\pi} \arcsin\frac{y_a}{D}\Bigr)

    The thesis's text lost the leading 1 (Pacejka has it): without it C would be below one and the
    curve without a peak. Inverts y_a = D sin(pi C/2), which Eq. (4-23) tends to for E < 1.

    Args:
        y_a: Force towards infinite slip, from 0 to D [N].
        D: Peak force [N].
        has_peak: Whether the curve peaks (upper sign) or only rises (lower sign: D is then a
            level that it never reaches).

    Returns:
        Shape factor, in [1, 2] with a peak and in [0, 1] without [-].

    Raises:
        DomainError: The asymptote is negative or above the peak.

    >>> float(shape_factor(0.6326, 1.0).round(3))
    1.564
    """
    y_a, D = np.asarray(y_a, dtype=float), np.asarray(D, dtype=float)
    if np.any((y_a < 0) | (y_a > D)):
        raise DomainError(
            f"asymptote {y_a} N lies outside 0 to the peak, {D} N; a Magic Formula with C "
            f"between 1 and 2 settles in between: smooth the curve, or give its features by hand"
        )
    deviation = 1 - 2 / np.pi * np.arcsin(y_a / D)
    return 1 + deviation if has_peak else 1 - deviation


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


def coefficients_from_features(features: CurveFeatures) -> Coefficients:
    """Compute the Magic Formula's coefficients from a curve's features by Eq. (4-25) to (4-27).

    Args:
        features: Peak force, slip of the peak, asymptote and initial slope.

    Returns:
        B, C, D and E.

    Raises:
        DomainError: The asymptote is negative or above the peak, or the peak lies too far out for
            the other three, so that Eq. (4-27) gives E > 1 and a curve that changes sign.
    """
    D = features.peak_force
    C = float(shape_factor(features.asymptote, D))
    B = float(stiffness_factor(features.slope, C, D))
    E = float(curvature_from_peak(B, C, features.peak_slip))
    if E > 1:
        raise DomainError(
            f"curvature E = {E:.4g} exceeds 1: a peak at slip {features.peak_slip:.4g} is too far "
            f"out for B = {B:.4g} and C = {C:.4g}; check the slope at zero slip "
            f"({features.slope:.4g} N) and the asymptote ({features.asymptote:.4g} N)"
        )
    return Coefficients(B, C, D, E)


def curve_features(slip: ArrayLike, force: ArrayLike) -> CurveFeatures:
    """Estimate peak, asymptote and initial slope of a slip curve at one load from its samples.

    The samples are taken as exact: smooth a measured curve first. The peak is the vertex of the
    parabola through the highest sample and its neighbours; the slope that of an odd polynomial
    through the rise up to half the peak; the asymptote is extrapolated from the outer half of the
    slip range, where the Magic Formula falls as 1/slip.

    Args:
        slip: Slip ratio, increasing from zero or above, shape (n,) [-].
        force: Traction force, positive, shape (n,) [N].

    Returns:
        Peak force, slip of the peak, asymptote and initial slope.

    Raises:
        DomainError: The arrays are not 1-D and of one length, have fewer than two samples or one
            that is not finite, or slip is negative or not increasing; or the curve has no positive
            peak within its range, fewer than three samples beyond zero slip before it passes half
            the peak, ends before twice the peak's slip, has fewer than two samples in the outer
            half of its slip range, or ends more than 5 % of the peak away from the asymptote.
    """
    kappa, f = _as_curve(slip, force)
    x_m, D = _vertex(kappa, f)
    return CurveFeatures(D, x_m, _asymptote(kappa, f, x_m, D), _slope_of_rise(kappa, f, D))


def read_off(slip: ArrayLike, force: ArrayLike) -> ReadOff:
    """Read the Magic Formula's coefficients off the samples of a slip curve at one load.

    The thesis's method, by `curve_features` and Eq. (4-25) to (4-27), where at least three samples
    beyond zero slip lie below half the peak, which the slope at zero slip needs. A grid that is too
    coarse for that, such as the thesis's 62 slip ratios from 0 to 1, gets the formula that is
    closest to all samples by least squares: its slope is then the formula's, extrapolated.

    Args:
        slip: Slip ratio, increasing from zero or above, shape (n,) [-].
        force: Traction force, positive, shape (n,) [N].

    Returns:
        B, C, D and E, with method, misfit and standard errors.

    Raises:
        DomainError: The curve does not meet the requirements of `curve_features`, for least squares
            only those on peak and range and six samples; or its features give an asymptote outside
            0 to the peak or E > 1.
    """
    kappa, f = _as_curve(slip, force)
    x_m, D = _vertex(kappa, f)
    if len(_rise(kappa, f, D)) >= _RISE_TERMS:
        found = coefficients_from_features(curve_features(kappa, f))
        plain = (found.B, found.C, found.D, found.E)
        misfit = float(np.sqrt(np.mean((f - magic_formula(kappa, *plain)) ** 2)))
        return ReadOff(*plain, "features", misfit, None)
    _tail(kappa, x_m)
    fitted = fitted_coefficients(kappa, f)
    return ReadOff(*fitted.values, "least squares", fitted.misfit, fitted.errors)


def initial_slope(slip: ArrayLike, force: ArrayLike) -> float:
    """Estimate the slope at zero slip of a slip curve at one load from its samples [N].

    Args:
        slip: Slip ratio, increasing from zero or above, shape (n,) [-].
        force: Traction force, positive, shape (n,) [N].

    Raises:
        DomainError: The samples are no curve, or fewer than three beyond zero slip lie before half
            the largest force.
    """
    kappa, f = _as_curve(slip, force)
    return _slope_of_rise(kappa, f, float(f.max()))


def _as_curve(slip: ArrayLike, force: ArrayLike) -> tuple[Array, Array]:
    """Convert slip and force to arrays (n,); raise `DomainError` if they are no curve.

    A curve is 1-D arrays of one length, finite, of two samples or more, with slip increasing from
    zero or above.
    """
    kappa, f = np.asarray(slip, dtype=float), np.asarray(force, dtype=float)
    if kappa.ndim != 1 or kappa.shape != f.shape:
        raise DomainError(
            f"slip has shape {kappa.shape} and force {f.shape}; one curve is two arrays of "
            f"one shape (n,)"
        )
    if not (np.all(np.isfinite(kappa)) and np.all(np.isfinite(f))):
        raise DomainError("the curve has NaN or infinite samples; leave them out")
    if len(kappa) < 2 or kappa[0] < 0 or np.any(np.diff(kappa) <= 0):
        raise DomainError(
            f"found {len(kappa)} slip ratios; expected two or more, increasing from zero or above: "
            f"sort them, average repeated ones, and read the braking side off as (-slip, -force)"
        )
    return kappa, f


def _vertex(kappa: Array, f: Array) -> tuple[float, float]:
    """Return slip ratio and force [N] of the peak, of a parabola through top sample and neighbours.

    Raises `DomainError` if the top sample is the first or the last, or is not positive.
    """
    top = int(np.argmax(f))
    if top in (0, len(f) - 1) or f[top] <= 0:
        raise DomainError(
            f"no peak within slip {kappa[0]:.4g} to {kappa[-1]:.4g}: the greatest force, "
            f"{f[top]:.4g} N, is at slip {kappa[top]:.4g}; expected a positive one between other "
            f"samples: check its sign, measure beyond it, or fit a law without a peak"
        )
    around = slice(top - 1, top + 2)
    shift = kappa[around] - kappa[top]  # centred, or the parabola's terms cancel
    curvature, gradient, _ = np.polyfit(shift, f[around], 2)
    offset = -gradient / (2 * curvature)
    return float(kappa[top] + offset), float(f[top] + gradient * offset / 2)


def _rise(kappa: Array, f: Array, D: float) -> range:
    """Return the samples beyond zero slip before the first above half the peak force D [N]."""
    return range(1 if kappa[0] == 0 else 0, int(np.argmax(f > D / 2)))


def _slope_of_rise(kappa: Array, f: Array, D: float) -> float:
    """Return the slope at zero slip [N], of an odd quintic fitted up to half the peak force D.

    Raises `DomainError` for fewer than three samples there, one at zero slip not counted.
    """
    rise = _rise(kappa, f, D)
    reach = kappa[rise.stop]
    if len(rise) < _RISE_TERMS:
        raise DomainError(
            f"{len(rise)} samples between zero slip and {reach:.4g}, where the force passes half "
            f"its peak; the slope at zero slip needs {_RISE_TERMS}: measure smaller slip ratios"
        )
    odd = (kappa[rise, None] / reach) ** (2 * np.arange(_RISE_TERMS) + 1)
    return float(np.linalg.lstsq(odd, f[rise])[0][0] / reach)


def _tail(kappa: Array, x_m: float) -> NDArray[np.bool_]:
    """Return which samples lie in the outer half of the slip range, shape (n,).

    Raises `DomainError` if the curve ends before twice the peak's slip `x_m`, or has fewer than two
    samples in that half.
    """
    tail = kappa >= kappa[-1] / 2
    if kappa[-1] < 2 * x_m or np.count_nonzero(tail) < 2:
        raise DomainError(
            f"the curve ends at slip {kappa[-1]:.4g} with its peak at {x_m:.4g}: too near to see "
            f"what it falls to; measure to twice the peak's slip, two samples in the outer half"
        )
    return tail


def _asymptote(kappa: Array, f: Array, x_m: float, D: float) -> float:
    """Extrapolate the force to infinite slip [N], linearly in 1/slip from the outer half.

    Raises `DomainError` as `_tail` does, or if the curve ends more than 5 % of the peak force D
    away from the result.
    """
    tail = _tail(kappa, x_m)
    y_a = float(np.polyfit(1 / kappa[tail], f[tail], 1)[1])
    if abs(f[-1] - y_a) > _UNSETTLED * D:
        raise DomainError(
            f"asymptote not reached: at slip {kappa[-1]:.4g} the force is {f[-1]:.4g} N and heads "
            f"for {y_a:.4g} N, more than {_UNSETTLED:.0%} of the peak away; measure further out"
        )
    return y_a
