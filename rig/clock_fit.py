# SPDX-License-Identifier: MIT
"""Offset and drift between the clocks of a device and of the host."""

from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rig.errors import ProtocolError

Array: TypeAlias = NDArray[np.float64]
FEWEST: Final = 10
MOST_BINS: Final = 60
DRIFT_SD: Final = 2e-3
"""What clocks are believed to drift before any sample: quartz far less, oscillators of bare
micro-controllers a few times as much [-]."""


@dataclass(frozen=True)
class ClockFit:
    r"""How host time follows from device time.

    .. math::
        t_{host} = offset + (1 + drift)\,t_{device}

    Attributes:
        offset: Host time of the device's zero, for a message that travels as fast as any [s].
        drift: How much faster the host's clock runs [-].
        delay: Median of how much later than that messages were read [s].
    """

    offset: float
    drift: float
    delay: float

    def to_host(self, device_time: Array) -> Array:
        """Compute host times of device times [s]."""
        return self.offset + (1 + self.drift) * device_time


def fit_clock(device_time: Array, host_time: Array) -> ClockFit:
    """Estimate offset and drift from when samples were taken and read.

    Reading can only be late, never early, so that the line is laid through the least late sample of
    each of many bins: the delay of the others does not pull at it. A second of samples read at a
    loss tells no drift, so that it is drawn towards zero by as much as it scatters (`DRIFT_SD`).

    Args:
        device_time: When the device took each sample, increasing, shape (n,) [s].
        host_time: When the host read it, shape (n,) [s].

    Returns:
        Offset, drift and delay.

    Raises:
        ProtocolError: There are fewer than ten samples, or they were taken at one time.

    >>> device = np.arange(100) / 10
    >>> fit = fit_clock(device, 5.0 + 1.0001 * device)
    >>> round(fit.offset, 6), round(fit.drift, 6)
    (5.0, 0.0001)
    """
    if len(device_time) < FEWEST or not device_time[-1] > device_time[0]:
        raise ProtocolError(
            f"{len(device_time)} samples over "
            f"{np.ptp(device_time) if len(device_time) else 0:g} s; expected at least {FEWEST} "
            "over some time to compare clocks"
        )
    lag = host_time - device_time
    bins = np.array_split(np.arange(len(lag)), min(MOST_BINS, len(lag) // 5))
    least = np.array([part[np.argmin(lag[part])] for part in bins])
    centre = device_time[least].mean()
    x = device_time[least] - centre
    level, slope = lag[least].mean(), float(x @ lag[least] / (x @ x))
    scatter = np.var(lag[least] - level - slope * x)
    drift = slope / (1 + scatter / (DRIFT_SD**2 * (x @ x)))
    offset = float(level - drift * centre)
    late = lag - (offset + drift * device_time)
    return ClockFit(offset, float(drift), float(np.median(late)))
