# SPDX-License-Identifier: MIT
"""A slip law whose friction and stiffness follow a quantity that each run was made at."""

import math
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.slip.law import Parameter, SlipLaw, Values

DEGREES: Final = (1, 2)
"""Degrees of the polynomial that may be fitted."""


@dataclass(frozen=True)
class Covariate:
    """A positive quantity that is constant within each run, such as the pressure of a tyre.

    Attributes:
        name: Its name.
        unit: Unit of its values, as it is stated; it only labels them.
        reference: Value at which a law has its parameters' values, in that unit.
        scale: Difference of the logarithm of the quantity that counts as 1 [-].
    """

    name: str
    unit: str
    reference: float
    scale: float

    def coordinate(self, value: ArrayLike) -> Array:
        """Compute ln(value/reference) over the scale, 0 at the reference [-].

        Args:
            value: Values of the quantity, above 0, in its unit.
        """
        return np.log(np.asarray(value, dtype=float) / self.reference) / self.scale

    def value(self, coordinate: ArrayLike) -> Array:
        """Compute the value of the quantity at a coordinate, in its unit.

        Args:
            coordinate: What `coordinate` returns [-].
        """
        return self.reference * np.exp(self.scale * np.asarray(coordinate, dtype=float))


@dataclass(frozen=True)
class CovariateLaw:
    r"""A slip law of which every value of a covariate gives a similar copy.

    .. math::
        F(\kappa, N, z) = e^{a} F_0(e^{b - a} \kappa, N), \qquad
        a = \sum_p a_p z^p, \quad b = \sum_p b_p z^p

    with z the coordinate of the covariate, so that friction is :math:`e^a` and slip stiffness
    :math:`e^b` times that at the reference, and the shape of the curve stays (the similarity
    method: Pacejka, Tyre and Vehicle Dynamics, 4.2). Wherever a law is used without a value of the
    covariate, as for walks, it is that at the reference.

    Attributes:
        law: Law at the reference.
        covariate: The covariate.
        degree: Degree of the polynomials in z, one of `DEGREES`.
        at: Coordinate z of each point that the law is evaluated at, broadcast against slip and
            load; None for the reference.
    """

    law: SlipLaw
    covariate: Covariate
    degree: int
    at: Array | None = field(default=None, compare=False)

    @property
    def name(self) -> str:
        """Name of the law at the reference."""
        return self.law.name

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters of the law at the reference, then friction's and stiffness's by degree."""
        return (*self.law.parameters, *covariate_parameters(self.covariate.name, self.degree))

    @property
    def n_own(self) -> int:
        """Number of parameters that the law at the reference has not."""
        return 2 * self.degree

    def factors(self, values: Values, at: Array | None = None) -> tuple[Array, Array]:
        """Compute by how much friction and slip are scaled at the value of each point [-].

        Args:
            values: Parameter values, one entry a parameter.
            at: Coordinate z of each point; None for those of the law.
        """
        at = self.at if at is None else at
        z = np.zeros(()) if at is None else at
        a, b = np.zeros(()), np.zeros(())
        for p in range(self.degree):
            friction, stiffness = values[len(values) - self.n_own + 2 * p :][:2]
            a = a + np.asarray(friction) * z ** (p + 1)
            b = b + np.asarray(stiffness) * z ** (p + 1)
        return np.exp(a), np.exp(b - a)

    def copied_values(self, values: Array, at: float) -> Array:
        """Compute the parameters of the law whose curve is the copy at one value of the covariate.

        Args:
            values: Values of all parameters, shape (w, k).
            at: Coordinate z [-].

        Returns:
            Values of the parameters of `law`, shape (w, k - `n_own`).
        """
        m, h = self.factors(values.T, np.asarray(at, dtype=float))
        scaled = {"slip_stiffness": m * h, "friction": m, "peak_slip_per_load": 1 / h,
                  "stribeck_slip": 1 / h}  # fmt: skip
        factors = [scaled.get(p.name, np.ones_like(m)) for p in self.law.parameters]
        return values[:, : -self.n_own] * np.stack(factors, axis=1)

    def force(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the traction force [N]; see `SlipLaw.force`.

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        m, h = self.factors(values)
        return m * self.law.force(h * np.asarray(slip), load, values[: -self.n_own])

    def slip_derivative(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the derivative of the force with respect to slip ratio [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        m, h = self.factors(values)
        slope = self.law.slip_derivative(h * np.asarray(slip), load, values[: -self.n_own])
        return m * h * slope

    def valid(self, load: ArrayLike, values: Values) -> NDArray[np.bool_]:
        """Return where the law at the reference has its shape, which every copy shares.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return self.law.valid(load, values[: -self.n_own])

    def peak_slip(self, load: ArrayLike, values: Values) -> Array:
        """Compute the slip ratio of the peak, infinite where the force never falls [-].

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return self.law.peak_slip(load, values[: -self.n_own]) / self.factors(values)[1]


def law_at(law: SlipLaw, coordinate: Array | None) -> SlipLaw:
    """Return a law at the values of the covariate of some points; another law as it is.

    Args:
        law: The slip law.
        coordinate: Coordinate z of each point, shape (n,), as `Covariate.coordinate` computes it;
            None for the reference.
    """
    return replace(law, at=coordinate) if isinstance(law, CovariateLaw) else law


def reference_law(law: SlipLaw, values: Values) -> tuple[SlipLaw, Values]:
    """Return a law at the reference of its covariate, if it has one: the law and its values.

    Args:
        law: The slip law.
        values: Parameter values, one entry a parameter.
    """
    return (law.law, values[: -law.n_own]) if isinstance(law, CovariateLaw) else (law, values)


def covariate_parameters(name: str, degree: int) -> tuple[Parameter, ...]:
    """Return the parameters of friction and stiffness, each pair by its degree.

    Args:
        name: Name of the covariate.
        degree: Degree of the polynomials.

    >>> [each.name for each in covariate_parameters("pressure", 2)]
    ['friction_pressure', 'stiffness_pressure', 'friction_pressure_2', 'stiffness_pressure_2']
    """
    found = []
    for p in range(1, degree + 1):
        end, power = ("", "") if p == 1 else (f"_{p}", ", squared")
        for what, symbol in (("friction", "a"), ("stiffness", "b")):
            found.append(
                Parameter(
                    f"{what}_{name}{end}", f"{symbol}_{p}", "dimensionless", -math.inf, math.inf,
                    f"growth of the logarithm of {what} with the coordinate of {name}{power}",
                )
            )  # fmt: skip
    return tuple(found)
