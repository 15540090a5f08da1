# SPDX-License-Identifier: MIT
"""The clock of a device beside the host's: watched while a run is recorded, undone afterwards."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from model.slip.law import Array
from rig.clock_fit import FEWEST, fit_clock
from rig.device import Sample
from rig.sample_columns import SampleColumns

BUCKET: Final = 0.05
"""One comparison of clocks is kept in each of these [s]."""
RESTARTED: Final = 1.0
"""Clocks that come apart by more than this between samples: the device began anew [s]."""


class ClockWatch:
    """Keeps the least late sample of each `BUCKET`: enough for offset and drift, little to store.

    Args:
        start: Host time at which the run began [s].
    """

    def __init__(self, *, start: float) -> None:
        self._start = start
        self._device: list[float] = []
        self._host: list[float] = []

    def add(self, samples: Sequence[Sample]) -> None:
        """Take what a read gave; its last sample waited least."""
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

        Where the device began anew, its last clock that was seen for long enough. None where the
        device tells no time, or too little of it was seen.
        """
        device, host = _last_clock(np.array(self._device), np.array(self._host))
        if len(device) < FEWEST:
            return None
        fit = fit_clock(device, host)
        return {"offset": fit.offset, "drift": fit.drift, "delay": fit.delay}


def _last_clock(device: Array, host: Array) -> tuple[Array, Array]:
    """Choose the comparisons of the last clock of which there are enough, shape (n,) [s].

    A sample may be read late, after which others are read in time again, but never early: where all
    that follow lie more than `RESTARTED` later, another clock began.
    """
    while len(device) >= FEWEST:
        lag = host - device
        least_after = np.minimum.accumulate(lag[::-1])[::-1]
        began = np.flatnonzero(np.diff(least_after) > RESTARTED)
        first = began[-1] + 1 if len(began) else 0
        in_time = np.flatnonzero(lag - least_after <= RESTARTED)
        kept = in_time[in_time >= first]
        if len(kept) >= FEWEST:
            return device[kept], host[kept]
        device, host = device[:first], host[:first]
    return device, host


def sample_times(stream: SampleColumns) -> Array:
    """Compute when samples were taken, by the time of the run, shape (n,) [s].

    Reading takes samples in batches; where the device tells time, the batches are undone with its
    clock, each stretch between restarts for itself. Where it tells none, the time of reading stays.

    Args:
        stream: A recorded stream.
    """
    device = _filled(stream)
    times = stream.host_time.copy()
    if device is None:
        return times
    lag = stream.host_time - device
    ends = np.flatnonzero(np.abs(np.diff(lag)) > RESTARTED) + 1
    for part in np.split(np.arange(len(times)), ends):
        if len(part) >= FEWEST and device[part[-1]] > device[part[0]]:
            fit = fit_clock(device[part], stream.host_time[part])
            times[part] = fit.to_host(device[part])
    return times


def _filled(stream: SampleColumns) -> Array | None:
    """Return device times, those that were lost interpolated by number; None without any."""
    known = np.isfinite(stream.device_time)
    if known.sum() < FEWEST:
        return None
    return np.interp(stream.sequence, stream.sequence[known], stream.device_time[known])
