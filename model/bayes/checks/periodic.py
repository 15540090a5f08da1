# SPDX-License-Identifier: MIT
"""Whether residuals swing with a period, as a disc that runs out of true makes them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from model.arrays import Array
from model.bayes.checks.linear import Linearised, whiten
from model.slip.samples import SlipSamples

FREQUENCIES = 60
FEWEST_BLOCKS = 4  # a run, to hold a swing
PER_PERIOD = 2.2  # blocks that a period has at least


@dataclass(frozen=True)
class Swing:
    """A swing of the residuals that runs share, each with a phase of its own.

    Attributes:
        period: Its period, in the unit of time that was given; of a swing with the angle of the
            ground disc the period at zero slip.
        slip: Amplitude in slip that would make it [-].
        p: Probability of one as large by chance, at all periods tried [-].
    """

    period: float
    slip: float
    p: float


def block_times(fit: Linearised, samples: SlipSamples) -> Array:
    """Return the mean time of each block, shape (n,) [s]; in samples if samples have no times."""
    time = np.arange(len(samples), dtype=float) if samples.time is None else samples.time
    starts = np.append(0, np.cumsum(fit.blocks.count)[:-1])
    return np.add.reduceat(time, starts) / np.diff(np.append(starts, len(time)))


def find_swing(fit: Linearised, time: Array) -> Swing | None:
    """Find the period at which slip swings most, with the angle of either disc.

    Residuals are fitted, run by run, with the slope of the curve times a sine and a cosine: of
    constant frequency (the leg disc's speed is constant), or in proportion to 1 - slip (the ground
    disc's). Their chi-square over all runs is compared with the typical one of other frequencies.
    Periods reach from `PER_PERIOD` blocks to the median run of those of `FEWEST_BLOCKS` or more.

    Args:
        fit: The linearised fit.
        time: Time of each block, shape (n,).

    Returns:
        The swing; None where no run has `FEWEST_BLOCKS` blocks, or no period is between these.
    """
    blocks = fit.blocks
    sizes = np.bincount(blocks.run)
    long = sizes >= FEWEST_BLOCKS
    if not long.any():
        return None
    start = time[blocks.run_starts()[:-1]]
    since = time - start[blocks.run]
    length = float(np.median(np.maximum.reduceat(since, blocks.run_starts()[:-1])[long]))
    step = length / max(float(np.median(sizes[long])) - 1, 1)
    if length <= 0 or 1 / length >= 1 / (PER_PERIOD * step):
        return None
    frequency = np.linspace(1 / length, 1 / (PER_PERIOD * step), FREQUENCIES)
    best: Swing | None = None
    for speed in (np.ones_like(since), np.abs(1 - blocks.slip)):
        found = _most(fit, since * speed, frequency, long)
        if best is None or found.p < best.p:
            best = found
    return best


def _most(fit: Linearised, since: Array, frequency: Array, long: NDArray[np.bool_]) -> Swing:
    """Return the swing of the frequency, of shape (m,), that explains most of the residuals.

    The chi-square is divided by the median one over its degrees of freedom, if that is above 1. The
    p-value is multiplied by the number of frequencies and by 2, as two discs are tried.
    """
    blocks = fit.blocks
    white = whiten(blocks, fit.residual[:, None], fit.factors)[:, 0]
    white = white / np.sqrt(np.mean(white**2))
    squares = np.empty((FREQUENCIES, blocks.n_runs))
    for i, each in enumerate(frequency):
        angle = 2 * np.pi * each * since
        waves = fit.predicted.slope[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        squares[i] = _explained(fit, whiten(blocks, waves, fit.factors), white)
    total = squares[:, long].sum(axis=1)
    freedom = 2 * int(long.sum())
    top = int(np.argmax(total))
    usual = max(1.0, float(np.median(total)) / freedom)
    p = min(1.0, 2 * FREQUENCIES * float(chdtrc(freedom, total[top] / usual)))
    return Swing(1 / float(frequency[top]), _amplitude(fit, total[top], freedom), p)


def _explained(fit: Linearised, waves: Array, white: Array) -> Array:
    """Compute the chi-square of whitened residuals by two whitened waves, of each run (n_runs,)."""
    starts = fit.blocks.run_starts()[:-1]
    cc, ss, cs = (
        np.add.reduceat(waves[:, a] * waves[:, b], starts) for a, b in ((0, 0), (1, 1), (0, 1))
    )
    c, s = (np.add.reduceat(waves[:, a] * white, starts) for a in (0, 1))
    determinant = np.maximum(cc * ss - cs**2, 1e-12 * np.maximum(cc * ss, 1e-300))
    return (ss * c**2 + cc * s**2 - 2 * cs * c * s) / determinant


def _amplitude(fit: Linearised, square: float, freedom: int) -> float:
    """Return the amplitude in slip that explains a chi-square beyond `freedom`; 0 if below [-]."""
    slope = whiten(fit.blocks, fit.predicted.slope[:, None], fit.factors)[:, 0]
    return float(np.sqrt(max(square - freedom, 0.0) / max(0.5 * float(slope @ slope), 1e-300)))
