# SPDX-License-Identifier: MIT
"""Brush model with parabolic pressure distribution: bristles that stick, then slide."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.slip.law import Parameter, Values
from model.slip.proportional import ProportionalLaw


def sliding_share(sigma: ArrayLike, K: ArrayLike, mu_s: ArrayLike) -> Array:
    r"""Compute the share of the brush model's contact patch that slides at a slip ratio.

    .. math::
        \psi = \min\Bigl(\frac{K |\sigma|}{3 \mu_s},\ 1\Bigr)

    A bristle sticks from the leading edge on and is bent in proportion to slip and distance. It
    starts to slide where its force reaches static friction times the local pressure, a parabola
    over the patch.

    Args:
        sigma: Material slip ratio [-].
        K: Slip stiffness [-].
        mu_s: Static friction of a bristle [-].

    Returns:
        Share of the patch, from 0 (all stick) to 1 (all slide) [-].
    """
    return np.minimum(np.asarray(K) * np.abs(np.asarray(sigma)) / (3 * np.asarray(mu_s)), 1.0)


def brush(sigma: ArrayLike, K: ArrayLike, mu_s: ArrayLike, q: ArrayLike = 1.0) -> Array:
    r"""Compute traction over load of the brush model at a material slip ratio.

    .. math::
        \frac{f}{F_n} = \operatorname{sgn}(\sigma)\, \mu_s
            \bigl[3\psi (1 - \psi)^2 + q\,(3\psi^2 - 2\psi^3)\bigr]

    with psi of `sliding_share`. The first term is the force of the bristles that stick, the second
    that of those that slide. With q = 1 it is Pacejka's mu (3 psi - 3 psi² + psi³). Odd, slope K at
    zero slip, constant at q·mu_s from full sliding (psi = 1) on; once continuously differentiable.

    Args:
        sigma: Material slip ratio [-].
        K: Slip stiffness [-].
        mu_s: Static friction of a bristle [-].
        q: Kinetic over static friction of a bristle [-].

    Returns:
        Traction force over normal force [-].

    >>> float(brush(0.02, K=20.0, mu_s=0.4).round(4))
    0.2815
    """
    psi = sliding_share(sigma, K, mu_s)
    sticking = 3 * psi * (1 - psi) ** 2
    sliding = np.asarray(q) * psi**2 * (3 - 2 * psi)
    return np.sign(np.asarray(sigma)) * np.asarray(mu_s) * (sticking + sliding)


def brush_slope(sigma: ArrayLike, K: ArrayLike, mu_s: ArrayLike, q: ArrayLike = 1.0) -> Array:
    r"""Compute the derivative of `brush` with respect to material slip ratio [-].

    .. math::
        \frac{f'}{F_n} = K (1 - \psi) \bigl(1 - (3 - 2q)\psi\bigr)

    with psi of `sliding_share`. Zero at the peak, psi = 1/(3 - 2q), and from full sliding, psi = 1,
    on.

    Args:
        sigma: Material slip ratio [-].
        K: Slip stiffness [-].
        mu_s: Static friction of a bristle [-].
        q: Kinetic over static friction of a bristle [-].
    """
    psi = sliding_share(sigma, K, mu_s)
    return np.asarray(K) * (1 - psi) * (1 - (3 - 2 * np.asarray(q)) * psi)


def static_friction_from_peak(mu: ArrayLike, q: ArrayLike) -> Array:
    r"""Compute the static friction of a bristle from the peak of the whole patch.

    .. math::
        \mu_s = \mu\, \frac{(3 - 2q)^2}{4 - 3q}

    The patch peaks while part of it slides already, so its peak mu lies below mu_s unless q = 1.

    Args:
        mu: Peak traction over load [-].
        q: Kinetic over static friction of a bristle [-].

    Returns:
        Static friction mu_s [-].

    >>> float(static_friction_from_peak(0.38, 1.0))
    0.38
    """
    q = np.asarray(q, dtype=float)
    return np.asarray(mu) * (3 - 2 * q) ** 2 / (4 - 3 * q)


@dataclass(frozen=True)
class Brush(ProportionalLaw):
    """The brush model as a slip law, its force proportional to load at every slip ratio.

    It is derived for theoretical slip, the material slip of `SlipDefinition.MATERIAL`. Slip of
    another definition must be converted first.

    Attributes:
        kinetic: Let sliding bristles have less friction than sticking ones, with the further
            parameter q, which gives the curve a peak. Without it traction only rises, to full
            sliding at slip 3·mu/K.
    """

    kinetic: bool = False

    name = "brush"
    traction_over_load = staticmethod(brush)
    slope_over_load = staticmethod(brush_slope)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters K, mu and, if `kinetic`, q, in the order of `values`."""
        return (*_COMMON, *(_KINETIC if self.kinetic else ()))

    def coefficients(self, values: Values) -> tuple[Array, Array, Array]:
        """Compute K, a bristle's static friction mu_s from the peak mu, and q, 1 unless `kinetic`.

        Args:
            values: Parameter values, one entry a parameter.

        Returns:
            K [-], mu_s [-] and q [-].
        """
        K, mu = (np.asarray(value, dtype=float) for value in values[:2])
        q = np.asarray(values[2] if self.kinetic else 1.0, dtype=float)
        return K, static_friction_from_peak(mu, q), q

    def peak(self, values: Values) -> Array:
        """Compute the slip ratio at which traction peaks, infinite unless `kinetic` [-].

        Args:
            values: Parameter values, one entry a parameter.
        """
        K, mu_s, q = self.coefficients(values)
        return 3 * mu_s / (K * (3 - 2 * q)) if self.kinetic else np.array(math.inf)


_COMMON = (
    Parameter("slip_stiffness", "K", "dimensionless", 0.0, math.inf,
              "slope of traction over load at zero slip"),
    Parameter("friction", "mu", "dimensionless", 0.0, math.inf,
              "peak traction over load"),
)  # fmt: skip
_KINETIC = (
    Parameter("kinetic_ratio", "q", "dimensionless", 0.0, 1.0,
              "kinetic over static friction of a bristle"),
)  # fmt: skip
