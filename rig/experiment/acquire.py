# SPDX-License-Identifier: MIT
"""Acquisition thread: reads every sample, checks it against the limits, and commands set-points.

Reading feeds the watchdogs of the drives. After a fault nothing is read, so that the watchdogs
expire: if the command to stop is lost, the drives stop by themselves.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.clock import Clock
from rig.errors import DeviceFault, NotAtRest, RigError
from rig.experiment.bench import Bench
from rig.experiment.control import Control
from rig.experiment.plan import RunLimits, ground_speed, rig_limits
from rig.experiment.readings import Batch
from rig.experiment.rest import DISCS, prove_rest
from rig.experiment.sink import RunSink
from rig.safety import (
    FollowingGuard,
    SampleGuard,
    SilenceGuard,
    StopCategory,
    StopRequested,
    require_within,
)
from rig.sensor_guards import TURNING, AgeGuard, FrozenGuard, RecordGuard
from rig.slip_rig.profile import FURTHER_LIMITS

PERIOD: Final = 0.004
"""Polling period: waking up for each of 7,000 samples per second is several times slower [s]."""
UNDERWAY: Final = 0.5
"""How long reports from before arming may still arrive [s]."""
FURTHER_NAMES: Final = {
    "lateral_force": "force on the load cell's third axis",
    "torque": "torque on the load cell",
    "temperature_celsius": "temperature of a drive or its motor",
}
ROOM_PERIOD: Final = 0.1
"""Interval between checks whether data can still be stored [s]."""


@dataclass(frozen=True)
class Ramp:
    """Linear ramp of the set-points of both discs.

    Attributes:
        start: Host time at which it begins [s].
        duration: Duration of the ramp [s].
        before: Speeds of leg and ground disc before the ramp [rad/s].
        after: Speeds of leg and ground disc after the ramp [rad/s].
    """

    start: float
    duration: float
    before: tuple[float, float]
    after: tuple[float, float]

    def at(self, now: float) -> tuple[float, float]:
        """Compute the set-points at a time [rad/s]."""
        done = 1.0 if self.duration <= 0 else min(max((now - self.start) / self.duration, 0.0), 1.0)
        leg, ground = (b + done * (a - b) for b, a in zip(self.before, self.after, strict=True))
        return leg, ground


class GuardedAcquisition:
    """Reads a bench, checks every sample against the limits, and commands the discs.

    Args:
        bench: The rig, entered.
        limits: Limits of the guards.
        control: Mailbox with requests to stop.
        sink: Receiver of notes; also asked whether data can still be stored.
        clock: Host time.
        period: Polling period [s].

    Attributes:
        reaction: Time from the arrival of a sample that tripped a guard until the stop was sent;
            None while no guard has tripped [s].
        energised: Whether the drives have been energised and not been commanded to stop since.
    """

    def __init__(
        self,
        bench: Bench,
        *,
        limits: RunLimits,
        control: Control,
        sink: RunSink,
        clock: Clock,
        period: float = PERIOD,
    ) -> None:
        self.reaction: float | None = None
        self.energised = False
        self._bench = bench
        self._limits = limits
        self._control = control
        self._sink: RunSink | None = sink
        self._clock = clock
        self._period = period
        self._look_at = clock.now() + period
        self._heeded: StopCategory | None = None
        allowed = rig_limits(limits, bench.profile.limits)
        self._largest_speed = allowed.speed
        force = {"unit": "N", "in_a_row": limits.in_a_row}
        self._normal = SampleGuard(allowed.normal_force, quantity="normal force", **force)
        self._traction = SampleGuard(allowed.traction_force, quantity="traction force", **force)
        wanted = {key: getattr(allowed, key) for key in FURTHER_LIMITS}
        self._further = {
            key: SampleGuard(
                limit, quantity=FURTHER_NAMES[key], unit=FURTHER_LIMITS[key],
                in_a_row=limits.in_a_row,
            )
            for key, limit in wanted.items() if limit is not None
        }  # fmt: skip
        bench.watch(self._further)
        self._following = {
            disc: FollowingGuard(
                limits.speed_error, name=f"{disc} disc", longest=limits.speed_error_time
            )
            for disc in DISCS
        }
        self._silence: dict[str, SilenceGuard] = {}
        self._records = {stream.name: RecordGuard(stream.name) for stream in bench.streams}
        self._frozen_forces = FrozenGuard("forces of the load cell", limit=limits.frozen)
        self._frozen_speeds = {
            disc: FrozenGuard(f"speed of the {disc} disc", limit=limits.frozen, follows=True)
            for disc in DISCS
        }
        self._age = {name: AgeGuard(name, limit=limits.reading_age) for name in bench.watched}
        self._room_at = -float("inf")
        now = clock.now()
        self._ramp = Ramp(now, 0.0, (0.0, 0.0), (0.0, 0.0))
        self._sent: tuple[float, float] | None = None
        self._standing = False

    @property
    def wanted(self) -> tuple[float, float]:
        """Set-points of leg and ground disc now [rad/s]."""
        return self._ramp.at(self._clock.now())

    @property
    def ramping(self) -> bool:
        """Return whether the set-points are still on a ramp."""
        return self._clock.now() < self._ramp.start + self._ramp.duration

    def arm(self) -> None:
        """Energise at standstill and start the silence guards.

        Raises:
            RigError: A device does not respond or stays faulty.
        """
        self._bench.read()  # discard what is in buffers
        self.energised = True
        self._bench.arm()
        self._await_health()
        self._sent = None
        now = self._clock.now()
        self._silence = {
            name: SilenceGuard(name, limit=self._limits.silence, now=now)
            for name in self._bench.watched
        }

    def disarm(self) -> None:
        """De-energise both drives at once; never fails."""
        self._bench.disarm()
        self.energised = False

    def aim(self, leg: float, slip: float | None) -> None:
        """Start a ramp of the set-points, within the acceleration limit.

        Args:
            leg: Speed of the leg disc [rad/s].
            slip: Slip ratio, which sets the speed of the ground disc; None for standstill of both
                discs [-].

        Raises:
            LimitExceeded: A speed is beyond its limit.
        """
        profile = self._bench.profile
        ground = 0.0 if slip is None else ground_speed(
            slip, leg, radius_leg=profile.radius_leg, radius_ground=profile.radius_ground
        )  # fmt: skip
        for name, speed in (("leg", leg), ("ground", ground)):
            require_within(
                speed, self._largest_speed, quantity=f"speed of the {name} disc", unit="rad/s"
            )
        before = self.wanted
        change = max(abs(leg - before[0]), abs(ground - before[1]))
        duration = change / self._limits.acceleration
        self._ramp = Ramp(self._clock.now(), duration, before, (leg, ground))
        self._standing = False

    def look(self) -> Batch:
        """Wait one period, command the set-points, read the samples and check them.

        Returns:
            The samples that have arrived.

        Raises:
            RigError: A guard tripped; the drives are already commanded to de-energise.
            StopRequested: A stop was requested.
        """
        self._clock.sleep(min(max(self._look_at - self._clock.now(), 0.0), self._period))
        self._look_at = self._clock.now() + self._period  # a slow look delays no other
        try:
            batch = self._bench.read()
            arrived = self._clock.now()
            try:
                self._guard(batch, arrived)
            except RigError:
                self.disarm()
                self.reaction = self._clock.now() - arrived
                raise
            self._turn()
        except RigError:
            self.disarm()
            raise
        self._heed()
        self._tell_sink(arrived)
        return batch

    def come_to_rest(self, longest: float) -> None:
        """Ramp to standstill and verify it; only a harder stop than the present one interrupts.

        Args:
            longest: Time after the ramp within which standstill must be verified [s].

        Raises:
            NotAtRest: It was not verified; the drives are de-energised.
            RigError: A guard tripped meanwhile.
            StopRequested: A harder stop was requested.
        """
        self.aim(0.0, None)
        self.until(lambda _: not self.ramping, float("inf"))
        try:
            prove_rest(
                self.look, self._limits.rest_speed, longest=longest, clock=self._clock,
                oldest=self._limits.reading_age,
            )  # fmt: skip
        except NotAtRest:
            self._bench.disarm()
            raise
        self._standing = True

    def until(self, holds: Callable[[Batch], bool], longest: float) -> bool:
        """Poll the rig until a condition holds or a timeout expires.

        Args:
            holds: Condition, called with every batch.
            longest: Timeout [s].

        Returns:
            Whether the condition held before the timeout.
        """
        end = self._clock.now() + longest
        while self._clock.now() < end:
            if holds(self.look()):
                return True
        return False

    def ignore_sink(self) -> None:
        """Stop using the sink after it failed: the ramp to standstill does not need it."""
        self._sink = None

    def heed_no_more(self, category: StopCategory | None) -> None:
        """Ignore stops up to a category, which is being carried out; None ignores none."""
        self._heeded = category

    def _tell_sink(self, now: float) -> None:
        """Pass notes to the sink, and check periodically whether data can still be stored."""
        if self._sink is None:
            return
        for note in self._control.take_notes():
            self._sink.event(note.kind, note.text)
        if now >= self._room_at:
            self._room_at = now + ROOM_PERIOD
            self._sink.require_room(self._limits.free_space)

    def _await_health(self) -> None:
        """Wait until reports of a fault that arming has cleared have passed."""
        end = self._clock.now() + UNDERWAY
        while True:
            self._clock.sleep(self._period)
            self._bench.read()
            try:
                self._bench.require_healthy()
            except DeviceFault:
                if self._clock.now() < end:
                    continue
                self.disarm()
                raise
            return

    def _heed(self) -> None:
        stop = self._control.stop.pending
        if stop is None or (self._heeded is not None and stop.category <= self._heeded):
            return
        if stop.category is StopCategory.EMERGENCY:
            self.disarm()
        raise StopRequested(stop)

    def _turn(self) -> None:
        wanted = self.wanted
        if wanted != self._sent:
            self._bench.turn(*wanted)
            self._sent = wanted

    def _guard(self, batch: Batch, now: float) -> None:
        self._normal.check_all(batch.normal)
        self._traction.check_all(batch.traction)
        for key, values in batch.further.items():
            self._further[key].check_all(values)
        if batch.fault:
            raise DeviceFault(batch.fault, status=1)
        for name, guard in self._silence.items():
            guard.check(batch.heard.get(name, []), now=now)
        self._bench.require_healthy()
        for name, taken in batch.taken.items():
            self._age[name].check(taken, now=now)
        for stream in self._bench.streams:
            self._records[stream.name].check(stream.counters, now=now)
        self._guard_motion(batch, now)

    def _guard_motion(self, batch: Batch, now: float) -> None:
        """Check that both discs follow their set-points and that no sensor is frozen."""
        forces = np.column_stack([batch.normal, batch.traction])
        leg, ground = self.wanted
        self._frozen_forces.check(forces, wanted=leg, now=now)
        for disc, speeds, wanted in (
            ("leg", batch.speeds["leg"], leg),
            ("ground", batch.speeds["ground"], ground),
        ):
            self._frozen_speeds[disc].check(speeds[:, None], wanted=wanted, now=now)
            if len(speeds):
                narrower = TURNING if self._standing else math.inf
                self._following[disc].check(float(speeds[-1]), wanted, now=now, narrower=narrower)
