# SPDX-License-Identifier: MIT
"""Samples of the rig lined up in time, and the times at which devices took them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from model.slip.law import Array
from rig.device import Sample
from rig.sample_columns import as_columns
from rig.slip_rig.decode import Zero

FASTEST_DRIFT: Final = 0.01
"""What a device's clock drifts at most: oscillators without a quartz are off by so much [-]."""
BEGAN_ANEW: Final = 0.1
"""How much later than possible a device time must come to be of a clock that began anew [s]."""


@dataclass(frozen=True)
class Readings:
    """Samples of the rig, lined up in time, each shape (n,).

    Attributes:
        t: Host time at which the device took it [s].
        omega_leg: Speed of the leg disc [rad/s].
        omega_ground: Speed of the ground disc [rad/s].
        normal_force: Positive when pressed together [N].
        traction_force: Positive when driving [N].
    """

    t: Array
    omega_leg: Array
    omega_ground: Array
    normal_force: Array
    traction_force: Array

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.t)

    def without(self, zero: Zero) -> "Readings":
        """Subtract a zero from both forces."""
        return Readings(
            self.t, self.omega_leg, self.omega_ground,
            self.normal_force - zero.normal, self.traction_force - zero.traction,
        )  # fmt: skip

    def since(self, start: float) -> "Readings":
        """Keep the samples from a time on [s]."""
        keep = self.t >= start
        return Readings(*(getattr(self, field.name)[keep] for field in fields(self)))


def join(parts: "list[Readings]") -> Readings:
    """Put readings one behind the other."""
    if not parts:
        return Readings(*(np.empty(0) for _ in fields(Readings)))
    names = [field.name for field in fields(Readings)]
    return Readings(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


@dataclass(frozen=True)
class Batch:
    """What one look at the rig gave.

    Attributes:
        readings: Lined-up samples; a force waits here until both speeds around it are known.
        normal: Every normal force that has just arrived, for guards, shape (m,) [N].
        traction: Every traction force that has just arrived, shape (m,) [N].
        speeds: Every speed of each disc that has just arrived, by `leg` and `ground`, each of
            shape (k,) [rad/s].
        heard: What came of each device and answer that is watched for silence, by name.
        further: What has just arrived of other guarded quantities, by the name of their limit.
        taken: When each reading that has just arrived was taken, by host time, by device; where the
            device tells no time, when it arrived, shape (n,) [s].
        fault: What a device's status says is wrong; empty where nothing is.
        raw: Samples as they came, by stream, for a log.
    """

    readings: Readings
    normal: Array
    traction: Array
    speeds: Mapping[str, Array]
    heard: Mapping[str, Sequence[object]]
    further: Mapping[str, Array]
    taken: Mapping[str, Array]
    fault: str
    raw: Mapping[str, Sequence[Sample]]


class HostTime:
    """Puts device times on the host's clock: what was underway least tells the offset.

    Times never run back: where a quicker sample shows that the others were late, they stand until
    the better ones have caught up. Clocks drift, so that the offset is believed to grow by
    `FASTEST_DRIFT`: readings that come later by more than that are late, and not the clock.
    """

    def __init__(self) -> None:
        self._offset = self._lag = np.inf
        self._read_at = self._latest = -np.inf

    def map(self, samples: Sequence[Sample]) -> Array:
        """Return when the samples were taken, shape (n,) [s]."""
        columns = as_columns(samples)
        host, device = columns.host_time, columns.device_time
        if len(samples) == 0 or not np.isfinite(device).all():
            return host  # none came, or the device tells no time
        lag = host - device
        least, elapsed = float(lag.min()), float(host[-1]) - self._read_at
        # Nothing waits longer than time has passed: what does is of a device that began anew.
        if lag[-1] > self._lag + elapsed + BEGAN_ANEW:
            self._offset = least
        else:
            self._offset = min(self._offset + FASTEST_DRIFT * max(elapsed, 0.0), least)
        self._lag, self._read_at = float(lag[-1]), float(host[-1])
        times = np.maximum.accumulate(np.maximum(device + self._offset, self._latest))
        self._latest = float(times[-1])
        return times
