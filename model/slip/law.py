# SPDX-License-Identifier: MIT
"""Interface of every slip law: traction force from slip ratio and normal force."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array

Values: TypeAlias = Sequence[ArrayLike] | Array


@dataclass(frozen=True)
class Parameter:
    """One parameter of a slip law.

    Attributes:
        name: Spelled-out name, unique within the law.
        symbol: Symbol in the law's equation.
        unit: Unit as pint spells it; "dimensionless" where there is none.
        lower: Lower bound of the support (excluded).
        upper: Upper bound of the support (excluded).
        meaning: Explanation in one line.
        typical: Centre and spread of its default prior, which is log-normal in the distance from
            the only finite bound (median and standard deviation of the logarithm), or normal
            without bounds; None for a broad one. Between two finite bounds the prior is uniform.
    """

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    meaning: str
    typical: tuple[float, float] | None = None


class SlipLaw(Protocol):
    """Protocol of a slip law: longitudinal traction as a function of slip ratio and normal force.

    `values` holds one entry a parameter, in the order of `parameters`; an entry is a number or an
    array that broadcasts against `slip` and `load`, so that a whole ensemble of parameter vectors
    is evaluated in one call: entries of shape (walkers, 1) against slip of shape (n,).

    Sign: a positive slip ratio (the leg's surface outruns the ground) drives the robot forward
    with a positive force. Every law is odd in slip, but for `SidedLaw`.
    """

    @property
    def name(self) -> str:
        """Name under which the law is chosen and stored."""
        ...

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The law's parameters, in the order of `values`."""
        ...

    def force(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the traction force from slip ratio, load and parameter values.

        Args:
            slip: Slip ratio in the definition the values were fitted with [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.

        Returns:
            Traction force, in the shape the arguments broadcast to [N].
        """
        ...

    def slip_derivative(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the derivative of the force with respect to slip ratio [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        ...

    def valid(self, load: ArrayLike, values: Values) -> NDArray[np.bool_]:
        """Return where the curve has the law's shape: one peak at most, and no change of sign.

        The result broadcasts against `load` and `values`.

        Args:
            load: Normal force, positive [N].
            values: Parameter values within their bounds, one entry a parameter.
        """
        ...

    def peak_slip(self, load: ArrayLike, values: Values) -> Array:
        """Compute the slip ratio at which the force is largest, infinite where it never falls [-].

        The result broadcasts against `load` and `values`.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        ...
