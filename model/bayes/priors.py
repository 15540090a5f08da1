# SPDX-License-Identifier: MIT
"""Prior distributions, each a map from a standard normal coordinate to the parameter's value.

A parameter is sampled as z with p(z) = N(0, 1) and value = q(Phi(z)), q the prior's quantile
function. The support is then the whole real line, the density needs no Jacobian, and the
prior-to-posterior contraction of every parameter is 1 - var(z).
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import (
    betainc,
    betaincinv,
    erf,
    erfinv,
    log_ndtr,
    ndtr,
    ndtri,
    ndtri_exp,
)

from model.arrays import Array


class Prior(Protocol):
    """Prior distribution of one parameter; methods map arrays of any shape elementwise."""

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, the prior's quantiles at Phi(z).

        Phi is the standard normal's distribution function.
        """
        ...

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`.

        Outside the prior's support the result is infinite or NaN.
        """
        ...

    def describe(self) -> str:
        """Format the distribution's family and parameters as text, for tables and files."""
        ...


@dataclass(frozen=True)
class Normal:
    """Gaussian prior.

    Attributes:
        mean: Mean, in the parameter's unit.
        sd: Standard deviation, in the parameter's unit.
    """

    mean: float
    sd: float

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, mean + sd z."""
        return self.mean + self.sd * np.asarray(z)

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        return (np.asarray(value) - self.mean) / self.sd

    def describe(self) -> str:
        """Format the distribution's family and parameters as text."""
        return f"normal(mean {self.mean:g}, sd {self.sd:g})"


@dataclass(frozen=True)
class StudentT:
    """Prior of Student's t: about as wide as a Gaussian in the middle, but data can leave it.

    Attributes:
        centre: Median, in the parameter's unit.
        scale: Scale, in the parameter's unit.
        freedom: Degrees of freedom [-].
    """

    centre: float
    scale: float
    freedom: float = 3.0

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, the quantiles of Student's t at Phi(z)."""
        # P(|t| < x) is a regularised incomplete beta function of x²/(nu + x²), and P(|t| > x) one
        # of nu/(nu + x²); each keeps its digits where it is small.
        z = np.asarray(z, dtype=float)
        half, size = 0.5 * self.freedom, np.abs(z)
        inner = betaincinv(0.5, half, erf(size / math.sqrt(2)))
        outer = betaincinv(half, 0.5, 2 * ndtr(-size))
        with np.errstate(divide="ignore"):  # of the one that is not used
            square = np.where(size < 1, inner / (1 - inner), (1 - outer) / outer)
        return self.centre + self.scale * np.sign(z) * np.sqrt(self.freedom * square)

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        t = (np.asarray(value, dtype=float) - self.centre) / self.scale
        half, square = 0.5 * self.freedom, t**2
        inner = betainc(0.5, half, square / (self.freedom + square))
        outer = betainc(half, 0.5, self.freedom / (self.freedom + square))
        size = np.where(inner < 0.5, math.sqrt(2) * erfinv(inner), -ndtri(0.5 * outer))
        return np.sign(t) * size

    def describe(self) -> str:
        """Format the distribution's family and parameters as text."""
        shape = f"{self.freedom:g} degrees of freedom"
        return f"Student's t(median {self.centre:g}, scale {self.scale:g}, {shape})"


@dataclass(frozen=True)
class LogNormal:
    """Log-normal prior: above a lower bound, with a Gaussian logarithm of the distance from it.

    Attributes:
        median: Median of the distance, in the parameter's unit.
        spread: Standard deviation of the natural logarithm of the distance [-].
        lower: Lower bound, in the parameter's unit.
    """

    median: float
    spread: float
    lower: float = 0.0

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, lower + median exp(spread z)."""
        return self.lower + self.median * np.exp(self.spread * np.asarray(z))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        return np.log((np.asarray(value) - self.lower) / self.median) / self.spread

    def describe(self) -> str:
        """Format the distribution's family and parameters as text."""
        bound = f"{self.lower:g} + " if self.lower else ""
        return f"{bound}lognormal(median {self.median:g}, spread {self.spread:g})"


@dataclass(frozen=True)
class Below:
    """Prior below an upper bound by a log-normal gap: for the curvature factor E, at most 1.

    Attributes:
        upper: Upper bound, in the parameter's unit.
        gap: Median of upper - value, in the parameter's unit.
        spread: Standard deviation of the natural logarithm of upper - value [-].
    """

    upper: float
    gap: float
    spread: float

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, upper - gap exp(-spread z)."""
        return self.upper - self.gap * np.exp(-self.spread * np.asarray(z))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        return -np.log((self.upper - np.asarray(value)) / self.gap) / self.spread

    def describe(self) -> str:
        """Format the distribution's family and parameters as text."""
        return f"{self.upper:g} - lognormal(median {self.gap:g}, spread {self.spread:g})"


@dataclass(frozen=True)
class HalfNormal:
    """Half-normal prior, the distribution of a centred Gaussian's absolute value.

    Attributes:
        scale: Standard deviation of that Gaussian, in the parameter's unit.
    """

    scale: float

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, the half-normal's quantiles at Phi(z)."""
        # |N| has lower tail Phi(z) and upper tail Phi(-z); each keeps its digits where it is small.
        z = np.asarray(z, dtype=float)
        small = math.sqrt(2) * erfinv(ndtr(z))
        return self.scale * np.where(z < 0, small, -ndtri_exp(log_ndtr(-z) - math.log(2)))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        x = np.asarray(value, dtype=float) / self.scale
        return np.where(x < 0.67, ndtri(erf(x / math.sqrt(2))), -ndtri(2 * ndtr(-x)))

    def describe(self) -> str:
        """Format the distribution's family and parameters as text."""
        return f"half-normal(scale {self.scale:g})"


@dataclass(frozen=True)
class Truncated:
    """Gaussian prior that is cut off at two bounds, one of which may be infinite.

    Attributes:
        mean: Mean before it is cut off, in the parameter's unit.
        sd: Standard deviation before it is cut off, in the parameter's unit.
        lower: Lower bound, in the parameter's unit.
        upper: Upper bound, in the parameter's unit.
    """

    mean: float
    sd: float
    lower: float
    upper: float

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, the quantiles at Phi(z) between the bounds.

        Both tails keep their digits: each is computed from the probability beyond it.
        """
        z = np.asarray(z, dtype=float)
        below, above, between = self._shares()
        low, high = below + between * ndtr(z), above + between * ndtr(-z)
        standard = np.where(low < 0.5, ndtri(low), -ndtri(high))
        return np.clip(self.mean + self.sd * standard, self.lower, self.upper)

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        standard = (np.asarray(value, dtype=float) - self.mean) / self.sd
        below, above, between = self._shares()
        low, high = (ndtr(standard) - below) / between, (ndtr(-standard) - above) / between
        return np.where(low < 0.5, ndtri(low), -ndtri(high))

    def _shares(self) -> tuple[float, float, float]:
        """Return the Gaussian's probability below, above and between the bounds."""
        a, b = (self.lower - self.mean) / self.sd, (self.upper - self.mean) / self.sd
        return float(ndtr(a)), float(ndtr(-b)), float(ndtr(b) - ndtr(a))

    def describe(self) -> str:
        """Format the distribution's family and parameters as text."""
        return f"normal(mean {self.mean:g}, sd {self.sd:g}) from {self.lower:g} to {self.upper:g}"


@dataclass(frozen=True)
class Uniform:
    """Uniform prior between two bounds.

    Attributes:
        lower: Lower bound, in the parameter's unit.
        upper: Upper bound, in the parameter's unit.
    """

    lower: float
    upper: float

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, lower + (upper - lower) Phi(z)."""
        return self.lower + (self.upper - self.lower) * ndtr(np.asarray(z, dtype=float))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        return ndtri((np.asarray(value, dtype=float) - self.lower) / (self.upper - self.lower))

    def describe(self) -> str:
        """Format the distribution's family and parameters as text."""
        return f"uniform({self.lower:g}, {self.upper:g})"
