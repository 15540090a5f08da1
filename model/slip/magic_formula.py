# SPDX-License-Identifier: MIT
"""Pacejka's Magic Formula, with the peak force proportional to load."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numba.extending import register_jitable
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array, Numbers
from model.slip.law import EquationLaw, Parameter, Values


@register_jitable
def magic_formula(kappa: Numbers, B: Numbers, C: Numbers, D: Numbers, E: Numbers) -> Numbers:
    r"""Compute the traction force by Pacejka's Magic Formula, Eq. (4-23).

    .. math::
        f = D \sin\bigl(C \arctan(B\kappa - E (B\kappa - \arctan B\kappa))\bigr)

    The thesis's text lost the two pairs of brackets; its listing has them. Odd in `kappa` and
    `D`; slope B·C·D at the origin. For E <= 1 the outer arctangent's argument grows with slip, and
    up to C = 2 the curve keeps its sign; for E > 1 it turns over and changes sign at large slip.
    NaN at infinite slip unless E < 0.

    Args:
        kappa: Slip ratio [-].
        B: Stiffness factor [-].
        C: Shape factor [-].
        D: Peak force [N].
        E: Curvature factor [-].

    Returns:
        Traction force [N].

    >>> float(magic_formula(0.1, B=34.34, C=1.564, D=1.0, E=0.0).round(4))
    0.9036
    """
    Bk = B * kappa
    phi = Bk - E * (Bk - np.arctan(Bk))
    return D * np.sin(C * np.arctan(phi))


def magic_formula_slope(kappa: Array, B: Array, C: Array, D: Array, E: Array) -> Array:
    r"""Compute the derivative of `magic_formula` with respect to slip ratio [N].

    .. math::
        f' = D \cos(C \arctan\varphi)\, \frac{C}{1+\varphi^2}\, \varphi', \qquad
        \varphi' = B\Bigl(1 - E\,\frac{(B\kappa)^2}{1+(B\kappa)^2}\Bigr)

    with phi the argument of the outer arctangent in `magic_formula`.

    Args:
        kappa: Slip ratio [-].
        B: Stiffness factor [-].
        C: Shape factor [-].
        D: Peak force [N].
        E: Curvature factor [-].
    """
    Bk = B * kappa
    phi = Bk - E * (Bk - np.arctan(Bk))
    phi_slope = B * (1 - E * Bk**2 / (1 + Bk**2))
    return D * np.cos(C * np.arctan(phi)) * C / (1 + phi**2) * phi_slope


@register_jitable
def curvature_from_peak(B: Numbers, C: Numbers, x_m: Numbers) -> Numbers:
    r"""Compute the curvature factor that puts the peak at slip x_m, Eq. (4-27).

    .. math::
        E = \frac{B x_m - \tan\frac{\pi}{2C}}{B x_m - \arctan B x_m}

    Holds for C > 1 (below, the curve has no peak). E tends to minus infinity as x_m tends to 0 [-].
    E <= 1, so that x_m is the only peak, needs tan(pi/2C) >= arctan(B x_m): at every x_m only if
    C < 1.56472; the thesis's 1.564 is 0.0007 below.

    Args:
        B: Stiffness factor [-].
        C: Shape factor [-].
        x_m: Slip ratio of the peak [-].

    >>> float(curvature_from_peak(34.34, 1.564, 0.0066 * 6.63).round(3))
    -0.134
    """
    return _curvature(B * x_m, _peak_tangent(C))


@register_jitable
def _peak_tangent(C: Numbers) -> Numbers:
    """Compute tan(pi/2C), the argument of the outer arctangent at the peak [-]."""
    return np.tan(np.pi / (2 * C))


@register_jitable
def _curvature(Bx: Numbers, tangent: Numbers) -> Numbers:
    """Compute `curvature_from_peak` from B x_m and tan(pi/2C) [-]."""
    return (Bx - tangent) / _minus_arctan(Bx)


@register_jitable
def _minus_arctan(x: Numbers) -> Numbers:
    """Compute x - arctan(x), by its series where |x| < 0.01."""
    # The difference loses its digits at small x (and is zero below 1e-8, the loads of a leg about
    # to lift off), its series is exact to 3e-13 up to 0.01.
    small = np.abs(x) < 0.01
    near = small * x
    square = near * near
    series = near * square * (1 / 3 - square / 5 + square * square / 7)
    return series + (1 - small) * (x - np.arctan(x))


@register_jitable
def _at_load(load: Numbers, constants: tuple[Numbers, ...]) -> tuple[Numbers, ...]:
    """Compute B, C, mu and E at a load from `MagicFormula.constants` [-]."""
    K, C, mu, shape, tangent, a_mu, a_K, reference, peak, sensitive = constants
    if sensitive:
        ratio = load / reference
        mu = mu * ratio**a_mu
        K = K * ratio**a_K
    B = K / (C * mu)
    E = _curvature(B * (shape * load), tangent) if peak else shape
    return B, C, mu, E


@dataclass(frozen=True)
class MagicFormula(EquationLaw):
    """The Magic Formula as a slip law, with D = mu * Fn.

    Its parameters are those that data determine best: the slip stiffness K = B·C·mu (slope at zero
    slip for each newton of load) instead of B.

    Attributes:
        curvature: "peak" (E from the peak's position, which grows with load: x_m = c·Fn),
            "constant" (one E at every load), or a number, the E to keep fixed.
        load_sensitivity: Multiply mu and K by (Fn / reference_load) to powers that are further
            parameters.
        reference_load: Load at which mu and K have their parameters' values when
            `load_sensitivity` is set [N].
    """

    curvature: Literal["peak", "constant"] | float = "peak"
    load_sensitivity: bool = False
    reference_load: float = 1.0

    name = "magic-formula"
    at_load = staticmethod(_at_load)
    traction_over_load = staticmethod(magic_formula)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters in the order of `values`: K, C, mu and those of the options.

        These are x_m/Fn for the curvature "peak" or E for "constant", and a KeyError for any other
        text; then, with `load_sensitivity`, the exponents of mu and of K.
        """
        return (
            *_COMMON,
            *((_CURVATURE[self.curvature],) if isinstance(self.curvature, str) else ()),
            *(_SENSITIVITY if self.load_sensitivity else ()),
        )

    def coefficients(self, load: ArrayLike, values: Values) -> tuple[Array, Array, Array, Array]:
        """Compute the Magic Formula's coefficients B, C, D, E at a load from parameter values.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.

        Returns:
            B [-], C [-], D [N] and E [-], each broadcasting against `load` and the values.
        """
        Fn = np.asarray(load, dtype=float)
        B, C, mu, E = (np.asarray(each) for each in _at_load(Fn, self.constants(values)))
        return B, C, mu * Fn, E

    def constants(self, values: Values) -> tuple[Numbers, ...]:
        """Compute what the coefficients take besides the load.

        Args:
            values: Parameter values, one entry a parameter.

        Returns:
            K, C, mu, x_m/Fn or E, tan(pi/2C), the exponents of mu and of K, the reference load [N],
            and whether E is from the peak's position and whether mu and K vary with load.
        """
        K, C, mu = (np.asarray(value, dtype=float) for value in values[:3])
        shape = values[3] if isinstance(self.curvature, str) else self.curvature
        a_mu, a_K = values[-2:] if self.load_sensitivity else (0.0, 0.0)
        return (
            K, C, mu, np.asarray(shape, dtype=float), _peak_tangent(C),
            np.asarray(a_mu), np.asarray(a_K), self.reference_load,
            self.curvature == "peak", self.load_sensitivity,
        )  # fmt: skip

    def slip_derivative(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the derivative of the force with respect to slip ratio [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return magic_formula_slope(np.asarray(slip), *self.coefficients(load, values))

    def valid(self, load: ArrayLike, values: Values) -> NDArray[np.bool_]:
        """Return where E <= 1, so that the curve has one peak and keeps its sign.

        The result has the shape of E: of the values alone, or (), unless E depends on load.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return self.coefficients(load, values)[3] <= 1.0

    def peak_slip(self, load: ArrayLike, values: Values) -> Array:
        """Compute the slip ratio at which the force peaks, infinite without a peak [-].

        There is none for C <= 1, and for E = 1 with a small C; see the function `peak_slip`.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        B, C, _, E = self.coefficients(load, values)
        if self.curvature == "peak":  # given, and E from it
            x_m = np.asarray(values[3]) * np.asarray(load, dtype=float)
            return np.where(np.broadcast_to(C, E.shape) > 1, x_m, np.inf)
        return peak_slip(B, C, E)


def peak_slip(B: ArrayLike, C: ArrayLike, E: ArrayLike) -> Array:
    r"""Compute the slip ratio of the Magic Formula's peak, the inverse of Eq. (4-27) [-].

    Solves Bx - E (Bx - arctan Bx) = tan(pi/2C) by bisection, since the left side grows with x for
    E <= 1; for E > 1 the result has no meaning. Infinite where C <= 1, where E = 1 keeps the left
    side below the right, and where Bx would exceed 1e9.

    Args:
        B: Stiffness factor [-].
        C: Shape factor [-].
        E: Curvature factor [-].

    >>> float(peak_slip(34.34, 1.564, -0.1344).round(4))
    0.0438
    """
    B, C, E = np.broadcast_arrays(*(np.asarray(a, dtype=float) for a in (B, C, E)))
    with np.errstate(invalid="ignore", divide="ignore"):
        target = np.where(C > 1, np.tan(np.pi / (2 * C)), np.inf)
    low, high = np.zeros_like(target), np.full_like(target, 1e9)
    for _ in range(120):  # halves in the logarithm and in the value: to the last bit from 1e9
        middle = np.where(low > 0, np.sqrt(low * high), np.minimum(high * 1e-3, 1.0))
        below = middle - E * (middle - np.arctan(middle)) < target
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(high >= 1e9, np.inf, high) / B


_COMMON = (
    Parameter("slip_stiffness", "K", "dimensionless", 0.0, math.inf,
              "slope of traction over load at zero slip, B·C·mu", (10.0, 1.5)),
    Parameter("shape", "C", "dimensionless", 1.0, 2.0,
              "shape factor: how far the curve falls behind its peak"),
    Parameter("friction", "mu", "dimensionless", 0.0, math.inf,
              "peak traction over load, D / Fn", (0.6, 0.7)),
)  # fmt: skip
_CURVATURE = {
    "peak": Parameter("peak_slip_per_load", "x_m/Fn", "1/newton", 0.0, math.inf,
                      "slip ratio of the peak for each newton of load"),
    "constant": Parameter("curvature", "E", "dimensionless", -math.inf, 1.0,
                          "curvature factor: how sharp the peak is", (1.0, 1.0)),
}  # fmt: skip
_SENSITIVITY = (
    Parameter("friction_load_exponent", "a_mu", "dimensionless", -math.inf, math.inf,
              "friction grows with load to this power", (0.0, 0.2)),
    Parameter("stiffness_load_exponent", "a_K", "dimensionless", -math.inf, math.inf,
              "slip stiffness grows with load to this power", (0.0, 0.3)),
)  # fmt: skip
