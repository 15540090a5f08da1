# SPDX-License-Identifier: MIT
"""Targets of an experiment: quantities of a slip law, linear in the prior's coordinates."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.checks.linear import STEP
from model.bayes.posterior import SlipPosterior
from model.errors import InsufficientData

FLAT = 1e-3  # share of the load below which a force is too small to state a relative error of it


@dataclass(frozen=True)
class Target:
    """A quantity, or several that count as one, around draws of the posterior.

    Attributes:
        name: As it was asked for.
        parts: Name of each part.
        units: Unit of each part's standard deviation; "dimensionless" for relative ones.
        rows: Derivative of each part by the coordinates, around each draw, shape (m, parts, d).
    """

    name: str
    parts: tuple[str, ...]
    units: tuple[str, ...]
    rows: Array

    def log_sd(self, covariance: Array) -> Array:
        """Compute the log standard deviation of each part around each draw, shape (m, parts).

        Variances below 1e-300 count as that.

        Args:
            covariance: Covariance of the coordinates around each draw, shape (m, d, d).
        """
        variance = np.einsum("mpi,mij,mpj->mp", self.rows, covariance, self.rows)
        return 0.5 * np.log(np.maximum(variance, 1e-300))

    def sds(self, covariance: Array) -> Array:
        """Compute the standard deviation of each part, a geometric mean over draws, (parts,)."""
        return np.exp(self.log_sd(covariance).mean(axis=0))


def parameter_target(posterior: SlipPosterior, z: Array, name: str) -> Target:
    """Return the target that is one parameter, in its own unit.

    Args:
        posterior: Law and priors, not straightened.
        z: Draws of the coordinates, shape (m, d).
        name: Name of the parameter.

    Raises:
        ValueError: The posterior has no parameter of this name.
    """
    names = [p.name for p in posterior.parameters]
    parameter = posterior.parameters[names.index(name)]
    rows = _derivative(z, lambda at: posterior.values(at)[:, names.index(name), None])
    return Target(name, (name,), (parameter.unit,), rows)


def force_target(
    posterior: SlipPosterior, z: Array, *, name: str, slips: Array, loads: Array
) -> Target:
    """Return the target that is traction at every pair of slip and load, relative to its size.

    Args:
        posterior: Law and priors, not straightened.
        z: Draws of the coordinates, shape (m, d).
        name: Name of the target.
        slips: Slip ratios, shape (s,) [-].
        loads: Normal forces, shape (l,) [N].

    Raises:
        InsufficientData: At one of the slips and loads the traction around a draw is below `FLAT`
            of the load.
    """
    slip, load = (each.ravel() for each in np.meshgrid(slips, loads))
    size, rows = force_rows(posterior, z, slip=slip, load=load)
    flat = (np.abs(size) < FLAT * load).any(axis=0)
    if flat.any():
        raise InsufficientData(
            f"traction at slip {slip[flat][0]:g} and load {load[flat][0]:g} N is nearly zero, and "
            "its uncertainty is relative to its size; ask for another slip"
        )
    parts = tuple(f"force@{a:g}:{b:g}" for a, b in zip(slip, load, strict=True))
    units = ("dimensionless",) * len(parts)
    return Target(name, parts, units, rows / np.abs(size)[..., None])


def force_rows(
    posterior: SlipPosterior, z: Array, *, slip: Array, load: Array
) -> tuple[Array, Array]:
    """Compute traction (m, n) [N] and its derivative by the coordinates, (m, n, d) [N].

    Args:
        posterior: Law and priors, not straightened.
        z: Draws of the coordinates, shape (m, d).
        slip: Slip ratios, shape (n,) [-].
        load: Normal forces, shape (n,) [N].
    """
    k = len(posterior.law.parameters)

    def force(at: Array) -> Array:
        """Compute the traction at coordinates (m, d), shape (m, n) [N]."""
        return posterior.law.force(slip, load, posterior.values(at)[:, :k].T[:, :, None])

    return force(z), _derivative(z, force)


def regressed_target(
    name: str, drawn: Array, values: Array, *, parts: tuple[str, ...],
    units: tuple[str, ...], n_draws: int,
) -> Target:  # fmt: skip
    """Return the target whose derivatives are slopes of a linear regression over draws.

    The slope is zero in directions in which the draws do not differ (least squares of least norm),
    as nothing is known of these; standardising the draws makes this independent of their spread.

    Args:
        name: Name of the target.
        drawn: Coordinates of the draws, 0 where a coordinate plays no part, shape (w, d).
        values: Quantities of each draw, shape (w, parts).
        parts: Name of each quantity.
        units: Unit of each quantity.
        n_draws: Number of draws m around which the target is asked for.

    Raises:
        InsufficientData: There are fewer than two draws more than coordinates that differ, or a
            quantity is the same in every draw.
    """
    spread = drawn.std(axis=0)
    differ = spread > 0
    if len(drawn) < 2 + differ.sum() or (np.ptp(values, axis=0) == 0).any():
        raise InsufficientData(
            f"{len(drawn)} computed draws of {name} tell no slope along {differ.sum()} coordinates"
        )
    centred = (drawn - drawn.mean(axis=0))[:, differ] / spread[differ]
    slopes = np.linalg.lstsq(centred, values - values.mean(axis=0), rcond=1e-6)[0]
    rows = np.zeros((len(parts), drawn.shape[1]))
    rows[:, differ] = (slopes / spread[differ][:, None]).T
    return Target(name, parts, units, np.broadcast_to(rows, (n_draws, *rows.shape)).copy())


def _derivative(z: Array, of: Callable[[Array], Array]) -> Array:
    """Differentiate a function by central differences of `STEP` around each z (m, d).

    `of` maps coordinates (m, d) to p quantities (m, p). The result has shape (m, p, d).
    """
    steps = STEP * np.eye(z.shape[1])
    columns = [(of(z + step) - of(z - step)) / (2 * STEP) for step in steps]
    return np.stack(columns, axis=-1)
