# SPDX-License-Identifier: MIT
"""Compare a device's clock with the host's during recording, and correct sample times with it."""

import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from typing import Final

import numpy as np

from model.arrays import Array
from rig.clock_fit import FEWEST, fit_clock
from rig.device import Sample
from rig.errors import ProtocolError
from rig.sample_columns import SampleColumns

BUCKET: Final = 0.05
"""Interval of host time of which one pair of device and host time is kept [s]."""
RESTART_JUMP: Final = 1.0
"""Jump of host minus device time between samples that means a restart of the device [s]."""


class ClockWatch:
    """Collects the pair of device and host time with the smallest delay in each `BUCKET`.

    The pairs give offset and drift of the device's clock. One thread may add samples while another
    one asks for the result.

    Args:
        start: Host time at which the run began [s].
    """

    def __init__(self, *, start: float) -> None:
        self._start = start
        self._device: list[float] = []
        self._host: list[float] = []
        self._lock = threading.Lock()

    def add(self, samples: Sequence[Sample]) -> None:
        """Keep the times of the last sample of a read where they are the best of their `BUCKET`.

        The last sample of a read waited least. In each `BUCKET` of host time the pair with the
        smallest host minus device time is kept. A sample without device time is ignored.
        """
        latest = samples[-1] if samples else None
        if latest is None or latest.device_time is None:
            return
        with self._lock:
            self._keep(latest.device_time, latest.host_time - self._start)

    def _keep(self, device: float, host: float) -> None:
        if self._host and host // BUCKET == self._host[-1] // BUCKET:
            if host - device >= self._host[-1] - self._device[-1]:
                return
            self._device.pop()
            self._host.pop()
        self._device.append(device)
        self._host.append(host)

    def result(self) -> Mapping[str, float] | None:
        """Fit the attributes of `ClockFit`, by their names, with host time from `start` on.

        After restarts of the device the pairs since the last restart with at least `FEWEST` pairs
        after it are fitted. None where there are fewer pairs, or the device sends no time.

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
    pairs remain, those before the restart are searched in the same way. The result can have fewer.
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
    number. It is the time of reading where fewer than `FEWEST` samples have a device time, or a
    part has fewer samples than that or a clock that stands still.

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
