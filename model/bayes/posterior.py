# SPDX-License-Identifier: MIT
"""Posterior density of a slip law's and the measurement's parameters, given block means."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.drawing.shear import Shear
from model.bayes.likelihood import NUISANCE, run_log_likelihood
from model.bayes.priors import Below, HalfNormal, LogNormal, Normal, Prior, StudentT, Uniform
from model.bayes.stated_priors import PriorCorrelation
from model.slip.law import Parameter, SlipLaw
from model.slip.rig_errors import USUAL, RigErrors


@dataclass(frozen=True)
class LoadCell:
    """Prior knowledge of the load cell, from its certificate or a check with weights.

    Attributes:
        zero_stability: Scale of the half-normal prior of the standard deviation of the force
            offsets between runs [N].
        gain_sd: Standard deviation of each channel's relative gain error, about 0 [-].
        bias_sd: Standard deviation of the normal channel's zero error, about 0 [N].
        crosstalk_sd: Standard deviation of the crosstalk, about 0: normal force that the normal
            channel misses for each newton of traction [-].
    """

    zero_stability: float = 0.15
    gain_sd: float = 0.005
    bias_sd: float = 0.05
    crosstalk_sd: float = 0.005


def default_priors(
    law: SlipLaw,
    blocks: SlipBlocks,
    load_cell: LoadCell,
    rig_errors: RigErrors = USUAL,
) -> dict[str, Prior]:
    """Choose the prior of every parameter of a law and of the measurement, by name.

    Priors of the law are broad. Only scales come from the data: the median load (for the peak slip)
    and the largest traction (for the noise). Priors of the load cell's errors are as narrow as
    `load_cell` says, those of the rig's errors as `rig_errors` says. Any other parameter has that
    of its bounds and typical values, by `_of_parameter`.

    Args:
        law: The slip law.
        blocks: The block means.
        load_cell: Prior knowledge of the load cell.
        rig_errors: Prior knowledge of the rig's geometry and rolling resistance.
    """
    load_scale = float(np.median(blocks.normal_force))
    force_scale = float(np.abs(blocks.traction_force).max())
    known: dict[str, Prior] = {
        "peak_slip_per_load": LogNormal(0.1 / load_scale, 1.0),
        "gain_traction": Normal(0.0, load_cell.gain_sd),
        "gain_normal": Normal(0.0, load_cell.gain_sd),
        "bias_normal": Normal(0.0, load_cell.bias_sd),
        "crosstalk": Normal(0.0, load_cell.crosstalk_sd),
        "radius_error": Normal(0.0, rig_errors.radius_ratio),
        "rolling_resistance": StudentT(0.0, rig_errors.rolling_resistance),
        "slip_error_scale": LogNormal(1.0, 0.5),
        "slip_scatter": HalfNormal(rig_errors.slip_scatter),
        "noise_floor": LogNormal(0.02 * force_scale, 1.5),
        "noise_correlation": Uniform(-0.5, 0.99),
        "offset_spread": HalfNormal(load_cell.zero_stability),
    }
    return {p.name: known.get(p.name) or _of_parameter(p) for p in (*law.parameters, *NUISANCE)}


def _of_parameter(parameter: Parameter) -> Prior:
    """Choose a prior by which of a parameter's bounds are finite, and its `typical` values.

    Both finite: uniform between them. None: normal, `typical` its mean and standard deviation, (0,
    1) if not stated. Only the lower, or only the upper: log-normal in the distance from that bound,
    `typical` its median and the standard deviation of its logarithm, (1, 1.5) if not stated.
    """
    bounded = np.isfinite([parameter.lower, parameter.upper])
    if bounded.all():
        return Uniform(parameter.lower, parameter.upper)
    if not bounded.any():
        return Normal(*(parameter.typical or (0.0, 1.0)))
    median, spread = parameter.typical or (1.0, 1.5)
    if bounded[0]:
        return LogNormal(median, spread, parameter.lower)
    return Below(parameter.upper, median, spread)


@dataclass(frozen=True)
class SlipPosterior:
    """Posterior density in the standard normal coordinates z of the free parameters.

    The coordinates are independent a priori. Each parameter has a coordinate of its own, which its
    prior maps to the value; it is z, or for parameters that are correlated a priori the mixture of
    several z that has this correlation.

    With a shear z are straightened coordinates: those independent a priori are `shear.sheared(z)`.

    Shapes: w points, d free parameters, k parameters of the law.

    Attributes:
        blocks: The block means.
        law: The slip law.
        priors: Prior of each parameter by name.
        fixed: Value of each parameter that is not sampled, by name.
        correlation: Correlation of the parameters' own coordinates a priori; None without one.
        shear: Shear of the coordinates, of the same d; None without one.
    """

    blocks: SlipBlocks
    law: SlipLaw
    priors: Mapping[str, Prior]
    fixed: Mapping[str, float] = field(default_factory=dict)
    correlation: PriorCorrelation | None = None
    shear: Shear | None = None

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """All parameters: the law's, then the measurement's."""
        return (*self.law.parameters, *NUISANCE)

    @cached_property
    def free(self) -> tuple[Parameter, ...]:
        """The parameters that are sampled, in the order of z."""
        return tuple(p for p in self.parameters if p.name not in self.fixed)

    def own_coordinates(self, z: Array) -> Array:
        """Map coordinates z (..., d) to each parameter's own one, standard normal a priori."""
        return self._own(self.prior_coordinates(z))

    def prior_coordinates(self, z: Array) -> Array:
        """Map coordinates z (..., d) to those that are independent standard normal a priori."""
        return z if self.shear is None else self.shear.sheared(z)

    def _own(self, independent: Array) -> Array:
        """Map coordinates that are independent a priori, (..., d), to the own ones."""
        return independent if self.correlation is None else independent @ self._roots[0]

    @cached_property
    def _roots(self) -> tuple[Array, Array]:
        """Symmetric matrix from independent to own coordinates, and its inverse, (d, d) each."""
        if self.correlation is None:
            return np.eye(len(self.free)), np.eye(len(self.free))
        names = [p.name for p in self.free]
        return self.correlation.root(names), self.correlation.root(names, inverse=True)

    @cached_property
    def _check_loads(self) -> Array:
        """Minimum, quartiles and maximum of the measured loads, shape (5,) [N]."""
        return np.quantile(self.blocks.normal_force, [0.0, 0.25, 0.5, 0.75, 1.0])

    def values(self, z: Array) -> Array:
        """Map coordinates z (w, d) to values of all parameters, fixed ones too, (w, k + 11)."""
        return self._values(self.prior_coordinates(z))

    def _values(self, independent: Array) -> Array:
        """Map coordinates that are independent a priori to values of all parameters."""
        columns = iter(np.moveaxis(self._own(independent), -1, 0))
        return np.stack(
            [
                np.full(independent.shape[:-1], self.fixed[p.name])
                if p.name in self.fixed
                else self.priors[p.name].value(next(columns))
                for p in self.parameters
            ],
            axis=-1,
        )

    def coordinates(self, values: Mapping[str, float]) -> Array:
        """Map values by name to coordinates (d,); 0, the prior median, for names that are absent.

        Values of fixed parameters are ignored; a value outside its prior's support gives an
        infinite coordinate or NaN.
        """
        own = np.array(
            [
                self.priors[p.name].coordinate(values[p.name]) if p.name in values else 0.0
                for p in self.free
            ],
            dtype=float,
        )
        with np.errstate(invalid="ignore"):  # infinite outside the support
            y = own if self.correlation is None else own @ self._roots[1]
            return y if self.shear is None else self.shear.straightened(y)

    def log_prior(self, z: Array) -> Array:
        """Compute the log prior density at z (w, d), shape (w,).

        -inf where the law is not valid (see `SlipLaw.valid`) at one of the loads of `_check_loads`.
        """
        with np.errstate(all="ignore"):  # an optimiser may try coordinates beyond any number
            return self._prior_and_values(z)[0]

    def _prior_and_values(self, z: Array) -> tuple[Array, Array]:
        """Compute the log prior density (w,) and the values (w, k + 11) at z (w, d)."""
        independent = self.prior_coordinates(z)
        values = self._values(independent)
        law_values = values[:, : len(self.law.parameters)].T[:, :, None]
        valid = np.all(self.law.valid(self._check_loads, law_values), axis=-1)
        log_density = -0.5 * np.sum(independent**2 + np.log(2 * np.pi), axis=1)
        return np.where(valid, log_density, -np.inf), values

    def log_density(self, z: Array) -> Array:
        """Compute the log posterior density at z, up to a constant.

        Args:
            z: Coordinates, shape (w, d).

        Returns:
            Log density, shape (w,); -inf out of support, never NaN.
        """
        with np.errstate(all="ignore"):  # an optimiser may try coordinates beyond any number
            log_density, values = self._prior_and_values(z)
            inside = np.isfinite(log_density)
            if inside.any():
                log_density[inside] += self.run_log_likelihood_of(values[inside]).sum(axis=1)
        return np.where(np.isfinite(log_density), log_density, -np.inf)

    def run_log_likelihood(self, z: Array) -> Array:
        """Compute the log likelihood of each run's blocks given z (w, d), shape (w, n_runs)."""
        return self.run_log_likelihood_of(self.values(z))

    def run_log_likelihood_of(self, values: Array) -> Array:
        """Compute the log likelihood of each run's blocks given values (w, k + 11), (w, n_runs)."""
        return run_log_likelihood(self.blocks, self.law, values)

    def without_runs(self, left_out: NDArray[np.bool_]) -> "SlipPosterior":
        """Return the posterior with the same priors and fixed values, without data of some runs.

        Args:
            left_out: Whether to leave out each run, shape (n_runs,).
        """
        kept = self.blocks.select_runs(~left_out)
        return replace(self, blocks=kept)
