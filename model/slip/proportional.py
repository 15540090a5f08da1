# SPDX-License-Identifier: MIT
"""Slip laws whose traction is the load times a function of slip alone."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.slip.law import Values


class ProportionalLaw(ABC):
    """Methods of a `SlipLaw` whose traction over load does not depend on load.

    A law adds its name and parameters, both attributes, and the methods `coefficients` and `peak`.

    Attributes:
        traction_over_load: Function from slip ratio and the law's coefficients to traction over
            load [-].
        slope_over_load: Derivative of `traction_over_load` with respect to slip ratio [-].
    """

    traction_over_load: ClassVar[Callable[..., Array]]
    slope_over_load: ClassVar[Callable[..., Array]]

    @abstractmethod
    def coefficients(self, values: Values) -> tuple[Array, ...]:
        """Compute the coefficients of `traction_over_load` from parameter values, in its order.

        Each law overrides this method.

        Args:
            values: Parameter values, one entry a parameter.
        """

    @abstractmethod
    def peak(self, values: Values) -> Array:
        """Compute the slip ratio at which traction peaks, infinite where it never falls [-].

        Each law overrides this method.

        Args:
            values: Parameter values, one entry a parameter.
        """

    def force(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the traction force, load times `traction_over_load` [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return np.asarray(load) * self.traction_over_load(slip, *self.coefficients(values))

    def slip_derivative(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the derivative of the force with respect to slip ratio [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return np.asarray(load) * self.slope_over_load(slip, *self.coefficients(values))

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
