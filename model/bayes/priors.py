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
from scipy.special import erf, erfinv, log_ndtr, ndtr, ndtri, ndtri_exp

from model.slip.law import Array


class Prior(Protocol):
    """A distribution of one parameter."""

    def value(self, z: ArrayLike) -> Array:
        """Map a standard normal coordinate to the parameter's value; increasing in z."""
        ...

    def coordinate(self, value: ArrayLike) -> Array:
        """Map a value to its coordinate, the inverse of `value`."""
        ...

    def describe(self) -> str:
        """Format the distribution as text, for tables and files."""
        ...


@dataclass(frozen=True)
class Normal:
    """Gaussian.

    Attributes:
        mean: Mean, in the parameter's unit.
        sd: Standard deviation, in the parameter's unit.
    """

    mean: float
    sd: float

    def value(self, z: ArrayLike) -> Array:
        """Map a standard normal coordinate to the value."""
        return self.mean + self.sd * np.asarray(z)

    def coordinate(self, value: ArrayLike) -> Array:
        """Map a value to its coordinate."""
        return (np.asarray(value) - self.mean) / self.sd

    def describe(self) -> str:
        """Spell the distribution out."""
        return f"normal(mean {self.mean:g}, sd {self.sd:g})"


@dataclass(frozen=True)
class LogNormal:
    """Positive, with a Gaussian logarithm.

    Attributes:
        median: Median, in the parameter's unit.
        spread: Standard deviation of the natural logarithm.
    """

    median: float
    spread: float

    def value(self, z: ArrayLike) -> Array:
        """Map a standard normal coordinate to the value."""
        return self.median * np.exp(self.spread * np.asarray(z))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map a value to its coordinate."""
        return np.log(np.asarray(value) / self.median) / self.spread

    def describe(self) -> str:
        """Spell the distribution out."""
        return f"lognormal(median {self.median:g}, spread {self.spread:g})"


@dataclass(frozen=True)
class BelowOne:
    """Below 1 by a log-normal gap: for the curvature factor E, which must not exceed 1.

    Attributes:
        gap: Median of 1 - value.
        spread: Standard deviation of log(1 - value).
    """

    gap: float
    spread: float

    def value(self, z: ArrayLike) -> Array:
        """Map a standard normal coordinate to the value."""
        return 1.0 - self.gap * np.exp(-self.spread * np.asarray(z))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map a value to its coordinate."""
        return -np.log((1.0 - np.asarray(value)) / self.gap) / self.spread

    def describe(self) -> str:
        """Spell the distribution out."""
        return f"1 - lognormal(median {self.gap:g}, spread {self.spread:g})"


@dataclass(frozen=True)
class HalfNormal:
    """Non-negative, the upper half of a Gaussian: for the spread of offsets.

    Attributes:
        scale: Standard deviation of the whole Gaussian, in the parameter's unit.
    """

    scale: float

    def value(self, z: ArrayLike) -> Array:
        """Map a standard normal coordinate to the value."""
        # |N| has lower tail Phi(z) and upper tail Phi(-z); each keeps its digits where it is small.
        z = np.asarray(z, dtype=float)
        small = math.sqrt(2) * erfinv(ndtr(z))
        return self.scale * np.where(z < 0, small, -ndtri_exp(log_ndtr(-z) - math.log(2)))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map a value to its coordinate."""
        x = np.asarray(value, dtype=float) / self.scale
        return np.where(x < 0.67, ndtri(erf(x / math.sqrt(2))), -ndtri(2 * ndtr(-x)))

    def describe(self) -> str:
        """Spell the distribution out."""
        return f"half-normal(scale {self.scale:g})"


@dataclass(frozen=True)
class Uniform:
    """Flat between two bounds.

    Attributes:
        lower: Lower bound, in the parameter's unit.
        upper: Upper bound, in the parameter's unit.
    """

    lower: float
    upper: float

    def value(self, z: ArrayLike) -> Array:
        """Map a standard normal coordinate to the value."""
        return self.lower + (self.upper - self.lower) * ndtr(np.asarray(z, dtype=float))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map a value to its coordinate."""
        return ndtri((np.asarray(value, dtype=float) - self.lower) / (self.upper - self.lower))

    def describe(self) -> str:
        """Spell the distribution out."""
        return f"uniform({self.lower:g}, {self.upper:g})"
