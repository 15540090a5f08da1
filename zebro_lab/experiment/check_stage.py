# SPDX-License-Identifier: MIT
"""Compare new check points with a calibration to detect drift of the rig."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from scipy.stats import norm

from model.arrays import Array
from model.slip.curve import SlipCurve
from model.slip.samples import SlipSamples
from zebro_lab.calibration.folder import read_slip_file
from zebro_lab.calibration.rig_data import read_rig_data

_LOG = logging.getLogger(__name__)
STEP: Final = 1e-4
"""Step of central differences relative to a parameter, whose size counts as `STEP` at least [-]."""
BATCHES: Final = 8
"""Number of consecutive parts of a run whose means estimate the noise of the run's mean."""
FALSE_ALARMS: Final = 0.01
"""Probability that any run of a check is said to have drifted when none has [-]."""


@dataclass(frozen=True)
class CheckedRun:
    """Comparison of the mean traction of one run with the calibration.

    Attributes:
        name: Name of the run.
        slip: Mean slip ratio [-].
        load: Mean normal force [N].
        traction: Mean measured traction [N].
        expected: Mean traction of the calibrated curve at the run's slip ratios and loads [N].
        sd: Standard deviation of traction minus expected, from fit, noise and zero offset; NaN for
            a run of fewer than `BATCHES` samples [N].
        limit: Deviation beyond which the run counts as drifted [standard deviations].
    """

    name: str
    slip: float
    load: float
    traction: float
    expected: float
    sd: float
    limit: float

    @property
    def deviation(self) -> float:
        """Standardised difference: (traction - expected) / sd [-]."""
        return (self.traction - self.expected) / self.sd

    @property
    def verdict(self) -> str:
        """The text "DRIFTED" if the run deviates by more than `limit`, else empty.

        "NOT TESTABLE" with its reason if the deviation is NaN, for too few samples.
        """
        if np.isnan(self.deviation):
            return f"NOT TESTABLE: fewer than {BATCHES} samples"
        return "DRIFTED" if abs(self.deviation) > self.limit else ""


@dataclass(frozen=True)
class DriftCheck:
    """Comparison of runs with a calibration.

    Attributes:
        runs: Comparison of each run, in the order in which the runs were read.
        sources: Source of the runs and that of the calibration, such as "real" or "sim:what".
    """

    runs: tuple[CheckedRun, ...]
    sources: tuple[str, str]


def check_runs(data: Sequence[Path], calibration: Path, *, zero_sd: float = 0.1) -> DriftCheck:
    """Compare the mean traction of each run with the calibrated slip curve.

    The limit of the n runs is the quantile of a standard normal that any of them exceeds by chance
    with probability `FALSE_ALARMS` (Bonferroni): 2.6 for one run, 3.6 for thirty.

    Args:
        data: Run folders or tables, or folders of them; excluded runs and copies are left out.
        calibration: `slip.toml` of the calibration, or its folder.
        zero_sd: Standard deviation of the zero offset of traction between runs [N].

    Returns:
        The comparisons.

    Raises:
        ZebroLabError: Data or calibration cannot be read.
    """
    calibrated = read_slip_file(calibration)
    curve = calibrated.curve
    read = read_rig_data(data, slip_definition=str(curve.definition))
    for note in read.repeated:
        _LOG.warning("%s", note)
    samples = read.samples
    n = len(samples.run_names)
    limit = float(norm.isf(FALSE_ALARMS / (2 * n)))
    runs = tuple(
        _checked(samples, curve, index, zero_sd=zero_sd, limit=limit) for index in range(n)
    )
    return DriftCheck(runs, (read.source, calibrated.source))


def _checked(
    samples: SlipSamples, curve: SlipCurve, index: int, *, zero_sd: float, limit: float
) -> CheckedRun:
    """Compare the mean traction of one run with that of the curve at its slips and loads.

    Its variance adds that of the curve's parameters, by the derivative of the mean, that of the
    zero offset, and that of the run's mean, estimated from means of `BATCHES` consecutive parts
    (batch means).
    """
    chosen = samples.run == index
    slip, load = samples.slip[chosen], samples.normal_force[chosen]
    traction = samples.traction_force[chosen]
    expected = curve.force(slip, load, definition=curve.definition)
    gradient = _gradient(curve, slip, load)
    noise = np.nan
    if len(traction) >= BATCHES:
        batches = [part.mean() for part in np.array_split(traction - expected, BATCHES)]
        noise = float(np.std(batches, ddof=1)) / np.sqrt(BATCHES)
    fitted = float(gradient @ curve.covariance @ gradient)
    return CheckedRun(
        name=samples.run_names[index],
        slip=float(slip.mean()),
        load=float(load.mean()),
        traction=float(traction.mean()),
        expected=float(expected.mean()),
        sd=float(np.sqrt(fitted + noise**2 + zero_sd**2)),
        limit=limit,
    )


def _gradient(curve: SlipCurve, slip: Array, load: Array) -> Array:
    """Differentiate the curve's mean traction [N] by its k parameters, shape (k,).

    The mean is over the samples' slip ratios and loads; the differences are central.
    """
    gradient = np.empty(len(curve.values))
    for k, value in enumerate(curve.values):
        step = STEP * max(abs(float(value)), STEP)
        ends = []
        for sign in (1, -1):
            values = curve.values.copy()
            values[k] += sign * step
            ends.append(float(np.mean(curve.law.force(slip, load, values))))
        gradient[k] = (ends[0] - ends[1]) / (2 * step)
    return gradient
