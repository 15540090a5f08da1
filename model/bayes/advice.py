# SPDX-License-Identifier: MIT
"""Advice of a verdict as values: what to measure or fit next, in no program's words."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.slip.definition import SlipDefinition, convert_slip

_MEASURABLE = {
    SlipDefinition.MATERIAL: (-np.inf, 1.0),
    SlipDefinition.TRAVEL: (-0.9, np.inf),
    SlipDefinition.LARGER: (-0.9, 0.9),
    SlipDefinition.MEAN: (-1.6, 2.0),
}
"""Slip ratios that a rig can hold, without those where the leg disc would have to stand [-]."""


@dataclass(frozen=True)
class Advice:
    """Advice that is said by its reason alone.

    Attributes:
        reason: What was found, and in this class what follows from it, as text.
    """

    reason: str


@dataclass(frozen=True)
class SampleLonger(Advice):
    """Advice to go on sampling.

    Attributes:
        moves: Number of moves to sample up to.
    """

    moves: int


@dataclass(frozen=True)
class MeasureSlips(Advice):
    """Advice to measure further slip ratios at every load, and to fit them with the others.

    Attributes:
        loads: Loads [N].
        slips: Slip ratios in the material definition, which is that of a rig's set-points [-].
    """

    loads: tuple[float, ...]
    slips: tuple[float, ...]


@dataclass(frozen=True)
class MeasureAlso(Advice):
    """Advice to measure the same plan again with changes, and to fit it with the first data.

    Attributes:
        loads: Loads of the plan; none where they stay as they are [N].
        slips: Slip ratios of the plan in the material definition; none where they stay [-].
        repeats: Passes of every set-point; 0 where that stays as it is.
        times: Duration of a run, in multiples of the present one [-].
    """

    loads: tuple[float, ...] = ()
    slips: tuple[float, ...] = ()
    repeats: int = 0
    times: float = 1.0


@dataclass(frozen=True)
class SampleAgain(Advice):
    """Advice to sample the same posterior anew, with more ensembles from another seed."""


@dataclass(frozen=True)
class SamplePosterior(Advice):
    """Advice to sample the posterior, of which only an approximation was weighted."""


@dataclass(frozen=True)
class ZeroBeforeEach(Advice):
    """Advice to measure again in short runs with a zero of their own, and to fit only these."""


@dataclass(frozen=True)
class TryLaws(Advice):
    """Advice to fit the same data with the other laws.

    Attributes:
        both_signs: Whether slip is driving and braking, which may differ.
    """

    both_signs: bool


@dataclass(frozen=True)
class CorrectData(Advice):
    """Advice to find out what is wrong with the rig or its table, to correct it and to fit again.

    Attributes:
        step: What to do, as text.
    """

    step: str


@dataclass(frozen=True)
class TryDefinition(Advice):
    """Advice to find out by which speed slip was divided, to convert it and to fit again."""


@dataclass(frozen=True)
class ExcludeRuns(Advice):
    """Advice to leave out runs that do not belong to the others, and to fit again.

    Attributes:
        runs: Names of the runs; empty where a check passed that would give this advice.
    """

    runs: tuple[str, ...]


def measure_slips(
    reason: str, *, loads: Array, slips: Array, definition: SlipDefinition
) -> MeasureSlips:
    """Return advice to measure slip ratios, clipped to `_MEASURABLE`, in the material definition.

    Args:
        reason: What the data lack.
        loads: Loads, shape (m,) [N].
        slips: Slip ratios, shape (n,) [-].
        definition: Definition of the slip ratios.
    """
    possible = np.clip(slips, *_MEASURABLE[definition])
    material = convert_slip(possible, definition, SlipDefinition.MATERIAL)
    return MeasureSlips(reason, tuple(map(float, loads)), tuple(map(float, material)))


def beyond_the_peak(peaks: Array, slip: Array) -> Array:
    """Space eight slips in logarithm, from the smallest peak's slip to four times the largest.

    They have the sign of the side on which tested slips are larger.

    Args:
        peaks: Slip of the peak at each load; one beyond the largest tested slip, or infinite where
            there is none, counts as the largest tested slip, shape (m,) [-].
        slip: Tested slip ratios, shape (n,) [-].
    """
    tested = np.minimum(peaks, np.abs(slip).max())
    side = 1.0 if slip.max() >= -slip.min() else -1.0
    return side * np.geomspace(float(tested.min()), 4 * float(tested.max()), 8)
