# SPDX-License-Identifier: MIT
"""Priors that a person states: of single parameters, or an earlier calibration's posterior."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.bayes.priors import Prior
from model.errors import DomainError

FEWEST_DRAWS: Final = 200
"""Draws of an earlier posterior that its mean and covariance need."""
_LOST = 0.01  # share of draws outside the support of the new fit's parameters that is left out
_LEAST = 1e-6  # least eigenvalue of a correlation matrix, which its inverse needs


@dataclass(frozen=True)
class EarlierPosterior:
    """Posterior of an earlier calibration, which is taken as a joint prior.

    Attributes:
        draws: Draws of each parameter's value by name, shape (n,) each, row by row of one draw.
        origin: Name of the calibration, for tables.
    """

    draws: Mapping[str, Array]
    origin: str


@dataclass(frozen=True)
class StatedPriors:
    """What is known beforehand, beside the default priors.

    Attributes:
        single: Prior of a parameter by name; names that a law lacks do not apply to it.
        earlier: Posterior of an earlier calibration; None without one.
    """

    single: Mapping[str, Prior] = field(default_factory=dict)
    earlier: EarlierPosterior | None = None

    def names(self, among: Collection[str]) -> tuple[str, ...]:
        """Return which of some parameters have a prior that was stated."""
        earlier = () if self.earlier is None else self.earlier.draws
        return tuple(name for name in among if name in self.single or name in earlier)


UNSTATED: Final = StatedPriors()
"""Nothing that is known beforehand."""


@dataclass(frozen=True)
class Moved:
    """A prior moved and scaled in its standard normal coordinate: one margin of a joint Gaussian.

    Attributes:
        base: Prior whose coordinate it is.
        mean: Mean in that coordinate.
        sd: Standard deviation in that coordinate.
        origin: Where it comes from, for tables.
    """

    base: Prior
    mean: float
    sd: float
    origin: str

    def value(self, z: ArrayLike) -> Array:
        """Map standard normal coordinates z to values, those of the base prior at mean + sd z."""
        return self.base.value(self.mean + self.sd * np.asarray(z))

    def coordinate(self, value: ArrayLike) -> Array:
        """Map values to standard normal coordinates z, the inverse of `value`."""
        return (self.base.coordinate(value) - self.mean) / self.sd

    def describe(self) -> str:
        """Format the median and half the distance of the 16 and 84 % quantiles as text."""
        low, middle, high = (float(self.value(np.array(z))) for z in (-1.0, 0.0, 1.0))
        return f"{middle:.4g} ± {0.5 * (high - low):.2g} ({self.origin})"


@dataclass(frozen=True)
class PriorCorrelation:
    """Correlation of some parameters' coordinates before the data.

    With z independent standard normal, y = R^(1/2) z has the correlation R; the symmetric root
    leaves each y nearest to the z of the same parameter.

    Attributes:
        names: The parameters.
        matrix: Correlation matrix R of their coordinates, shape (m, m).
    """

    names: tuple[str, ...]
    matrix: Array

    @cached_property
    def _eigen(self) -> tuple[Array, Array]:
        """Eigenvalues of R, at least `_LEAST`, shape (m,), and eigenvectors in columns, (m, m)."""
        values, vectors = np.linalg.eigh(self.matrix)
        return np.maximum(values, _LEAST), vectors

    def root(self, order: Collection[str], *, inverse: bool = False) -> Array:
        """Return R^(1/2), or its inverse, for all parameters in a given order, shape (d, d).

        It is the identity for parameters that are not in the correlation.

        Args:
            order: Names of all d free parameters; those of the correlation are among them.
            inverse: Whether to return the inverse.
        """
        values, vectors = self._eigen
        part = (vectors * values ** (-0.5 if inverse else 0.5)) @ vectors.T
        index = [list(order).index(name) for name in self.names]
        whole = np.eye(len(order))
        whole[np.ix_(index, index)] = part
        return whole


def with_stated(
    priors: Mapping[str, Prior], stated: StatedPriors, *, fixed: Collection[str] = ()
) -> tuple[dict[str, Prior], PriorCorrelation | None]:
    """Replace default priors by those that were stated.

    The earlier posterior is taken as Gaussian in the standard normal coordinates of the default
    priors (Gaussian in the logarithm of a positive parameter), with the mean and covariance of its
    draws there.

    Args:
        priors: Default prior of each parameter by name.
        stated: What is known beforehand.
        fixed: Names of parameters that are not sampled.

    Returns:
        Prior of each parameter, and the correlation of those of the earlier posterior; None without
        one.

    Raises:
        DomainError: A parameter has a prior of its own and one of the earlier posterior. Or fewer
            than `FEWEST_DRAWS` of the earlier posterior's draws lie inside the default priors'
            support, or over 1 % outside.
        ValueError: The earlier posterior has draws of no free parameter (raised by NumPy).
    """
    changed = {**priors, **{k: v for k, v in stated.single.items() if k in priors}}
    earlier = stated.earlier
    if earlier is None:
        return changed, None
    names = tuple(name for name in priors if name in earlier.draws and name not in fixed)
    twice = [name for name in names if name in stated.single]
    if twice:
        raise DomainError(
            f"{', '.join(twice)}: a prior of its own, and one from {earlier.origin}; state one of "
            "them"
        )
    z = _coordinates({name: priors[name] for name in names}, earlier)
    sd = z.std(axis=0, ddof=1)
    for name, mean, spread in zip(names, z.mean(axis=0), sd, strict=True):
        changed[name] = Moved(priors[name], float(mean), float(spread), earlier.origin)
    return changed, PriorCorrelation(names, np.atleast_2d(np.corrcoef(z.T)))


def _coordinates(priors: Mapping[str, Prior], earlier: EarlierPosterior) -> Array:
    """Map draws of an earlier posterior to standard normal coordinates, shape (n, m).

    Draws outside the support are left out; `DomainError` as of `with_stated`.
    """
    with np.errstate(all="ignore"):
        z = np.column_stack([prior.coordinate(earlier.draws[n]) for n, prior in priors.items()])
    inside = np.isfinite(z).all(axis=1)
    if inside.sum() < FEWEST_DRAWS:
        raise DomainError(
            f"{earlier.origin} has {inside.sum()} usable draws; a prior needs {FEWEST_DRAWS}"
        )
    if np.mean(~inside) > _LOST:
        raise DomainError(
            f"{np.mean(~inside):.0%} of the draws of {earlier.origin} lie outside what this fit "
            "allows; was it made by another version, or for another law?"
        )
    return z[inside]
