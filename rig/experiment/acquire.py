# SPDX-License-Identifier: MIT
"""The acquiring thread: every sample is read, guarded and answered here.

Reading feeds the watchdogs of the drives. After a fault nothing is read any more, so that nothing
feeds them: should the command to stop be lost, the drives stop by themselves.
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
"""Between two looks: waking up for each of 7,000 samples a second costs several times more [s]."""
UNDERWAY: Final = 0.5
"""How long reports from before arming may still arrive [s]."""
FURTHER_NAMES: Final = {
    "lateral_force": "force on the load cell's third axis",
    "torque": "torque on the load cell",
    "temperature_celsius": "temperature of a drive or its motor",
}
ROOM_PERIOD: Final = 0.1
"""Between two questions whether data can still be kept [s]."""


@dataclass(frozen=True)
class Ramp:
    """Set-points that change evenly from one pair of speeds to another.

    Attributes:
        start: When it begins [s].
        duration: How long it takes [s].
        before: Speeds of leg and ground disc before [rad/s].
        after: And after [rad/s].
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
    """Reads a bench, guards every sample, and turns the discs.

    Args:
        bench: The rig, entered.
        limits: What guards stop it at.
        control: Where stops are asked for.
        sink: Asked for room, and told of notes.
        clock: Host time.
        period: Between two looks [s].

    Attributes:
        reaction: Time from the arrival of a sample that tripped a guard to the stop's being sent;
            None while no guard has tripped [s].
        energised: Whether the drives have been energised, and not been told to stop since.
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
        """Return whether set-points still change."""
        return self._clock.now() < self._ramp.start + self._ramp.duration

    def arm(self) -> None:
        """Energise at standstill and begin to watch for silence.

        Raises:
            RigError: A device is not there or stays faulty.
        """
        self._bench.read()  # what lay in buffers
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
        """Begin to change the set-points, no faster than allowed.

        Args:
            leg: Speed of the leg disc [rad/s].
            slip: Slip ratio that the ground disc is to make; None for standstill of both.

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
        """Wait for the next samples, command what is due and guard what has come.

        Returns:
            What has come.

        Raises:
            RigError: A guard tripped; the drives are already told to de-energise.
            StopRequested: Somebody asked for a stop.
        """
        self._clock.sleep(min(max(self._look_at - self._clock.now(), 0.0), self._period))
        self._look_at = self._clock.now() + self._period  # what a look takes delays no other
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
        """Ramp to standstill and prove it; only stops harder than the one obeyed are heeded.

        Args:
            longest: Time after the ramp in which both discs must be seen to stand [s].

        Raises:
            NotAtRest: They were not; the drives are de-energised.
            RigError: A guard tripped meanwhile.
            StopRequested: A harder stop was asked for.
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
        """Look until something holds.

        Args:
            holds: Told every batch.
            longest: When to give up [s].

        Returns:
            Whether it came to hold.
        """
        end = self._clock.now() + longest
        while self._clock.now() < end:
            if holds(self.look()):
                return True
        return False

    def ignore_sink(self) -> None:
        """Take the sink as lost: the way to standstill needs none."""
        self._sink = None

    def heed_no_more(self, category: StopCategory | None) -> None:
        """Take stops up to a category as already being obeyed; None heeds all again."""
        self._heeded = category

    def _tell_sink(self, now: float) -> None:
        """Hand notes on, and ask now and then whether data can still be kept."""
        if self._sink is None:
            return
        for note in self._control.take_notes():
            self._sink.event(note.kind, note.text)
        if now >= self._room_at:
            self._room_at = now + ROOM_PERIOD
            self._sink.require_room(self._limits.free_space)

    def _await_health(self) -> None:
        """Let reports of a fault that arming has cleared, and that were underway, pass."""
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
        """Check that both discs follow, and that sensors of what turns are not frozen."""
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
