# SPDX-License-Identifier: MIT
"""Compare a device's clock with the host's during recording, and correct sample times with it."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from model.slip.law import Array
from rig.clock_fit import FEWEST, fit_clock
from rig.device import Sample
from rig.sample_columns import SampleColumns

BUCKET: Final = 0.05
"""Interval in which one comparison of the clocks is kept [s]."""
RESTART_JUMP: Final = 1.0
"""Jump of the clock difference between samples that means a restart of the device [s]."""


class ClockWatch:
    """Collects the sample with the smallest delay in each `BUCKET`, to fit offset and drift.

    Args:
        start: Host time at which the run began [s].
    """

    def __init__(self, *, start: float) -> None:
        self._start = start
        self._device: list[float] = []
        self._host: list[float] = []

    def add(self, samples: Sequence[Sample]) -> None:
        """Add the samples of a read; its last sample has the smallest delay."""
        latest = samples[-1] if samples else None
        if latest is None or latest.device_time is None:
            return
        device, host = latest.device_time, latest.host_time - self._start
        if self._host and host // BUCKET == self._host[-1] // BUCKET:
            if host - device >= self._host[-1] - self._device[-1]:
                return
            self._device.pop()
            self._host.pop()
        self._device.append(device)
        self._host.append(host)

    def result(self) -> Mapping[str, float] | None:
        """Return offset [s] and drift [-] against the time of the run, and the delay [s].

        After a restart of the device they are those of its last clock with enough samples. None
        where the device sends no time, or has sent too few samples.
        """
        device, host = _last_clock(np.array(self._device), np.array(self._host))
        if len(device) < FEWEST:
            return None
        fit = fit_clock(device, host)
        return {"offset": fit.offset, "drift": fit.drift, "delay": fit.delay}


def _last_clock(device: Array, host: Array) -> tuple[Array, Array]:
    """Select the comparisons since the last restart that has enough of them, shape (n,) [s].

    A sample can be read late but never early. The device has therefore restarted where all later
    comparisons are more than `RESTART_JUMP` later.
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
    """Compute the times at which samples were taken, since the start of the run, shape (n,) [s].

    Samples are read in batches. Where the device sends its time, its clock corrects the times of
    reading, separately between restarts. Where it sends none, the times of reading are returned.

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
        if len(part) >= FEWEST and device[part[-1]] > device[part[0]]:
            fit = fit_clock(device[part], stream.host_time[part])
            times[part] = fit.to_host(device[part])
    return times


def _filled(stream: SampleColumns) -> Array | None:
    """Return device times, missing ones interpolated by sample number; None without any."""
    known = np.isfinite(stream.device_time)
    if known.sum() < FEWEST:
        return None
    return np.interp(stream.sequence, stream.sequence[known], stream.device_time[known])
