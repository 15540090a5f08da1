# SPDX-License-Identifier: MIT
"""Samples of the rig on a common time base, and conversion of device times to host time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from model.arrays import Array
from rig.device import Sample
from rig.errors import DeviceFault
from rig.sample_columns import as_columns
from rig.slip_rig.decode import Zero

FASTEST_DRIFT: Final = 0.01
"""Largest drift of a device's clock, that of oscillators without a quartz [-]."""
RESTART_DELAY: Final = 0.1
"""Excess of a sample's delay over the largest possible one that means a device restart [s]."""
RESTART_JUMP: Final = 60.0
"""Jump of a device's time ahead of the host's that means a device restart [s]."""
LARGEST_LEAD: Final = 1.0
"""Time by which a device's clock may run ahead of the host's beyond its drift; also the time over
which its first offset is the smallest delay [s]."""


@dataclass(frozen=True)
class Readings:
    """Speeds and forces of the rig at common times, each of shape (n,).

    Attributes:
        t: Host time at which the device took each sample [s].
        omega_leg: Speed of the leg disc [rad/s].
        omega_ground: Speed of the ground disc [rad/s].
        normal_force: Normal force, positive when pressed together [N].
        traction_force: Traction force, positive when driving the robot forward [N].
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
        """Return readings with the zero of the load cell subtracted from both forces."""
        return Readings(
            self.t, self.omega_leg, self.omega_ground,
            self.normal_force - zero.normal, self.traction_force - zero.traction,
        )  # fmt: skip

    def since(self, start: float) -> "Readings":
        """Return the samples with t >= `start` [s]."""
        keep = self.t >= start
        return Readings(*(getattr(self, field.name)[keep] for field in fields(self)))


def join(parts: "list[Readings]") -> Readings:
    """Concatenate readings in the given order; no parts give empty readings."""
    if not parts:
        return Readings(*(np.empty(0) for _ in fields(Readings)))
    names = [field.name for field in fields(Readings)]
    return Readings(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


@dataclass(frozen=True)
class Batch:
    """Samples of one poll of the rig.

    Attributes:
        readings: Samples on a common time base, zero not subtracted; a force appears once both
            speeds around it are known.
        normal: Every normal force that has just arrived, for guards, zero not subtracted, shape
            (m,) [N].
        traction: Every traction force that has just arrived, likewise, shape (m,) [N].
        speeds: Every speed of each disc that has just arrived, by `leg` and `ground`, each of
            shape (k,) [rad/s].
        arrived: New samples or answers of each name in `Bench.watched`, checked for silence.
        further: New values of other guarded quantities, by the name of their limit, in its unit,
            each of shape (m,).
        taken: Host times at which new readings were taken, by device; arrival times where the
            device sends no time, shape (n,) [s].
        fault: Description of a fault in a device's status; empty without one.
        raw: Raw samples, by stream, for a log.
    """

    readings: Readings
    normal: Array
    traction: Array
    speeds: Mapping[str, Array]
    arrived: Mapping[str, Sequence[object]]
    further: Mapping[str, Array]
    taken: Mapping[str, Array]
    fault: str
    raw: Mapping[str, Sequence[Sample]]


class HostTime:
    """Online conversion of device times to host times; the smallest delay gives the clock offset.

    Host times never decrease: when a sample with a smaller delay lowers the offset, the time stays
    constant until later samples exceed it. The offset may grow by `FASTEST_DRIFT` of the time
    passed, because clocks drift; a larger increase is a delay of the reading, or, beyond the time
    passed plus `RESTART_DELAY`, a restart of the device, after which the offset is estimated anew.
    """

    def __init__(self) -> None:
        self._offset = self._first = self._began = self._read_at = 0.0
        self._lag = self._latest = -np.inf  # a first sample begins as one after a restart does

    def map(self, samples: Sequence[Sample]) -> Array:
        """Estimate the host times at which new samples were taken, shape (n,) [s].

        Where any sample has no device time, the times at which all were read are returned.

        Raises:
            DeviceFault: The device's clock runs so fast that an old sample would look new.
        """
        columns = as_columns(samples)
        host, device = columns.host_time, columns.device_time
        if len(samples) == 0 or not np.isfinite(device).all():
            return host  # no samples, or the device sends no time
        lag = host - device
        least, elapsed = float(lag.min()), float(host[-1]) - self._read_at
        # A delay cannot grow faster than time passes; if it does, the device has restarted. So it
        # has where its unwrapped time went on by a whole period of its counter.
        if not self._lag - RESTART_JUMP < lag[-1] <= self._lag + elapsed + RESTART_DELAY:
            self._offset, self._began = least, float(host[-1])
        else:
            self._offset = min(self._offset + FASTEST_DRIFT * max(elapsed, 0.0), least)
        self._lag, self._read_at = float(lag[-1]), float(host[-1])
        self._require_no_lead(self._read_at - self._began)
        times = np.maximum.accumulate(np.maximum(device + self._offset, self._latest))
        self._latest = float(times[-1])
        return times

    def _require_no_lead(self, passed: float) -> None:
        """Check how far the offset fell in `passed` [s] since the first one or the last restart."""
        if passed < LARGEST_LEAD:
            self._first = self._offset
        elif (lead := self._first - self._offset) > LARGEST_LEAD + FASTEST_DRIFT * passed:
            raise DeviceFault(
                f"a device's clock ran ahead of this computer's by {lead:.3g} s in {passed:.3g} s, "
                f"so that the age of its readings is unknown; expected at most {FASTEST_DRIFT:.0%} "
                "of the time: set the rate of its clock, in the profile or in the device",
                status=1,
            )
