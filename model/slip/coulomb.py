# SPDX-License-Identifier: MIT
"""Coulomb friction with a Stribeck drop from static to kinetic friction, smooth at zero slip."""

import math
from dataclasses import dataclass

import numpy as np
from numba.extending import register_jitable

from model.arrays import Array, Numbers
from model.slip.law import Parameter, Values
from model.slip.proportional import ProportionalLaw


@register_jitable
def breakaway_slip(K: Numbers, mu: Numbers) -> Numbers:
    r"""Compute the slip ratio at which static friction is fully developed.

    .. math::
        \kappa_c = \frac{3\mu}{2K}

    Args:
        K: Slip stiffness, slope of traction over load at zero slip [-].
        mu: Static friction, peak traction over load [-].

    Returns:
        Break-away slip ratio kappa_c [-].
    """
    return 1.5 * mu / K


@register_jitable
def regularised_sign(kappa: Numbers, kappa_c: Numbers) -> Numbers:
    r"""Compute the sign of the slip ratio, smoothed by a cubic between -kappa_c and kappa_c.

    .. math::
        \sigma(u) = \tfrac12 (3u - u^3), \qquad u = \kappa/\kappa_c \text{ clipped to } [-1, 1]

    Contact models in multibody codes rise so. The rise is complete at kappa_c, where its slope is
    zero, unlike tanh or u/sqrt(1 + u²), which only approach one and so would leave the peak of the
    law below its static friction by an amount without a closed form.

    Args:
        kappa: Slip ratio [-].
        kappa_c: Slip ratio at which the rise is complete [-].

    Returns:
        A number in [-1, 1], odd in `kappa` [-].
    """
    u = np.minimum(np.maximum(kappa / kappa_c, -1.0), 1.0)
    return 0.5 * u * (3 - u**2)


@register_jitable
def stribeck_fall(kappa: Numbers, kappa_c: Numbers, kappa_s: Numbers, q: Numbers) -> Numbers:
    r"""Compute the ratio of friction at a slip ratio to static friction (Stribeck curve).

    .. math::
        \beta(\kappa) = q + (1 - q)\,e^{-z^2}, \qquad
        z = \frac{\max(|\kappa| - \kappa_c,\ 0)}{\kappa_s}

    Args:
        kappa: Slip ratio [-].
        kappa_c: Slip ratio at which the post-peak drop begins [-].
        kappa_s: Stribeck slip, over which 63 % of the static excess is lost [-].
        q: Kinetic over static friction [-].

    Returns:
        Friction over static friction, from q to 1, even in `kappa` [-].
    """
    return q + (1 - q) * np.exp(-(_slip_past_breakaway(kappa, kappa_c, kappa_s) ** 2))


@register_jitable
def coulomb_stribeck(
    kappa: Numbers, K: Numbers, mu: Numbers, q: Numbers, kappa_s: Numbers
) -> Numbers:
    r"""Compute traction over load of Coulomb friction with a Stribeck drop, at a slip ratio.

    .. math::
        f / F_n = \mu\, \sigma(\kappa/\kappa_c)\, \beta(\kappa)

    with kappa_c of `breakaway_slip`, sigma of `regularised_sign` and beta of `stribeck_fall`. Rises
    with slope K at zero slip, peaks at mu where the slip is kappa_c, falls to q·mu. Odd, analytic
    at zero slip and once continuously differentiable everywhere.

    Args:
        kappa: Slip ratio [-].
        K: Slip stiffness, slope at zero slip [-].
        mu: Static friction, the peak [-].
        q: Kinetic over static friction; 1 gives plain Coulomb friction [-].
        kappa_s: Stribeck slip [-].

    Returns:
        Traction force over normal force [-].

    >>> float(coulomb_stribeck(0.03, K=20.0, mu=0.4, q=0.7, kappa_s=0.1))
    0.4
    >>> float(coulomb_stribeck(1.0, K=20.0, mu=0.4, q=0.7, kappa_s=0.1).round(6))
    0.28
    """
    kappa_c = breakaway_slip(K, mu)
    return mu * regularised_sign(kappa, kappa_c) * stribeck_fall(kappa, kappa_c, kappa_s, q)


def coulomb_stribeck_slope(
    kappa: Numbers, K: Numbers, mu: Numbers, q: Numbers, kappa_s: Numbers
) -> Numbers:
    r"""Compute the derivative of `coulomb_stribeck` with respect to slip ratio [-].

    .. math::
        \frac{f'}{F_n} = K (1 - u^2) - 2 \mu (1 - q) \frac{z}{\kappa_s} e^{-z^2}

    with u of `regularised_sign` and z of `stribeck_fall`, for kappa >= 0; even. The first term is
    non-zero only below the peak, the second only beyond it; both vanish at kappa_c.

    Args:
        kappa: Slip ratio [-].
        K: Slip stiffness, slope at zero slip [-].
        mu: Static friction, the peak [-].
        q: Kinetic over static friction [-].
        kappa_s: Stribeck slip [-].
    """
    kappa_c = breakaway_slip(K, mu)
    u = np.clip(kappa / kappa_c, -1.0, 1.0)
    z = _slip_past_breakaway(kappa, kappa_c, kappa_s)
    return K * (1 - u**2) - 2 * mu * (1 - q) * z / kappa_s * np.exp(-(z**2))


@register_jitable
def _slip_past_breakaway(kappa: Numbers, kappa_c: Numbers, kappa_s: Numbers) -> Numbers:
    """Compute z, absolute slip ratio less kappa_c, over Stribeck slip kappa_s, within [0, 40]."""
    # Beyond 40 Stribeck slips exp(-z²) is zero in double precision; the bound keeps infinite slip
    # (a locked leg by material slip) from giving inf·0.
    return np.minimum(np.maximum((np.abs(kappa) - kappa_c) / kappa_s, 0.0), 40.0)


@dataclass(frozen=True)
class CoulombStribeck(ProportionalLaw):
    """Coulomb friction as a slip law, static at break-away and kinetic at large slip.

    Attributes:
        stribeck: Let the traction fall from static to kinetic friction. Without it the traction
            stays at its peak: plain Coulomb friction, regularised.
    """

    stribeck: bool = True

    name = "coulomb-stribeck"
    traction_over_load = staticmethod(coulomb_stribeck)
    slope_over_load = staticmethod(coulomb_stribeck_slope)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters K, mu and, if `stribeck`, q and kappa_s, in the order of `values`."""
        return (*_COMMON, *(_STRIBECK if self.stribeck else ()))

    def constants(self, values: Values) -> tuple[Array, Array, Array, Array]:
        """Return K, mu, q and kappa_s as arrays; q and kappa_s are 1 unless `stribeck`.

        Args:
            values: Parameter values, one entry a parameter.

        Returns:
            K [-], mu [-], q [-] and kappa_s [-].
        """
        K, mu = (np.asarray(value, dtype=float) for value in values[:2])
        if not self.stribeck:
            return K, mu, np.array(1.0), np.array(1.0)
        return K, mu, np.asarray(values[2], dtype=float), np.asarray(values[3], dtype=float)

    def peak(self, values: Values) -> Array:
        """Compute the slip ratio kappa_c at which traction peaks, infinite unless `stribeck` [-].

        Args:
            values: Parameter values, one entry a parameter.
        """
        K, mu, _, _ = self.constants(values)
        return np.asarray(breakaway_slip(K, mu) if self.stribeck else math.inf)


_COMMON = (
    Parameter("slip_stiffness", "K", "dimensionless", 0.0, math.inf,
              "slope of traction over load at zero slip", (10.0, 1.5)),
    Parameter("friction", "mu", "dimensionless", 0.0, math.inf,
              "static friction: peak traction over load", (0.6, 0.7)),
)  # fmt: skip
_STRIBECK = (
    Parameter("kinetic_ratio", "q", "dimensionless", 0.0, 1.0,
              "kinetic over static friction: traction far out over its peak"),
    Parameter("stribeck_slip", "kappa_s", "dimensionless", 0.0, math.inf,
              "slip past the peak over which 63 % of the fall happens", (0.1, 1.0)),
)  # fmt: skip
