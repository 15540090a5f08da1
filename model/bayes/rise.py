# SPDX-License-Identifier: MIT
"""Whether the tested slips show how a slip curve rises to its peak, and the slips to add if not."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import load_levels, nearest_level
from model.slip.law import SlipLaw

SLIPS = 12  # slip ratios that are added at each load
_FIRST, _LAST = 0.15, 1.25  # of the peak's slip: where added slips begin and end


@dataclass(frozen=True)
class SampledRise:
    """Tested slips between zero and the slip of the curve's peak.

    Attributes:
        gap: Largest distance of neighbouring tested slips there, zero counted among them, over the
            peak's slip; 0 where the curve has no peak [-].
        loads: Load levels, shape (m,) [N].
        further: Slip ratios to measure at every load level, increasing in size and within the rise
            and a little beyond it; empty where the curve has no peak, shape (n,) [-].
    """

    gap: float
    loads: Array
    further: Array


def sampled_rise(blocks: SlipBlocks, law: SlipLaw, values: Array) -> SampledRise:
    """Find the largest gap in the tested slips below the peak, and the slips that would fill it.

    Slips count in units of the peak's slip at their load, those of all loads and of either sign
    together, because the law says how the curves of several loads belong together. The peak's slip
    is the median of its draws; the curve has no peak where that is infinite at all loads. Beyond
    the largest tested slip there is no gap: a curve may be wanted up to there.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 11).
    """
    levels = load_levels(blocks)
    k = len(law.parameters)
    peaks = law.peak_slip(levels, values[:, :k].T[:, :, None])
    peaks = np.broadcast_to(peaks, (len(values), len(levels)))  # of some laws the same at any load
    middle = np.median(peaks, axis=0)
    if not np.isfinite(middle).any():
        return SampledRise(0.0, levels, np.array([]))
    level = nearest_level(np.maximum(blocks.normal_force, 1e-9), levels)
    tested = np.clip(np.abs(blocks.slip) / middle[level], 0.0, 1.0)
    gap = np.diff(np.sort(np.append(tested, 0.0))).max()
    return SampledRise(float(gap), levels, _further(peaks[:, np.isfinite(middle)], blocks.slip))


def _further(peaks: Array, slip: Array) -> Array:
    """Space `SLIPS` slips evenly in their logarithm over the rise to the peaks, shape (`SLIPS`,).

    They begin at `_FIRST` of the smallest peak's slip (the 5 % quantile of its draws). They end at
    `_LAST` of the largest peak's (the 95 % quantile), or at the largest tested slip if less.

    Args:
        peaks: Draws of the peak's slip at loads where most of them are finite, shape (w, m) [-].
        slip: Tested slip ratios, whose larger sign they get, shape (n,) [-].
    """
    low, high = np.quantile(peaks, [0.05, 0.95], axis=0, method="inverted_cdf")
    first = _FIRST * float(low.min())
    last = min(_LAST * float(high.max()), max(float(np.abs(slip).max()), first))
    side = 1.0 if slip.max() >= -slip.min() else -1.0
    return side * np.geomspace(first, last, SLIPS)
