# SPDX-License-Identifier: MIT
"""Brush model with parabolic pressure distribution: bristles that stick, then slide."""

import math
from dataclasses import dataclass

import numpy as np
from numba.extending import register_jitable

from model.arrays import Array, Numbers
from model.slip.law import Parameter, Values
from model.slip.proportional import ProportionalLaw


@register_jitable
def sliding_share(sigma: Numbers, K: Numbers, mu: Numbers) -> Numbers:
    r"""Compute the share of the brush model's contact patch that slides at a slip ratio.

    .. math::
        \psi = \min\Bigl(\frac{K |\sigma|}{3 \mu},\ 1\Bigr)

    A bristle sticks from the leading edge on and is bent in proportion to slip and distance. It
    starts to slide where its force reaches friction times the local pressure, a parabola over the
    patch.

    Args:
        sigma: Material slip ratio [-].
        K: Slip stiffness [-].
        mu: Friction of a bristle [-].

    Returns:
        Share of the patch, from 0 (all stick) to 1 (all slide) [-].
    """
    return np.minimum(K * np.abs(sigma) / (3 * mu), 1.0)


@register_jitable
def brush(sigma: Numbers, K: Numbers, mu: Numbers) -> Numbers:
    r"""Compute traction over load of the brush model at a material slip ratio.

    .. math::
        \frac{f}{F_n} = \operatorname{sgn}(\sigma)\, \mu\,(3\psi - 3\psi^2 + \psi^3)

    with psi of `sliding_share` (Pacejka, Tyre and Vehicle Dynamics, 3.2). Odd, slope K at zero
    slip, constant at mu from full sliding (psi = 1) on; once continuously differentiable.

    Args:
        sigma: Material slip ratio [-].
        K: Slip stiffness [-].
        mu: Friction of a bristle [-].

    Returns:
        Traction force over normal force [-].

    >>> float(brush(0.02, K=20.0, mu=0.4).round(4))
    0.2815
    """
    psi = sliding_share(sigma, K, mu)
    return np.sign(sigma) * mu * psi * (3 - 3 * psi + psi**2)


def brush_slope(sigma: Numbers, K: Numbers, mu: Numbers) -> Numbers:
    r"""Compute the derivative of `brush` with respect to material slip ratio [-].

    .. math::
        \frac{f'}{F_n} = K (1 - \psi)^2

    with psi of `sliding_share`. Zero from full sliding, psi = 1, on.

    Args:
        sigma: Material slip ratio [-].
        K: Slip stiffness [-].
        mu: Friction of a bristle [-].
    """
    return K * (1 - sliding_share(sigma, K, mu)) ** 2


@dataclass(frozen=True)
class Brush(ProportionalLaw):
    """The brush model as a slip law, its force proportional to load at every slip ratio.

    It is derived for theoretical slip, the material slip of `SlipDefinition.MATERIAL`. Slip of
    another definition must be converted first. Traction only rises, to full sliding at slip 3·mu/K.
    """

    name = "brush"
    traction_over_load = staticmethod(brush)
    slope_over_load = staticmethod(brush_slope)
    parameters = (
        Parameter("slip_stiffness", "K", "dimensionless", 0.0, math.inf,
                  "slope of traction over load at zero slip", (10.0, 1.5)),
        Parameter("friction", "mu", "dimensionless", 0.0, math.inf,
                  "peak traction over load", (0.6, 0.7)),
    )  # fmt: skip

    def constants(self, values: Values) -> tuple[Array, Array]:
        """Return K and mu as arrays.

        Args:
            values: Parameter values, one entry a parameter.
        """
        K, mu = (np.asarray(value, dtype=float) for value in values)
        return K, mu

    def peak(self, values: Values) -> Array:
        """Return infinity: traction never falls [-].

        Args:
            values: Parameter values, one entry a parameter.
        """
        return np.array(math.inf)
