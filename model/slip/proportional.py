# SPDX-License-Identifier: MIT
"""Slip laws whose traction is the load times a function of slip alone."""

from abc import abstractmethod
from collections.abc import Callable
from typing import ClassVar

import numpy as np
from numba.extending import register_jitable
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array, Numbers
from model.slip.law import EquationLaw, Values


@register_jitable
def _at_any_load(_load: Numbers, constants: tuple[Numbers, ...]) -> tuple[Numbers, ...]:
    """Return the coefficients of a law whose traction over load is the same at every load."""
    return constants


class ProportionalLaw(EquationLaw):
    """Methods of a `SlipLaw` whose traction over load does not depend on load.

    A law adds its name and parameters, both attributes, and the methods `constants`, which are the
    arguments of `traction_over_load` after the slip, and `peak`.

    Attributes:
        slope_over_load: Derivative of `traction_over_load` with respect to slip ratio [-].
    """

    at_load = staticmethod(_at_any_load)
    slope_over_load: ClassVar[Callable[..., Numbers]]

    @abstractmethod
    def peak(self, values: Values) -> Array:
        """Compute the slip ratio at which traction peaks, infinite where it never falls [-].

        Each law overrides this method.

        Args:
            values: Parameter values, one entry a parameter.
        """

    def slip_derivative(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the derivative of the force with respect to slip ratio [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        slope = self.slope_over_load(np.asarray(slip, dtype=float), *self.constants(values))
        return np.asarray(load) * slope

    def valid(self, load: ArrayLike, values: Values) -> NDArray[np.bool_]:
        """Return True everywhere, in the shape to which load and values broadcast.

        The curve has the law's shape at every load, for values within their bounds.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return np.ones(np.broadcast(load, *values).shape, dtype=bool)

    def peak_slip(self, load: ArrayLike, values: Values) -> Array:
        """Compute the slip ratio at which the force peaks, the same at every load [-].

        Infinite where the force never falls; in the shape to which load and values broadcast.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return np.broadcast_to(self.peak(values), np.broadcast(load, *values).shape)
