# SPDX-License-Identifier: MIT
"""Result of the fit of a slip law: estimates, curve, checks and verdict."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from model.bayes.averaging.load_levels import largest_slips, middle_loads
from model.bayes.checks.inspection import inspect
from model.bayes.checks.linear import linearise
from model.bayes.cross_validation import r_squared
from model.bayes.drawing.convergence import Convergence
from model.bayes.drawing.importance import WeightedDraws
from model.bayes.estimate import (
    Agreement,
    Draws,
    Estimate,
    agreement,
    contraction,
    curve_estimates,
    estimate,
)
from model.bayes.fit import PreparedFit
from model.bayes.law_scores import LawComparison, LawScores
from model.bayes.posterior import SlipPosterior
from model.bayes.prior_conflict import PriorShift, prior_shifts
from model.bayes.residuals import Residuals, analyse_residuals
from model.bayes.run_out import RunOut
from model.bayes.verdict import Verdict, judge
from model.slip.samples import SlipSamples

_CHECKED = 400  # about this many draws are used for residuals and verdict


@dataclass(frozen=True)
class Calibration:
    """The finished fit of a slip law, with its checks.

    Attributes:
        fit: Posterior density, Laplace approximations, cross-validation and block length.
        comparison: Comparison of several laws; None if there was only one.
        draws: Posterior draws, one row an ensemble.
        parameters: Posterior of every parameter, fixed ones included: the law's, then the
            measurement's.
        levels: Median measured load at each load that was set, by `middle_loads`, shape (m,) [N].
        curves: Posterior of the curve's features, as by `curve_estimates`, at each load level.
        convergence: Convergence diagnostics of the sampler.
        residuals: Analysis of the residuals.
        agreement: Comparison of the sampler's draws with importance sampling; None where the
            posterior was not sampled, and the draws are weighted ones.
        verdict: Whether the fit converged and can be trusted.
        contraction: 1 - posterior over prior variance of each sampled parameter, by name [-].
        r_squared: Fraction of the variance of measured traction explained by predictions of
            left-out runs; None without cross-validation [-].
        source: Where the data come from: "real", "sim:...", "unknown" and others.
        seconds: Time that sampling or weighting took, without that of the chains it resumed
            from [s].
        prior_shifts: Comparison of each stated prior with the data.
        run_out: Run-out of the discs by angle, and whether slip is corrected for it; None where no
            angle is recorded, or nothing tells it.
    """

    fit: PreparedFit
    comparison: LawComparison | LawScores | None
    draws: Draws
    parameters: Sequence[Estimate]
    levels: np.ndarray
    curves: Sequence[Sequence[Estimate]]
    convergence: Convergence
    residuals: Residuals
    agreement: Agreement | None
    verdict: Verdict
    contraction: Mapping[str, float]
    r_squared: float | None
    source: str
    seconds: float
    prior_shifts: tuple[PriorShift, ...] = ()
    run_out: RunOut | None = None

    @property
    def posterior(self) -> SlipPosterior:
        """The posterior that was sampled."""
        return self.fit.posterior


def conclude(
    fit: PreparedFit,
    comparison: LawComparison | LawScores | None,
    draws: Draws,
    convergence: Convergence,
    samples: SlipSamples,
    *,
    weighted: WeightedDraws | None,
    source: str,
    seconds: float,
) -> Calibration:
    """Compute estimates, residuals, checks and verdict from the draws of a fit.

    Residuals and verdict use about `_CHECKED` of the draws.

    Args:
        fit: The fit.
        comparison: Comparison of several laws; None if there was only one.
        draws: Draws of its posterior.
        convergence: Convergence diagnostics of the draws.
        samples: The samples that were fitted, here for R² of the left-out runs.
        weighted: Weighted draws of the Laplace approximation, to compare with; None where these
            are the draws.
        source: Source of the samples.
        seconds: Time that sampling took [s].

    Raises:
        LinAlgError: The covariance of a run's blocks is singular.
    """
    posterior = fit.posterior
    some = draws.flat[:: max(1, len(draws.flat) // _CHECKED)]
    residuals = analyse_residuals(posterior.blocks, posterior.law, some)
    narrowed = contraction(posterior, draws)
    levels = middle_loads(posterior.blocks)
    validation = fit.cross_validation
    compared = None if weighted is None else agreement(draws, weighted, convergence)
    centred = linearise(posterior, draws.z.reshape(-1, draws.z.shape[-1]))
    return Calibration(
        fit=fit,
        comparison=comparison,
        draws=draws,
        parameters=[
            estimate(parameter, draws.flat[:, i])
            for i, parameter in enumerate(posterior.parameters)
        ],
        levels=levels,
        curves=_curves(posterior, draws, levels),
        convergence=convergence,
        residuals=residuals,
        agreement=compared,
        verdict=judge(
            blocks=posterior.blocks,
            law=posterior.law,
            values=some,
            contraction={**narrowed, **_known(fit, draws)},
            convergence=convergence,
            residuals=residuals,
            agreement=compared,
            inspection=inspect(posterior, centred, samples, fit.block_choice),
            offset_scale=fit.load_cell.zero_stability,
        ),
        contraction=narrowed,
        r_squared=None
        if validation is None
        else r_squared(samples.traction_force, validation.predict(samples, posterior.law)),
        source=source,
        seconds=seconds,
        prior_shifts=prior_shifts(posterior, fit.stated, draws.z.reshape(-1, draws.z.shape[-1])),
    )


def _known(fit: PreparedFit, draws: Draws) -> dict[str, float]:
    """Compute the contraction of each parameter with a stated prior, relative to its default prior.

    That is 1 - posterior over prior variance, by name. A parameter that somebody knows well
    beforehand is not weakly identified if the data add little to the stated prior.
    """
    names = [p.name for p in fit.posterior.parameters]
    stated = fit.stated.names([p.name for p in fit.posterior.free])
    own = (fit.defaults[name].coordinate(draws.flat[:, names.index(name)]) for name in stated)
    return {name: float(1 - np.var(each)) for name, each in zip(stated, own, strict=True)}


def _curves(posterior: SlipPosterior, draws: Draws, levels: np.ndarray) -> list[Sequence[Estimate]]:
    """Estimate features of the slip curve at each load level [N], up to the largest slip there."""
    k = len(posterior.law.parameters)
    return [
        curve_estimates(posterior.law, draws.flat[:, :k], load=load, slip_limit=float(limit))
        for load, limit in zip(levels, largest_slips(posterior.blocks), strict=True)
    ]
