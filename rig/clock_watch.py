# SPDX-License-Identifier: MIT
"""Offset and drift between the clocks of a device and of the host, and sample times by them."""

import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from rig.device import Sample
from rig.errors import ProtocolError
from rig.sample_columns import SampleColumns

FEWEST: Final = 10
"""Least number of samples to fit."""
MOST_BINS: Final = 60
"""Largest number of bins, of which each gives one sample to the regression."""
FEWEST_BINS: Final = 5
"""Least number of bins whose scatter is taken for that of the samples."""
SMALLEST_SD: Final = 1e-9
"""Lower bound of the samples' scatter, since exact times would divide by zero [s]."""
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
        """Whether the samples determine the drift: `drift_sd` is below half of its prior's."""
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
        Offset, drift and delay. The uncertainties are those of the regression with the prior. With
        fewer than `FEWEST_BINS` bins, whose scatter says little, `delay` stands for the scatter and
        `drift_sd` is `DRIFT_SD`.

    Raises:
        ProtocolError: There are fewer than `FEWEST` samples, or the device time does not increase
            from the first bin to the last one.

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
    residuals = lag[least] - level - slope * x
    # Posterior mean: the slope, of variance var(residuals) / x'x, is shrunk towards the prior's 0.
    drift = slope / (1 + np.var(residuals) / (DRIFT_SD**2 * (x @ x)))
    offset = float(level - drift * centre)
    late = float(np.median(lag - (offset + drift * device_time)))
    if len(least) < FEWEST_BINS:
        sd, drift_sd = late, DRIFT_SD
    else:
        sd = np.sqrt(residuals @ residuals / (len(least) - 2))
        drift_sd = 1 / np.hypot(np.sqrt(x @ x) / max(sd, SMALLEST_SD), 1 / DRIFT_SD)
    return ClockFit(
        offset, float(drift), late,
        offset_sd=float(np.hypot(sd, drift_sd * centre)), drift_sd=float(drift_sd),
    )  # fmt: skip


BUCKET: Final = 0.05
"""Interval of host time of which one pair of device and host time is kept [s]."""
MOST_PAIRS: Final = 40_000
"""Number of kept pairs, half an hour's, above which their intervals are doubled."""
RESTART_JUMP: Final = 1.0
"""Jump of host minus device time between samples that means a restart of the device [s]."""


class ClockWatch:
    """Collects the pair of device and host time with the smallest delay in each `BUCKET`.

    The pairs give offset and drift of the device's clock. The intervals are doubled whenever there
    are more than `MOST_PAIRS`. One thread may add samples while another one asks for the result.

    Args:
        start: Host time at which the run began [s].
    """

    def __init__(self, *, start: float) -> None:
        self._start = start
        self._bucket = BUCKET
        self._device: list[float] = []
        self._host: list[float] = []
        self._lock = threading.Lock()

    def add(self, samples: Sequence[Sample]) -> None:
        """Keep the times of the last sample of a read where they are the best of their interval.

        The last sample of a read waited least. In each interval of host time the pair with the
        smallest host minus device time is kept. A sample without device time is ignored.
        """
        latest = samples[-1] if samples else None
        if latest is None or latest.device_time is None:
            return
        with self._lock:
            self._keep(latest.device_time, latest.host_time - self._start)

    def _keep(self, device: float, host: float) -> None:
        """Append a pair; of two pairs in the same interval keep the one with the smaller delay."""
        if self._host and host // self._bucket == self._host[-1] // self._bucket:
            if host - device >= self._host[-1] - self._device[-1]:
                return
            self._device.pop()
            self._host.pop()
        self._device.append(device)
        self._host.append(host)
        if len(self._host) > MOST_PAIRS:
            pairs = zip(self._device, self._host, strict=True)
            self._bucket, self._device, self._host = 2 * self._bucket, [], []
            for pair in pairs:
                self._keep(*pair)

    def result(self) -> Mapping[str, float] | None:
        """Fit offset and drift of the device's clock; return `ClockFit`'s attributes by name.

        Host time counts from `start`. Where the device has restarted, only pairs after its last
        restart are fitted, or after an earlier one where fewer than `FEWEST` followed the last.
        None where there are fewer pairs than that at all, or the device sends no time.

        Raises:
            ProtocolError: The device's clock stands still.
        """
        with self._lock:
            device, host = self._device.copy(), self._host.copy()
        device, host = _last_clock(np.array(device), np.array(host))
        if len(device) < FEWEST:
            return None
        return asdict(fit_clock(device, host))


def _last_clock(device: Array, host: Array) -> tuple[Array, Array]:
    """Select pairs of device and host time since the device's last restart, shapes (n,) [s].

    The lag, host minus device time, grows where a sample is read late or the device restarts. The
    device restarted where all later lags are larger by more than `RESTART_JUMP`. A pair was read
    late, and is left out, where a later lag is smaller by more than that. If fewer than `FEWEST`
    pairs remain, those before the restart are searched in the same way. If no part has `FEWEST`
    pairs, the result has fewer.
    """
    while len(device) >= FEWEST:
        lag = host - device
        least_after = np.minimum.accumulate(lag[::-1])[::-1]
        began = np.flatnonzero(np.diff(least_after) > RESTART_JUMP)
        first = began[-1] + 1 if len(began) else 0
        in_time = np.flatnonzero(lag - least_after <= RESTART_JUMP)
        kept = in_time[in_time >= first]
        if len(kept) >= FEWEST:
            return device[kept], host[kept]
        device, host = device[:first], host[:first]
    return device, host


def sample_times(stream: SampleColumns) -> Array:
    """Estimate when samples were taken, in the time base of their `host_time`, shape (n,) [s].

    Between restarts of the device (host minus device time jumps by more than `RESTART_JUMP`), the
    result is `fit_clock`'s map of the device times; missing ones are interpolated over the sequence
    number. All samples keep their `host_time` where fewer than `FEWEST` have a device time; so do
    those between two restarts where they are fewer than that, or the device's clock stands still.

    Args:
        stream: A recorded stream.
    """
    device = _filled(stream)
    times = stream.host_time.copy()
    if device is None:
        return times
    lag = stream.host_time - device
    ends = np.flatnonzero(np.abs(np.diff(lag)) > RESTART_JUMP) + 1
    for part in np.split(np.arange(len(times)), ends):
        with suppress(ProtocolError):
            times[part] = fit_clock(device[part], stream.host_time[part]).to_host(device[part])
    return times


def _filled(stream: SampleColumns) -> Array | None:
    """Return device times, missing ones interpolated over the sequence number, shape (n,) [s].

    None where fewer than `FEWEST` samples have a device time.
    """
    known = np.isfinite(stream.device_time)
    if known.sum() < FEWEST:
        return None
    return np.interp(stream.sequence, stream.sequence[known], stream.device_time[known])
