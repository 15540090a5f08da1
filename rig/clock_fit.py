# SPDX-License-Identifier: MIT
"""Offset and drift between the clocks of a device and of the host."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from rig.errors import ProtocolError

FEWEST: Final = 10
"""Least number of samples to fit."""
MOST_BINS: Final = 60
"""Largest number of bins, of which each gives one sample to the regression."""
FEWEST_BINS: Final = 5
"""Least number of bins whose scatter is taken for that of the samples."""
SMALLEST_SD: Final = 1e-9
"""Least scatter of the samples' times [s]."""
DRIFT_SD: Final = 2e-3
"""Prior standard deviation of the clock drift: quartz drifts far less, oscillators of bare
micro-controllers a few times as much [-]."""


@dataclass(frozen=True)
class ClockFit:
    r"""Linear map from device time to host time.

    .. math::
        t_{host} = offset + (1 + drift)\,t_{device}

    Attributes:
        offset: Host time at device time 0, for a sample that is read with the smallest delay [s].
        drift: Host seconds per device second less 1; above 0 where the device's clock is slow [-].
        delay: Median time by which samples are read later than the map gives [s].
        offset_sd: Standard uncertainty of the offset [s]; most of it is the time by which even the
            fastest samples are read too late, so that the true offset is rather smaller.
        drift_sd: Standard uncertainty of the drift [-]; `DRIFT_SD` where the samples are too few to
            tell it.
    """

    offset: float
    drift: float
    delay: float
    offset_sd: float
    drift_sd: float

    @property
    def tells_drift(self) -> bool:
        """Whether the samples tell more of the drift than was known before."""
        return self.drift_sd < DRIFT_SD / 2

    def to_host(self, device_time: Array) -> Array:
        """Convert device times to host times by the map above, shape (n,) [s]."""
        return self.offset + (1 + self.drift) * device_time


def fit_clock(device_time: Array, host_time: Array) -> ClockFit:
    """Estimate offset and drift of a device clock by regression of host time on device time.

    A sample can be read late but never early. The line is therefore fitted through the sample with
    the smallest delay in each of up to `MOST_BINS` bins of equally many samples, at least five. A
    short recording hardly determines the drift, so that it has a Gaussian prior of mean zero and
    standard deviation `DRIFT_SD`.

    Args:
        device_time: Device time at which each sample was taken, increasing, shape (n,) [s].
        host_time: Host time at which each sample was read, shape (n,) [s].

    Returns:
        Offset, drift and delay. The uncertainties are those of the regression with the prior; fewer
        than `FEWEST_BINS` bins do not show how much samples scatter.

    Raises:
        ProtocolError: There are fewer than `FEWEST` samples, or the device time is the same in the
            first bin and in the last one.

    >>> device = np.arange(100) / 10
    >>> fit = fit_clock(device, 5.0 + 1.0001 * device)
    >>> round(fit.offset, 6), round(fit.drift, 6)
    (5.0, 0.0001)
    """
    if len(device_time) < FEWEST:
        raise ProtocolError(
            f"found {len(device_time)} samples with a device time; expected at least {FEWEST} to "
            "compare the device's clock with the host's"
        )
    lag = host_time - device_time
    bins = np.array_split(np.arange(len(lag)), min(MOST_BINS, len(lag) // 5))
    least = np.array([part[np.argmin(lag[part])] for part in bins])
    if not device_time[least[-1]] > device_time[least[0]]:
        raise ProtocolError(
            f"the device's times do not increase: {device_time[least[0]]:g} s early and "
            f"{device_time[least[-1]]:g} s late in {len(lag)} samples; check the device's clock"
        )
    centre = device_time[least].mean()
    x = device_time[least] - centre
    level, slope = lag[least].mean(), float(x @ lag[least] / (x @ x))
    apart = lag[least] - level - slope * x
    drift = slope / (1 + np.var(apart) / (DRIFT_SD**2 * (x @ x)))
    offset = float(level - drift * centre)
    late = float(np.median(lag - (offset + drift * device_time)))
    if len(least) < FEWEST_BINS:
        sd, drift_sd = late, DRIFT_SD
    else:
        sd = np.sqrt(apart @ apart / (len(least) - 2))
        drift_sd = 1 / np.hypot(np.sqrt(x @ x) / max(sd, SMALLEST_SD), 1 / DRIFT_SD)
    return ClockFit(
        offset, float(drift), late,
        offset_sd=float(np.hypot(sd, drift_sd * centre)), drift_sd=float(drift_sd),
    )  # fmt: skip
