# SPDX-License-Identifier: MIT
"""Checks of what the data cover: rise of the curve, peak, several loads; weak parameters."""

from collections.abc import Mapping

import numpy as np

from model.arrays import Array
from model.bayes.advice import Advice, MeasureAlso, beyond_the_peak, measure_slips
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import largest_slips, load_levels
from model.bayes.checks.check import Check, decided, not_testable
from model.bayes.rise import sampled_rise
from model.slip.law import SlipLaw

RISE = "the rise of the curve is tested"  # name of a check of the data, not of the model
PEAK = "the peak lies within the tested slips"
LOADS = "dependence on load is tested"
MIN_CONTRACTION = 0.75  # the posterior half as wide as the prior
MAX_RISE_GAP = 0.5  # of the peak's slip: three slips at least, and two of them before the peak
MIN_REACH = 2.5  # peak slips: where the curve has fallen clearly behind its peak
SECOND_LOAD = 2.0  # ratio of the load to measure next to the only one


def rise(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Check:
    """Check that tested slips between zero and the peak leave no gap above `MAX_RISE_GAP`.

    Where they do, slope and peak are those of the law's shape, which nothing has tested there. Not
    testable if the curve has no peak.
    """
    found = sampled_rise(blocks, law, values)
    if not len(found.further):
        return not_testable(RISE, "the curve has no peak", untested="rise of the curve (no peak)")
    return decided(
        RISE,
        found.gap <= MAX_RISE_GAP,
        f"between zero and the peak tested slips lie up to {found.gap:.2f} of the peak's slip apart"
        f", limit {MAX_RISE_GAP:g}",
        measure_slips(
            "slips between zero and the peak are missing", loads=found.loads, slips=found.further,
            definition=blocks.definition,
        ),
    )  # fmt: skip


def peak(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Check:
    """Check that at one load at least the largest tested slip reaches the peak's.

    That is the 95 % quantile of the draws' peak slips. If it is reached at no load the check is not
    testable: the peak is an extrapolation of the law. If no draw has a peak, it is passed.
    """
    largest = largest_slips(blocks)
    k = len(law.parameters)
    peaks = law.peak_slip(load_levels(blocks), values[:, :k].T[:, :, None])
    peaks = np.broadcast_to(peaks, (len(values), len(largest)))
    reach = float(np.max(largest / np.quantile(peaks, 0.95, axis=0, method="inverted_cdf")))
    if reach < 1 and np.isfinite(peaks).any():
        return not_testable(
            PEAK,
            f"slip ends at {reach:.2g} times the peak's slip (the 95 % quantile of its draws); the "
            "peak is the law's, not the data's",
            untested="peak (slip ends before it)",
            advice=slips_beyond(
                "slips beyond the peak are missing", blocks, np.median(peaks, axis=0)
            ),
        )
    if not np.isfinite(peaks).any():
        return decided(
            PEAK, True, f"'{law.name}' has none; its force is tested up to the last slip"
        )
    return decided(PEAK, True, f"slip reaches {reach:.1f} times the peak's slip, at least 1 needed")


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


def loads(blocks: SlipBlocks) -> Check:
    """Check that there are two loads or more; not testable at one.

    How traction grows with load is then the prior's.
    """
    levels = load_levels(blocks)
    if len(levels) > 1:
        span = f"{levels[0]:.3g} to {levels[-1]:.3g} N"
        return decided(LOADS, True, f"loads: {len(levels)}, {span}; at least 2 needed")
    further = tuple(float(levels[0]) * ratio for ratio in (1 / SECOND_LOAD, SECOND_LOAD))
    return not_testable(
        LOADS,
        f"there is one load, {levels[0]:.3g} N; at others the curve is that of law and prior",
        untested="dependence on load (one load: it is the prior's)",
        advice=MeasureAlso("one load does not show how the curve depends on it", loads=further),
    )


def weak_parameters(
    blocks: SlipBlocks, law: SlipLaw, values: Array, contraction: Mapping[str, float]
) -> dict[str, Advice]:
    """Return the law's weakly identified parameters by name, with reason and advice.

    Weak are sampled parameters with a contraction below `MIN_CONTRACTION` and, of a law with a
    shape factor, shape and friction if `slip_reach` is below `MIN_REACH`.
    """
    names = [parameter.name for parameter in law.parameters]
    weak: dict[str, Advice] = {
        name: Advice(
            f"{name}: data reduce its prior variance by {max(contraction[name], 0):.0%}, not by "
            f"{MIN_CONTRACTION:.0%}; use F_max and BCD, peak force and initial slope, instead"
        )
        for name in names
        if contraction.get(name, 1.0) < MIN_CONTRACTION
    }
    reach = slip_reach(blocks, law, values)
    if "shape" in names and reach < MIN_REACH:
        reason = (
            f"shape C and peak factor D cannot be separated: slip ends at {reach:.1f} times the "
            f"peak's slip (0 without a peak), {MIN_REACH:g} are needed; use F_max and BCD, peak "
            "force and initial slope, instead, or measure larger slips"
        )
        advice = slips_beyond(reason, blocks, _peaks(blocks, law, values))
        weak |= {"shape": advice, "friction": advice}
    return weak


def slip_reach(blocks: SlipBlocks, law: SlipLaw, values: Array) -> float:
    """Compute the largest tested slip over the median of the draws' peak slips at each load.

    The largest ratio of all loads is returned [-]; it is 0 where the median is infinite, as half of
    the draws or more have no peak.

    Args:
        blocks: The block means.
        law: The slip law, of k parameters.
        values: Posterior draws of law and measurement parameters, shape (w, k + 11).
    """
    return float(np.max(largest_slips(blocks) / _peaks(blocks, law, values)))


def _peaks(blocks: SlipBlocks, law: SlipLaw, values: Array) -> Array:
    """Return the median of the draws' peak slips at each load level, infinite without a peak [-].

    Shape (m,), or (1,) for a Magic Formula whose curvature does not depend on load.
    """
    k = len(law.parameters)
    return np.median(law.peak_slip(load_levels(blocks), values[:, :k].T[:, :, None]), axis=0)
