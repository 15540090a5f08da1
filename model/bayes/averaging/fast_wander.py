# SPDX-License-Identifier: MIT
r"""Whether fast fluctuation of measured slip is noise of the speeds or real wander of the slip.

Wander that is slower than a few samples is told from noise by its correlation in time. Faster
wander looks like noise; only the force knows it, because force follows true slip and nothing of the
sensors' noise. With the residual e of the traction, the slope :math:`f_\kappa` of the curve and the
measured slip :math:`\hat\kappa = \kappa + \nu`, :math:`e/f_\kappa = \epsilon - \nu`: the
covariance of :math:`\hat\kappa(t)` with :math:`e(t + l)/f_\kappa` is minus the variance of the
noise at the lag l = 0, and zero elsewhere. Where traction comes a little late the covariance with
true slip moves to other lags, so that the lags up to `REACH` are added, less what the lags beyond
let expect there.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from model.arrays import Array
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.slip.samples import SlipSamples

REACH = 2  # samples by which traction may be late or early
FAR = 6  # lags from there on to this one tell the covariance of slow wander
PIECE = 250  # samples of a piece of a run, whose scatter tells how sure the estimate is
SURE = 3.0  # standard deviations, from which there is wander in what looks like noise


@dataclass(frozen=True)
class FastWander:
    """Estimate of how much of the white part of measured slip is wander of the true slip.

    Attributes:
        share: Share of its variance; 0 is noise of the speeds alone, 1 wander alone. Estimates may
            lie outside by their error [-].
        sd: Standard deviation of the share, from the scatter between pieces of runs [-].
    """

    share: float
    sd: float

    @property
    def used(self) -> float:
        """Share that blocks are made with: at most 1, and 0 unless above `SURE` times `sd` [-]."""
        return min(self.share, 1.0) if self.share > SURE * self.sd else 0.0


def fast_wander(samples: SlipSamples, residual: Array, slope: Array) -> FastWander | None:
    """Estimate how much of the white part of measured slip the force follows.

    Pieces of runs are weighted by how well each tells the variance of the noise: by the square of
    the slope over the variance of the fast part of the residual.

    Args:
        samples: The samples, n of them.
        residual: Measured minus predicted traction of each sample, shape (n,) [N].
        slope: Slope of force in slip of each sample, shape (n,) [N].

    Returns:
        The estimate; None where fewer than three pieces of runs have 4 `FAR` samples, a white part
        of the slip, a mean slope other than zero and residuals that vary.
    """
    white = slip_noise_variance(samples)
    noise, weight, typical = [], [], []
    for part, own in zip(samples.slices(), white, strict=True):
        pieces = max(1, round((part.stop - part.start) / PIECE))
        edges = np.linspace(part.start, part.stop, pieces + 1).astype(int)
        for first, last in pairwise(edges.tolist()):
            steep = float(slope[first:last].mean()) if last > first else 0.0
            if last - first < 4 * FAR or steep == 0 or own == 0:
                continue
            error = residual[first:last]
            scatter = 0.5 * float(np.var(np.diff(error)))
            told = (last - first) * steep**2 / scatter if scatter > 0 else 0.0
            if told > 0:  # not of a curve so flat that the square of its slope is none
                noise.append(_noise_variance(samples.slip[first:last], error) / steep)
                weight.append(told)
                typical.append(float(own))
    if len(noise) < 3:
        return None
    v, w = np.array(noise), np.array(weight) / np.sum(weight)
    whole = float(w @ np.array(typical))
    mean = float(w @ v)
    sd = float(np.sqrt(np.sum((w * (v - mean)) ** 2) / max(1 - np.sum(w**2), 1e-9)))
    return FastWander(1 - mean / whole, sd / whole)


def _noise_variance(slip: Array, error: Array) -> float:
    """Estimate the variance of slip that force does not follow, times the slope of the curve [N].

    Args:
        slip: Measured slip of one piece of a run, shape (n,) [-].
        error: Residual of the force there, shape (n,) [N].
    """
    x, y = slip - slip.mean(), error - error.mean()
    n = len(x)
    both = [float(x @ y)] + [
        0.5 * float(x[lag:] @ y[: n - lag] + x[: n - lag] @ y[lag:]) for lag in range(1, FAR + 1)
    ]
    return -float(_NUGGET @ np.array(both)) / n


def _nugget_weights() -> Array:
    """Compute the weights of lags 0 to `FAR` that sum lags up to `REACH` less a line beyond.

    The line is fitted by least squares to the lags beyond `REACH`, over the absolute value of the
    lag; each lag but zero counts twice. Shape (FAR + 1,).
    """
    near, far = np.arange(REACH + 1), np.arange(REACH + 1, FAR + 1)
    twice = np.where(near > 0, 2.0, 1.0)
    line = np.linalg.pinv(np.column_stack([np.ones(len(far)), far]))
    return np.concatenate([twice, -twice @ np.column_stack([np.ones(len(near)), near]) @ line])


_NUGGET = _nugget_weights()
