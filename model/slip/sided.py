# SPDX-License-Identifier: MIT
"""A slip law whose braking side differs from its driving side in stiffness and friction."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.slip.law import CompiledForce, Parameter, SlipLaw, Values

N_SIDES = 2
"""Number of parameters that a `SidedLaw` has in addition to those of its middle curve."""


def side_factors(kappa: ArrayLike, d_K: ArrayLike, d_mu: ArrayLike) -> tuple[Array, Array]:
    r"""Compute by how much friction and slip are scaled on the side of a slip ratio.

    .. math::
        m = e^{\pm d_\mu/2}, \qquad h = e^{\pm (d_K - d_\mu)/2}

    with the upper sign where slip drives, kappa >= 0.

    Args:
        kappa: Slip ratio [-].
        d_K: Logarithm of the slip stiffness of driving over that of braking [-].
        d_mu: Logarithm of the friction of driving over that of braking [-].

    Returns:
        Factor m on friction, and factor h on slip [-].
    """
    half = np.where(np.asarray(kappa) < 0, -0.5, 0.5)
    d_K, d_mu = np.asarray(d_K, dtype=float), np.asarray(d_mu, dtype=float)
    return np.exp(half * d_mu), np.exp(half * (d_K - d_mu))


@dataclass(frozen=True)
class SidedLaw:
    r"""A slip law whose driving and braking sides are differently scaled copies of one curve.

    .. math::
        F(\kappa) = m\, F_0(h \kappa)

    with m and h of `side_factors`, so that friction is m and slip stiffness m·h times that of the
    middle curve F_0, whose shape both sides keep (the similarity method: Pacejka, Tyre and Vehicle
    Dynamics, 4.2). Both sides meet in zero force at zero slip, where the slope jumps.

    Attributes:
        law: Law of the middle curve, whose parameters are the geometric means of the sides'.
    """

    law: SlipLaw

    @property
    def name(self) -> str:
        """Name of the law of the middle curve."""
        return self.law.name

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters of the middle curve, then the two of the sides."""
        return (*self.law.parameters, *_SIDES)

    def force(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the traction force [N]; see `SlipLaw.force`.

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        m, h = side_factors(slip, *values[-N_SIDES:])
        return m * self.law.force(h * np.asarray(slip), load, values[:-N_SIDES])

    def compiled_force(self, values: Values) -> CompiledForce:
        """Return the force at one vector of parameter values, for compiled loops.

        Args:
            values: Parameter values, shape (k,).
        """
        m, h = (each.tolist() for each in side_factors(np.array([1.0, -1.0]), *values[-N_SIDES:]))
        middle = self.law.compiled_force(values[:-N_SIDES])
        return replace(middle, driving=(m[0], h[0]), braking=(m[1], h[1]))

    def slip_derivative(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the derivative of the force by slip ratio; at zero slip the driving side's [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        m, h = side_factors(slip, *values[-N_SIDES:])
        return m * h * self.law.slip_derivative(h * np.asarray(slip), load, values[:-N_SIDES])

    def valid(self, load: ArrayLike, values: Values) -> NDArray[np.bool_]:
        """Return where the middle curve has its law's shape, which the sides share.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return self.law.valid(load, values[:-N_SIDES])

    def peak_slip(self, load: ArrayLike, values: Values) -> Array:
        """Compute the slip ratio of the driving peak, infinite where the force never falls [-].

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return self._peak(1.0, load, values)

    def braking_peak_slip(self, load: ArrayLike, values: Values) -> Array:
        """Compute the slip ratio of the braking peak, negative, -inf without one [-].

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return -self._peak(-1.0, load, values)

    def _peak(self, side: float, load: ArrayLike, values: Values) -> Array:
        """Compute the absolute slip ratio of the peak, driving if `side` > 0, else braking [-]."""
        h = side_factors(side, *values[-N_SIDES:])[1]
        return self.law.peak_slip(load, values[:-N_SIDES]) / h


def braking_peak_slip(law: SlipLaw, load: ArrayLike, values: Values) -> Array:
    """Compute the slip ratio of a law's braking peak, negative, -inf without one [-].

    Args:
        law: The slip law.
        load: Normal force, positive [N].
        values: Parameter values, one entry a parameter.
    """
    if isinstance(law, SidedLaw):
        return law.braking_peak_slip(load, values)
    return -law.peak_slip(load, values)


def middle_curve(law: SlipLaw, values: Values) -> tuple[SlipLaw, Values]:
    """Return a law's middle curve between driving and braking: its law and parameter values.

    Args:
        law: The slip law; one without sides is its own middle curve.
        values: Parameter values, one entry a parameter.
    """
    return (law.law, values[:-N_SIDES]) if isinstance(law, SidedLaw) else (law, values)


_SIDES = (
    Parameter("side_stiffness", "d_K", "dimensionless", -math.inf, math.inf,
              "logarithm of slip stiffness in driving over that in braking", (0.0, 0.2)),
    Parameter("side_friction", "d_mu", "dimensionless", -math.inf, math.inf,
              "logarithm of friction in driving over that in braking", (0.0, 0.1)),
)  # fmt: skip
