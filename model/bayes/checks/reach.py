# SPDX-License-Identifier: MIT
"""What the data cover of a curve: rise, peak and loads, and what they leave unmeasured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from model.bayes.advice import Advice, MeasureAlso, beyond_the_peak, measure_slips
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import largest_slips, load_levels
from model.bayes.rise import sampled_rise
from model.slip.law import SlipLaw

MIN_CONTRACTION: Final = 0.75
"""Share of a prior's variance that data take away where they measure a parameter [-]."""
MIN_REACH: Final = 2.5
"""Largest slip over the peak's, from which the fall behind the peak is seen [-]."""
SECOND_LOAD: Final = 2.0
"""Ratio of the loads to measure next to the only one [-]."""
MEASURED: Final = {"slip_stiffness": "stiffness", "friction": "friction"}
"""Parameters that an answer without them is not whole."""


@dataclass(frozen=True)
class Reach:
    """What the data cover of a curve, and what to measure of the rest.

    Attributes:
        gap: Largest distance of neighbouring tested slips on the rise over the peak's slip [-].
        peak: Largest tested slip over the 95 % quantile of the peak's, at the load where that is
            most; infinite for a curve without a peak [-].
        loads: Number of loads.
        unmeasured: Which of `MEASURED` the data leave to the prior.
        on_the_rise: Advice to measure slips on the rise.
        beyond_the_peak: Advice to measure slips beyond the peak.
        other_loads: Advice to measure other loads.
    """

    gap: float
    peak: float
    loads: int
    unmeasured: tuple[str, ...]
    on_the_rise: Advice
    beyond_the_peak: Advice
    other_loads: Advice


def reach_of(
    blocks: SlipBlocks, law: SlipLaw, values: Array, contraction: Mapping[str, float]
) -> Reach:
    """Compute what the data cover.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 11).
        contraction: 1 - posterior over prior variance of each sampled parameter by name [-].
    """
    rise, levels = sampled_rise(blocks, law, values), load_levels(blocks)
    further = rise.further if len(rise.further) else np.geomspace(0.1, 1, 8) * np.ptp(blocks.slip)
    peaks = _peaks(blocks, law, values)
    high = np.quantile(peaks, 0.95, axis=0, method="inverted_cdf")
    seen = largest_slips(blocks) / np.maximum(high, 1e-300)
    loads = tuple(float(levels[0]) * ratio for ratio in (1 / SECOND_LOAD, SECOND_LOAD))
    return Reach(
        gap=rise.gap,
        peak=float(np.max(seen)) if np.isfinite(peaks).any() else np.inf,
        loads=len(levels),
        unmeasured=tuple(
            word for name, word in MEASURED.items()
            if contraction.get(name, 1.0) < MIN_CONTRACTION
        ),
        on_the_rise=measure_slips(
            "slips between zero and the peak are missing", loads=rise.loads, slips=further,
            definition=blocks.definition,
        ),
        beyond_the_peak=slips_beyond(
            "slips beyond the peak are missing", blocks, np.median(peaks, axis=0)
        ),
        other_loads=MeasureAlso("one load does not show how the curve depends on it", loads=loads),
    )  # fmt: skip


def slips_beyond(reason: str, blocks: SlipBlocks, peaks: Array) -> Advice:
    """Advise to measure slips beyond the peak, at every load level; see `beyond_the_peak`.

    They go from the smallest peak's slip to four times the largest, have the sign of the side on
    which tested slips are larger, and are clipped to what a rig can hold.

    Args:
        reason: What the data lack.
        blocks: The block means.
        peaks: Slip of the peak at each load level, shape (m,), or one for all; one beyond the
            largest tested slip counts as that [-].
    """
    return measure_slips(
        reason, loads=load_levels(blocks), definition=blocks.definition,
        slips=beyond_the_peak(peaks, blocks.slip),
    )  # fmt: skip


def weak_parameters(
    blocks: SlipBlocks, law: SlipLaw, values: Array, contraction: Mapping[str, float]
) -> tuple[str, ...]:
    """Return names of the law's parameters that data hardly tell; use peak and slope instead.

    These are sampled parameters with a contraction below `MIN_CONTRACTION` and, of a law with a
    shape factor, shape and friction if slip ends below `MIN_REACH` times the peak's.
    """
    names = [parameter.name for parameter in law.parameters]
    weak = [name for name in names if contraction.get(name, 1.0) < MIN_CONTRACTION]
    largest = largest_slips(blocks) / np.median(_peaks(blocks, law, values), axis=0)
    if "shape" in names and float(np.max(largest)) < MIN_REACH:
        weak += ["shape", "friction"]
    return tuple(dict.fromkeys(weak))


def _peaks(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Return draws of the peak's slip at each load level, infinite without one, (w, m) [-]."""
    k, levels = len(law.parameters), load_levels(blocks)
    peaks = law.peak_slip(levels, values[:, :k].T[:, :, None])
    return np.broadcast_to(peaks, (len(values), len(levels)))
