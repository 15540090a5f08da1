# SPDX-License-Identifier: MIT
"""Interface of every slip law: traction force from slip ratio and normal force."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array, Numbers

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


@dataclass(frozen=True)
class CompiledForce:
    r"""A law's force at one vector of parameter values, as compiled loops compute it.

    .. math::
        F = m N\, f(h \kappa)

    with f `traction_over_load` of the slip and the coefficients of `at_load`, and m and h the
    factors of the side of the slip, `driving` where it is not negative.

    Attributes:
        at_load: Function of load and constants to the coefficients of `traction_over_load`; see
            `EquationLaw`.
        traction_over_load: Function of slip and coefficients to traction over load.
        constants: The second argument of `at_load`.
        driving: Factors m on friction and h on slip where slip drives.
        braking: The same where it brakes.
    """

    at_load: Callable[..., tuple[Numbers, ...]]
    traction_over_load: Callable[..., Numbers]
    constants: tuple[float, ...]
    driving: tuple[float, float] = (1.0, 1.0)
    braking: tuple[float, float] = (1.0, 1.0)


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

    def compiled_force(self, values: Values) -> CompiledForce:
        """Return the force at one vector of parameter values, for compiled loops.

        Args:
            values: Parameter values, shape (k,).
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


class EquationLaw(ABC):
    """Force of a `SlipLaw` by equations that stand once, for arrays and for compiled loops.

    Both are functions of a module, under numba's `register_jitable`, that take numbers or arrays:
    they call functions of numpy of one value (`np.sin`, `np.minimum`, not `np.where`, `np.clip` or
    `np.asarray`), and choose between arrays without a branch.

    Attributes:
        at_load: Function from load [N] and the law's `constants` to a tuple of coefficients.
        traction_over_load: Function from slip ratio and these coefficients to traction over load
            [-].
    """

    at_load: ClassVar[Callable[..., tuple[Numbers, ...]]]
    traction_over_load: ClassVar[Callable[..., Numbers]]

    @abstractmethod
    def constants(self, values: Values) -> tuple[Numbers, ...]:
        """Compute what `at_load` takes besides the load; the law's options are among it.

        Args:
            values: Parameter values, one entry a parameter.
        """

    def force(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the traction force [N]; see `SlipLaw.force`.

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        Fn = np.asarray(load, dtype=float)
        coefficients = self.at_load(Fn, self.constants(values))
        return Fn * self.traction_over_load(np.asarray(slip, dtype=float), *coefficients)

    def compiled_force(self, values: Values) -> CompiledForce:
        """Return the force at one vector of parameter values, for compiled loops.

        Args:
            values: Parameter values, shape (k,).
        """
        constants = tuple(float(each) for each in self.constants(values))
        return CompiledForce(self.at_load, self.traction_over_load, constants)
