# SPDX-License-Identifier: MIT
"""Guards of an experiment: each poll's samples are checked against every limit."""

import math
from typing import Final

import numpy as np

from rig.errors import DeviceFault
from rig.experiment.bench import Bench
from rig.experiment.plan import LIMIT_UNITS, RunLimits, rig_limits
from rig.experiment.readings import Batch
from rig.experiment.rest import DISCS
from rig.safety import FollowingGuard, SampleGuard, SilenceGuard
from rig.sensor_guards import TURNING, AgeGuard, FrozenGuard, RecordGuard
from rig.slip_rig.profile import FURTHER_LIMITS

QUANTITIES: Final = {
    "normal_force": "normal force",
    "traction_force": "traction force",
    "lateral_force": "force on the load cell's third axis",
    "torque": "torque on the load cell",
    "temperature_celsius": "temperature of a drive or its motor",
}
"""Quantities whose magnitude is limited, by the name of their limit."""


class RigGuards:
    """All guards of a rig.

    Args:
        bench: The rig, entered; `Bench.watch` is called for the limited quantities.
        limits: Limits of the plan; where the rig's profile has a smaller one, that holds.
    """

    def __init__(self, bench: Bench, limits: RunLimits) -> None:
        self._bench = bench
        self._limits = limits
        allowed = rig_limits(limits, bench.profile.limits)
        self._magnitudes = {
            key: SampleGuard(limit, quantity=quantity, unit=LIMIT_UNITS[key],
                             in_a_row=limits.in_a_row)
            for key, quantity in QUANTITIES.items()
            if (limit := getattr(allowed, key)) is not None
        }  # fmt: skip
        bench.watch(self._magnitudes.keys() & FURTHER_LIMITS.keys())
        self._records = {stream.name: RecordGuard(stream.name) for stream in bench.streams}
        self._age = {name: AgeGuard(name, limit=limits.reading_age) for name in bench.watched}
        self._frozen_forces = FrozenGuard("forces of the load cell", limit=limits.frozen)
        self._frozen_speeds = {
            disc: FrozenGuard(f"speed of the {disc} disc", limit=limits.frozen, follows=True)
            for disc in DISCS
        }
        self._following = {
            disc: FollowingGuard(
                limits.speed_error, name=f"{disc} disc", longest=limits.speed_error_time
            )
            for disc in DISCS
        }
        self._silence: dict[str, SilenceGuard] = {}

    def expect_samples(self, *, now: float) -> None:
        """Start the silence guards at host time `now` [s]; before, silence is not checked."""
        self._silence = {
            name: SilenceGuard(name, limit=self._limits.silence, now=now)
            for name in self._bench.watched
        }

    def check(
        self, batch: Batch, *, wanted: tuple[float, float], standing: bool, now: float
    ) -> None:
        """Check samples (value, age, silence, losses, freezing), discs' speed errors, and status.

        Silence is checked from `expect_samples` on.

        Args:
            batch: Samples of one poll.
            wanted: Set-points of leg and ground disc [rad/s].
            standing: Whether both discs have been verified to stand; a speed error is then limited
                to `TURNING` as well.
            now: Host time at which the samples arrived [s].

        Raises:
            RigError: A guard tripped: `LimitExceeded`, `DeviceFault`, `RigTimeout`,
                `FrozenReading` or `UnreliableRecords`.
        """
        forces = {"normal_force": batch.normal, "traction_force": batch.traction}
        for key, values in (forces | dict(batch.further)).items():
            self._magnitudes[key].check_all(values)
        if batch.fault:
            raise DeviceFault(batch.fault, status=1)
        for name, guard in self._silence.items():
            guard.check(batch.arrived.get(name, []), now=now)
        self._bench.require_healthy()
        for name, taken in batch.taken.items():
            self._age[name].check(taken, now=now)
        for stream in self._bench.streams:
            self._records[stream.name].check(stream.counters, now=now)
        self._check_motion(batch, wanted, standing, now)

    def _check_motion(
        self, batch: Batch, wanted: tuple[float, float], standing: bool, now: float
    ) -> None:
        """Check that both discs follow their set-points and that no sensor is frozen."""
        forces = np.column_stack([batch.normal, batch.traction])
        self._frozen_forces.check(forces, wanted=wanted[0], now=now)
        narrower = TURNING if standing else math.inf
        for disc, omega in zip(DISCS, wanted, strict=True):
            speeds = batch.speeds[disc]
            self._frozen_speeds[disc].check(speeds[:, None], wanted=omega, now=now)
            if len(speeds):
                self._following[disc].check(float(speeds[-1]), omega, now=now, narrower=narrower)
