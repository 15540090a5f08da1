# SPDX-License-Identifier: MIT
"""Where blocks of samples begin: never across two runs, nor across a jump of the slip ratio.

A jump is a change of set-point within one recording. The mean of the law over a block is taken for
slip that spreads about one value. A block with two set-points is not such a block: its force would
be off by many times the noise of a block, and the fit would bend the curve to it.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

from model.arrays import Array
from model.slip.samples import SlipSamples

BY_CHANCE = 1e-6  # probability; one false wander can cost hundreds of nats where the curve is steep
LEFT_OVER = 0.1  # of the spread beyond noise, behind the best cut; of an even glide it is a quarter
FEWEST = 4  # samples in a block that can tell a jump from a glide
LEAST_JUMP = 1e-5  # of the slip ratio; smaller ones are rounding errors
SURE = 3.0  # standard deviations of the noise's own sum of squares
UNUSUAL = 4.0  # times the middle block's spread beyond noise


def block_starts(
    samples: SlipSamples, length: int, *, noise: Array
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Cut runs into blocks of about `length` samples, none of them across a jump of the slip.

    A run is first cut at its jumps, but into no part shorter than half a block; then a part of n
    samples is cut into round(n / length) blocks, at least one, of nearly equal size.

    Args:
        samples: The samples.
        length: Wanted number of samples in a block, at least 1.
        noise: Variance of the white noise of one sample's slip ratio, shape (n_runs,) [-].

    Returns:
        Each block's first sample, then the number of samples, shape (n + 1,); and each block's
        run, shape (n,).
    """
    edges = np.array([part.start for part in samples.slices()] + [len(samples)])
    while True:
        starts = _even_starts(edges, length)
        run = samples.run[starts[:-1]]
        found = _spaced(_jumps(samples.slip, starts, noise[run]), edges, length)
        if not len(found):
            return starts, run
        edges = np.union1d(edges, found)  # other blocks now, which may show further jumps


def _even_starts(edges: NDArray[np.intp], length: int) -> NDArray[np.intp]:
    """Cut parts between edges into nearly equal blocks; return their starts and the last edge."""
    parts = [
        np.linspace(first, last, max(1, round((last - first) / length)) + 1).round()[:-1]
        for first, last in pairwise(edges)
    ]
    return np.append(np.concatenate(parts), edges[-1]).astype(np.intp)


def _jumps(slip: Array, starts: NDArray[np.intp], noise: Array) -> NDArray[np.intp]:
    r"""Find the first sample behind the jump in each block that has one.

    A cut behind p of n samples, whose deviations from the block's mean add up to S, takes
    :math:`S^2 n / (p (n - p))` away from their sum of squares. A block of `FEWEST` samples or more
    has a jump if that sum is larger than noise makes it with the probability `BY_CHANCE`, and its
    best cut takes more than `LEAST_JUMP` squared away and leaves less than `LEFT_OVER` of what is
    beyond noise.

    Noise alone makes one cut of many look good where a speed ripples. Cuts that noise has chosen
    select the measured slips of their blocks by their errors, which biases the curve's rise. So a
    block's sum beyond noise is also so large that `LEFT_OVER` of it exceeds `SURE` standard
    deviations of the noise's own sum, or is over `UNUSUAL` times that of the median block.

    Args:
        slip: Slip ratios, shape (n_samples,) [-].
        starts: First sample of each block, then the number of samples, shape (n + 1,).
        noise: Variance of one sample's noise in each block, shape (n,) [-].
    """
    count = np.diff(starts)
    size = np.repeat(count, count)
    deviation = slip - np.repeat(np.add.reduceat(slip, starts[:-1]) / count, count)
    total = np.add.reduceat(deviation**2, starts[:-1])
    before = np.arange(1, len(slip) + 1) - np.repeat(starts[:-1], count)
    left = np.maximum(size - before, 1)
    taken = np.where(size > before, np.cumsum(deviation) ** 2 * size / (before * left), 0.0)
    best = np.maximum.reduceat(taken, starts[:-1])
    spare = np.maximum(count - 1, 1)
    beyond = total - noise * spare
    usual = max(float(np.median(beyond / spare)), 0.0) * spare
    clear = LEFT_OVER * beyond > SURE * noise * np.sqrt(2 * spare)
    jumped = (
        (count >= FEWEST)
        & (total > noise * chdtri(spare, BY_CHANCE))
        & (best > LEAST_JUMP**2)
        & (beyond - best < LEFT_OVER * beyond)
        & (clear | (beyond > UNUSUAL * usual))
    )
    cuts = [starts[k] + int(np.argmax(taken[starts[k] : starts[k + 1]])) + 1
            for k in np.flatnonzero(jumped)]  # fmt: skip
    return np.array(cuts, dtype=np.intp)


def _spaced(cuts: NDArray[np.intp], edges: NDArray[np.intp], length: int) -> NDArray[np.intp]:
    """Return the cuts that leave no part shorter than half a block; of two the earlier is kept."""
    kept: list[int] = []
    for cut in cuts.tolist():
        after = np.searchsorted(edges, cut, side="right")
        last = max(edges[after - 1], kept[-1] if kept else 0)
        if min(cut - last, edges[after] - cut) >= length / 2:
            kept.append(cut)
    return np.array(kept, dtype=np.intp)
