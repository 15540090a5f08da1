# SPDX-License-Identifier: MIT
"""Choice of the degrees of freedom of Student-t noise, by the evidence of each."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from model.bayes.laplace import LaplaceMixture
from model.bayes.posterior import SlipPosterior
from model.bayes.student import TAILS
from model.bayes.tails import approximate


@dataclass(frozen=True)
class TailChoice:
    """Posterior with the degrees of freedom that explain the data best.

    Attributes:
        posterior: The posterior with these degrees of freedom.
        approximation: Its Laplace approximations.
        gain: Log evidence of each number of degrees of freedom minus that of Gaussian noise [-].
    """

    posterior: SlipPosterior
    approximation: LaplaceMixture
    gain: Mapping[float, float]


def choose_tail(posterior: SlipPosterior, approximation: LaplaceMixture) -> TailChoice:
    """Choose the degrees of freedom of Student-t noise by the Laplace approximations' evidence.

    The searches for modes with each of `TAILS`, the largest first, start at the modes with the
    number before. The choice is fixed in the fit: by symmetry the noise's shape says nothing of
    where the curve lies.

    Args:
        posterior: The posterior with Gaussian noise.
        approximation: Its Laplace approximations.

    Raises:
        FitError: With Student-t noise no mode was found.
    """
    gauss = _log_evidence(approximation)
    found: dict[float, tuple[SlipPosterior, LaplaceMixture]] = {}
    starts = np.stack([laplace.mode for laplace in approximation.modes])
    for tail in sorted(TAILS, reverse=True):
        own = replace(posterior, tail=tail)
        found[tail] = own, approximate(own.log_density, starts)
        starts = np.stack([laplace.mode for laplace in found[tail][1].modes])
    gain = {tail: _log_evidence(modes) - gauss for tail, (_, modes) in found.items()}
    best = max(gain, key=lambda tail: gain[tail])
    return TailChoice(*found[best], gain)


def _log_evidence(approximation: LaplaceMixture) -> float:
    """Compute the log of the integral of a density by all of its Laplace approximations."""
    evidence = [laplace.log_evidence() for laplace in approximation.modes]
    return float(np.asarray(logsumexp(evidence)))
