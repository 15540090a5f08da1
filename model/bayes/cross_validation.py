# SPDX-License-Identifier: MIT
"""Cross-validation over runs: fit without some runs, then predict them.

The run is the unit of replication.
"""

from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.bayes.drawing.laplace import Laplace, climb
from model.bayes.posterior import SlipPosterior
from model.slip.definition import SlipDefinition, slip_per_radius_error
from model.slip.law import SlipLaw
from model.slip.samples import SlipSamples
from model.tasks import compute_tasks

MAX_SINGLE_FOLDS = 20  # runs up to which each is left out alone
N_GROUPED_FOLDS = 10  # groups in which more runs are left out


@dataclass(frozen=True)
class CrossValidation:
    """Fits of one law without each fold of runs, and how they predict the left-out runs.

    Attributes:
        fold: Index of the fold in which each run was left out, shape (n_runs,).
        values: Law and measurement parameters at the posterior mode without each fold's runs,
            shape (n_folds, k + 11).
        log_density: Log density of each run's blocks at the mode without the run, (n_runs,) [-].
    """

    fold: NDArray[np.intp]
    values: Array
    log_density: Array

    @property
    def scheme(self) -> str:
        """Format as text how runs were left out, with the numbers of folds and runs."""
        n_folds = len(self.values)
        if n_folds == len(self.fold):
            return f"leave one run out, {n_folds} runs"
        return f"leave out {len(self.fold)} runs in {n_folds} interleaved groups"

    def predict(self, samples: SlipSamples, law: SlipLaw) -> Array:
        """Predict every sample's measured traction by the fit without its run, shape (n,) [N].

        Run offsets are left out, as by `measured_force`.

        Args:
            samples: The samples, n of them, of the same runs in the same order.
            law: The slip law.
        """
        predicted = np.empty(len(samples))
        for index, part in enumerate(samples.slices()):
            values = self.values[self.fold[index]]
            slip, load = samples.slip[part], samples.normal_force[part]
            predicted[part] = measured_force(law, values, slip, load, samples.definition)
        return predicted


def measured_force(
    law: SlipLaw, values: Array, slip: Array, normal_force: Array, definition: SlipDefinition
) -> Array:
    """Predict measured traction from measured slip and load, without run offset, shape (n,) [N].

    As in `model.bayes.likelihood`, crosstalk counts to first order: the predicted traction, not the
    measured one, corrects the load.

    A true load below 1e-9 N counts as 1e-9 N.

    Args:
        law: The slip law, of k parameters.
        values: Law and measurement parameters, of which gains, load bias, crosstalk, the error of
            the radii and rolling resistance are used, shape (k + 11,).
        slip: Slip ratio, shape (n,) [-].
        normal_force: Measured normal force, shape (n,) [N].
        definition: Definition of the slip ratios.
    """
    k = len(law.parameters)
    g_t, g_n, b_n, c, epsilon, c_r = values[k : k + 6]
    slip = slip - epsilon * slip_per_radius_error(slip, definition)

    def force(load: Array) -> Array:
        """Compute the measured traction at a true load, shape (n,) [N]."""
        return (1 + g_t) * (law.force(slip, load, values[:k]) - c_r * load)

    load = np.maximum((1 + g_n) * normal_force - b_n, 1e-9)
    return force(np.maximum(load + c * force(load), 1e-9))


def r_squared(measured: Array, predicted: Array) -> float:
    """Compute 1 minus the squared errors over the squared deviations from the mean, R² [-].

    It is not finite where the measured values are all the same.

    Args:
        measured: Measured values, shape (n,).
        predicted: Predictions of the measured values, in the same unit, shape (n,).
    """
    return float(
        1 - np.sum((measured - predicted) ** 2) / np.sum((measured - measured.mean()) ** 2)
    )


@dataclass(frozen=True)
class _Folds:
    """What the fits without each fold share.

    Attributes:
        posterior: The posterior of all runs.
        laplace: Approximation at its mode.
        fold: Index of each run's fold, shape (n_runs,).
    """

    posterior: SlipPosterior
    laplace: Laplace
    fold: NDArray[np.intp]


def cross_validate(
    posterior: SlipPosterior, laplace: Laplace, *, executor: Executor | None = None
) -> CrossValidation:
    """Find the posterior's mode without each fold of runs, and predict the runs left out.

    Up to 20 runs are left out one by one, more in 10 interleaved groups.

    Args:
        posterior: The posterior of all runs, at least two.
        laplace: Approximation at the mode of all runs, where each search starts.
        executor: Where the folds are fitted; None for here.

    Raises:
        FitError: Without a fold's runs the mode lies outside the posterior's support.
    """
    n_runs = posterior.blocks.n_runs
    n_folds = n_runs if n_runs <= MAX_SINGLE_FOLDS else N_GROUPED_FOLDS
    fold = np.arange(n_runs) % n_folds
    shared = _Folds(posterior, laplace, fold)
    found = compute_tasks(executor, partial(_fit_without, shared), range(n_folds))
    values = np.stack(list(found))
    density = posterior.run_log_likelihood_of(values)
    return CrossValidation(fold, values, density[fold, np.arange(n_runs)])


def _fit_without(folds: _Folds, index: int) -> Array:
    """Return the values of all parameters at the mode without a fold's runs, shape (k + 11,)."""
    kept = folds.posterior.without_runs(folds.fold == index)
    top = climb(kept.log_density, folds.laplace.mode[None], folds.laplace.covariance)
    return folds.posterior.values(top[None])[0]
