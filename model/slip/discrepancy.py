# SPDX-License-Identifier: MIT
"""A slip law with a smooth departure from its curve, a Gaussian process over slip."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import chdtrc

from model.arrays import Array
from model.slip.law import Parameter, SlipLaw, Values

LENGTH: Final = 1.5  # correlation length of the departure, in arsinh of slip [-]
SPACING: Final = 1.2  # of the knots, which zero slip is one of [-]
BEND: Final = 30.0  # the scale is linear in slip up to the largest tested slip over this
FAR: Final = 40.0  # of arsinh of slip, where the departure has long been zero; no power overflows
GRID: Final = 200  # slips among which the peak is sought
NAME: Final = "discrepancy"
"""Begin of the names of the departure's parameters."""


@dataclass(frozen=True)
class LawWithDiscrepancy:
    r"""A slip law plus a smooth departure from it that is the same share of the load at each load.

    .. math::
        F(\kappa, N) = F_0(\kappa, N) + N\, d(\kappa), \qquad
        d = \sum_j b_j\, e^{-(u - u_j)^2 / 2 \ell^2}, \qquad
        u = \operatorname{arsinh}(\kappa / \kappa_0)

    with knots u_j evenly spaced over the tested slips. The weights b are linear in the parameters
    :math:`c_j \sim N(0, 1)` such that d at the knots is a Gaussian process of standard deviation
    `sd` and correlation :math:`e^{-\Delta u^2 / 2 \ell^2}`, given that it is zero at zero slip, as
    a constant force is rolling resistance (Kennedy and O'Hagan 2001). Both sides are free. Beyond
    the tested slips the curve returns to the law's.

    Attributes:
        law: The law that the departure is from.
        sd: Standard deviation of the departure far from zero slip, over the load [-].
        scale: Slip kappa_0 below which knots are evenly spaced in slip [-].
        first: Index of the first knot, at u = `SPACING` times it; at most 0.
        last: Index of the last knot; at least 0.
    """

    law: SlipLaw
    sd: float
    scale: float
    first: int
    last: int

    @property
    def name(self) -> str:
        """Name of the law that the departure is from."""
        return self.law.name

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The law's parameters, then one for each knot but that at zero slip."""
        return self._parameters

    @cached_property
    def _parameters(self) -> tuple[Parameter, ...]:
        return (
            *self.law.parameters,
            *(
                Parameter(
                    f"{NAME}_{i + 1}", f"d_{i + 1}", "dimensionless", -math.inf, math.inf,
                    f"departure from the law about slip {slip:.2g}, in prior standard deviations",
                )
                for i, slip in enumerate(self.scale * np.sinh(self._places))
            ),
        )  # fmt: skip

    @cached_property
    def _places(self) -> Array:
        """Places u of the knots but that at zero, shape (m,) [-]."""
        knots = SPACING * np.arange(self.first, self.last + 1)
        return np.asarray(knots[knots != 0], dtype=float)

    @cached_property
    def _weights(self) -> Array:
        """Matrix from the parameters c (m,) to the weights b of all knots, (m + 1, m) [-]."""
        knots = SPACING * np.arange(self.first, self.last + 1)
        free = np.flatnonzero(knots)
        alike = np.exp(-((knots[:, None] - knots) ** 2) / (2 * LENGTH**2))
        zero = alike[free, -self.first]
        given = alike[np.ix_(free, free)] - np.outer(zero, zero)
        at_knots = np.zeros((len(knots), len(free)))
        at_knots[free] = self.sd * np.linalg.cholesky(given)
        return np.asarray(np.linalg.solve(alike, at_knots), dtype=float)

    def departure(self, slip: ArrayLike, values: Values) -> Array:
        """Compute the departure from the law over the load, d, at a slip ratio [-].

        Args:
            slip: Slip ratio [-].
            values: Parameter values, one entry a parameter, those of the law first.
        """
        u = np.clip(np.arcsinh(np.asarray(slip, dtype=float) / self.scale), -FAR, FAR)
        ratio = np.exp(u * (SPACING / LENGTH**2))
        total = np.zeros(np.broadcast_shapes(u.shape, *(np.shape(c) for c in self._own(values))))
        for weight in reversed(self._scaled_weights(values)):  # Horner: one power of ratio a knot
            total = total * ratio + weight
        return total * np.exp(self.first * SPACING / LENGTH**2 * u - u**2 / (2 * LENGTH**2))

    def _own(self, values: Values) -> list[Array]:
        return [np.asarray(c, dtype=float) for c in values[len(self.law.parameters) :]]

    def _scaled_weights(self, values: Values) -> list[Array]:
        """Return each knot's weight b times the part of its term that slip does not change [-]."""
        own = self._own(values)
        knots = SPACING * np.arange(self.first, self.last + 1)
        size = np.exp(-(knots**2) / (2 * LENGTH**2))
        rows = self._weights * size[:, None]
        return [sum((a * c for a, c in zip(row, own, strict=True)), np.zeros(())) for row in rows]

    def force(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the traction force [N]; see `SlipLaw.force`.

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        law = self.law.force(slip, load, values[: len(self.law.parameters)])
        return law + np.asarray(load) * self.departure(slip, values)

    def slip_derivative(self, slip: ArrayLike, load: ArrayLike, values: Values) -> Array:
        """Compute the derivative of the force with respect to slip ratio [N].

        Args:
            slip: Slip ratio [-].
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        kappa = np.asarray(slip, dtype=float)
        u = np.arcsinh(kappa / self.scale)
        own = self._own(values)
        change = np.zeros(np.broadcast_shapes(u.shape, *(np.shape(c) for c in own)))
        for i, row in enumerate(self._weights):
            away = u - SPACING * (self.first + i)
            weight = sum((a * c for a, c in zip(row, own, strict=True)), np.zeros(()))
            change = change - weight * away / LENGTH**2 * np.exp(-(away**2) / (2 * LENGTH**2))
        slope = change / np.hypot(kappa, self.scale)
        law = self.law.slip_derivative(slip, load, values[: len(self.law.parameters)])
        return law + np.asarray(load) * slope

    def valid(self, load: ArrayLike, values: Values) -> NDArray[np.bool_]:
        """Return where the law without the departure has its shape.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        return self.law.valid(load, values[: len(self.law.parameters)])

    def peak_slip(self, load: ArrayLike, values: Values) -> Array:
        """Compute the slip ratio at which the driving force is largest, on a grid of slips [-].

        Where it is largest at the grid's end, at the last knot, and on data without driving slip,
        the peak is that of the law without the departure, but at least at the grid's end.

        Args:
            load: Normal force, positive [N].
            values: Parameter values, one entry a parameter.
        """
        own = self.law.peak_slip(load, values[: len(self.law.parameters)])
        if self.last == 0:
            return own
        grid = self.scale * np.sinh(np.linspace(0.0, self.last * SPACING, GRID)[1:])
        columns = [np.asarray(value, dtype=float)[..., None] for value in values]
        force = self.force(grid, np.asarray(load, dtype=float)[..., None], columns)
        at = np.argmax(force, axis=-1)
        return np.where(at == len(grid) - 1, np.maximum(own, grid[-1]), grid[at])


def with_discrepancy(
    law: SlipLaw, sd: float, *, smallest: float, largest: float
) -> LawWithDiscrepancy:
    """Return a law with a departure over the tested slips.

    Args:
        law: The slip law.
        sd: Standard deviation of the departure, over the load [-].
        smallest: Smallest tested slip ratio [-].
        largest: Largest tested slip ratio [-].
    """
    scale = max(-smallest, largest) / BEND
    ends = np.arcsinh(np.array([min(smallest, 0.0), max(largest, 0.0)]) / scale) / SPACING
    return LawWithDiscrepancy(law, sd, scale, int(np.floor(ends[0])), int(np.ceil(ends[1])))


def chance_of_law(law: LawWithDiscrepancy, draws: Array) -> float:
    r"""Compute the p-value of the law alone: of no departure, given posterior draws [-].

    The squared Mahalanobis distance of zero from the departure's parameters has at most the
    chi-square distribution of as many degrees of freedom, if there is none: the prior draws their
    means towards zero.

    Args:
        law: The law with a departure.
        draws: Posterior draws of its parameters, shape (n_draws, k).
    """
    own = draws[:, len(law.law.parameters) :]
    mean, covariance = own.mean(axis=0), np.atleast_2d(np.cov(own.T))
    return float(chdtrc(len(mean), mean @ np.linalg.solve(covariance, mean)))
