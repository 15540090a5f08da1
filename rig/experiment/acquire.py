# SPDX-License-Identifier: MIT
"""Acquisition thread: reads every sample, checks it against the limits, and commands set-points.

Reading feeds the watchdogs of the drives. After a fault nothing is read, so that the watchdogs
expire: if the command to stop is lost, the drives stop by themselves.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

from rig.clock import Clock
from rig.errors import DeviceFault, NotAtRest, RigError, RigTimeout
from rig.experiment.bench import Bench
from rig.experiment.control import Control
from rig.experiment.guards import RigGuards
from rig.experiment.plan import WATCHDOG_PROOF, RunLimits, ground_speed, rig_limits
from rig.experiment.readings import Batch
from rig.experiment.rest import DISCS, prove_rest
from rig.experiment.sink import RunSink
from rig.safety import StopCategory, StopRequested, require_within

PERIOD: Final = 0.004
"""Polling period: waking up for each of 7,000 samples per second is several times slower [s]."""
LONGEST_STEP: Final = 5
"""Most polling periods by which a ramp goes on from one poll to the next, however late that is."""
FAULT_CLEAR_TIME: Final = 0.5
"""Time after arming in which a reported fault may be one from before arming [s]."""
WATCHDOG_LIMIT: Final = 0.5
"""Time within which watchdogs that are not fed must be seen to stop the drives: 0.25 s, to which
they may be set, 0.1 s between an ODrive's heartbeats, the rest for link and host [s]."""
SPACE_CHECK_PERIOD: Final = 0.1
"""Interval between checks whether data can still be stored [s]."""


@dataclass(frozen=True)
class Ramp:
    """Linear ramp of the set-points of both discs.

    Attributes:
        start: Host time at which the ramp begins [s].
        duration: Duration of the ramp; 0 is a step [s].
        before: Speeds of leg and ground disc before the ramp [rad/s].
        after: Speeds of leg and ground disc after the ramp [rad/s].
    """

    start: float
    duration: float
    before: tuple[float, float]
    after: tuple[float, float]

    def at(self, now: float) -> tuple[float, float]:
        """Interpolate the set-points of leg and ground disc [rad/s] at a host time `now` [s].

        Before the ramp they are `before`, after it `after`; with duration 0 always `after`.
        """
        done = 1.0 if self.duration <= 0 else min(max((now - self.start) / self.duration, 0.0), 1.0)
        leg, ground = (b + done * (a - b) for b, a in zip(self.before, self.after, strict=True))
        return leg, ground


class GuardedAcquisition:
    """Reads a bench, checks every sample against the limits, and commands the discs.

    Args:
        bench: The rig, entered.
        limits: Limits of the plan, at which the guards trip.
        control: Mailbox with requests to stop.
        sink: Receiver of notes, which also checks that data can still be stored.
        clock: Host time.
        period: Polling period [s].

    Attributes:
        reaction: Time from the arrival of a sample that tripped a guard until the stop was sent;
            None while no guard has tripped [s].
        energised: Whether the drives were energised by `arm`, without a call of `disarm` since.
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
        self._guards = RigGuards(bench, limits)
        now = clock.now()
        self._poll_at = now + period
        self._check_space_at = -math.inf
        self._ignored: StopCategory | None = None
        self._ramp = Ramp(now, 0.0, (0.0, 0.0), (0.0, 0.0))
        self._sent: tuple[float, float] | None = None
        self._standing = False

    @property
    def wanted(self) -> tuple[float, float]:
        """Present set-points of leg and ground disc, interpolated on the latest ramp [rad/s]."""
        return self._ramp.at(self._clock.now())

    @property
    def ramping(self) -> bool:
        """Return whether the set-points are still on a ramp."""
        return self._clock.now() < self._ramp.start + self._ramp.duration

    def arm(self) -> None:
        """Energise at standstill, prove the watchdogs, and start the silence guards.

        Watchdogs are proved by letting them expire once, unless `guards_off` has `WATCHDOG_PROOF`.

        Raises:
            RigError: A drive does not energise, a fault is still reported after
                `FAULT_CLEAR_TIME`, or a watchdog does not stop its drive within `WATCHDOG_LIMIT`;
                both drives have been de-energised.
        """
        self._bench.read()  # discard what is in buffers
        self.energised = True
        try:
            self._energise()
            if WATCHDOG_PROOF not in self._limits.guards_off:
                self._let_watchdogs_expire()
                self._energise()
        except BaseException:
            self.disarm()
            raise
        self._sent = None
        self._guards.expect_samples(now=self._clock.now())

    def disarm(self) -> None:
        """Command both drives to stand and de-energise at once; errors of sending are suppressed.

        Of a rig on one micro-controller (`BoardBench`) both discs only get speed 0, because it has
        no command to de-energise.
        """
        self._bench.disarm()
        self.energised = False

    def start_ramp(self, leg: float, slip: float | None) -> None:
        """Start a ramp from the present set-points; the larger change has the plan's acceleration.

        Args:
            leg: Final speed of the leg disc [rad/s].
            slip: Final slip ratio, which sets the speed of the ground disc; None stops the ground
                disc [-].

        Raises:
            LimitExceeded: A final speed is NaN or beyond the smaller limit of plan and rig.
        """
        profile = self._bench.profile
        ground = 0.0 if slip is None else ground_speed(
            slip, leg, radius_leg=profile.radius_leg, radius_ground=profile.radius_ground
        )  # fmt: skip
        limit = rig_limits(self._limits, profile.limits).speed
        for disc, speed in zip(DISCS, (leg, ground), strict=True):
            require_within(speed, limit, quantity=f"speed of the {disc} disc", unit="rad/s")
        before = self.wanted
        change = max(abs(leg - before[0]), abs(ground - before[1]))
        duration = change / self._limits.acceleration
        self._ramp = Ramp(self._clock.now(), duration, before, (leg, ground))
        self._standing = False

    def poll(self) -> Batch:
        """Wait for the next period, read and check the samples, then command changed set-points.

        A late poll goes on with a ramp where the one before left it, rather than in a step.

        Returns:
            The samples that have arrived.

        Raises:
            RigError: A guard tripped or a device failed; the drives have been de-energised.
            StopRequested: A stop is pending that is not ignored; only an emergency de-energises.
            SinkFailed: Notes or data cannot be stored; the drives stay energised.
        """
        self._clock.sleep(min(max(self._poll_at - self._clock.now(), 0.0), self._period))
        on_time = max(self._poll_at + (LONGEST_STEP - 1) * self._period, self._ramp.start)
        late = max(self._clock.now() - on_time, 0.0)
        self._ramp = replace(self._ramp, start=self._ramp.start + late)
        self._poll_at = self._clock.now() + self._period  # a slow poll delays no other
        try:
            batch = self._bench.read()
            arrived = self._clock.now()
            try:
                self._guards.check(batch, wanted=self.wanted, standing=self._standing, now=arrived)
            except RigError:
                self.disarm()
                self.reaction = self._clock.now() - arrived
                raise
            self._command_speeds()
        except RigError:
            self.disarm()
            raise
        self._raise_if_stopped()
        self._log_notes()
        self._require_free_space(arrived)
        return batch

    def come_to_rest(self, longest: float) -> None:
        """Ramp both discs to standstill and verify that they stand; they stay energised.

        Args:
            longest: Time after the ramp within which standstill must be verified [s].

        Raises:
            NotAtRest: Standstill was not verified in time; the drives have been de-energised.
            RigError, SinkFailed: As `poll`.
            StopRequested: A stop is pending that is not ignored, see `ignore_stops`.
        """
        self.start_ramp(0.0, None)
        self.until(lambda _: not self.ramping, float("inf"))
        try:
            prove_rest(
                self.poll, self._limits.rest_speed, longest=longest, clock=self._clock,
                oldest=self._limits.reading_age,
            )  # fmt: skip
        except NotAtRest:
            self.disarm()
            raise
        self._standing = True

    def until(self, holds: Callable[[Batch], object], longest: float) -> bool:
        """Poll the rig until a condition holds or a timeout expires.

        Args:
            holds: Condition, called with every batch; true ends the polling.
            longest: Timeout; may be infinite [s].

        Returns:
            Whether the condition held before the timeout.

        Raises:
            RigError, StopRequested, SinkFailed: As `poll`.
        """
        end = self._clock.now() + longest
        while self._clock.now() < end:
            if holds(self.poll()):
                return True
        return False

    def rest_without_sink(self, longest: float) -> None:
        """Ramp to standstill and de-energise without using the sink, which has failed.

        Errors on the way (`RigError`, `OSError`) are suppressed; they also end in de-energising.

        Args:
            longest: Time after the ramp within which standstill must be verified [s].
        """
        self._sink = None
        try:
            self.come_to_rest(longest)
        except (RigError, OSError):
            pass
        finally:
            self.disarm()

    def ignore_stops(self, category: StopCategory | None) -> None:
        """Ignore stops up to `category`, which is being carried out; None ignores no stop."""
        self._ignored = category

    def _log_notes(self) -> None:
        """Pass the entries that wait in the mailbox to the sink, unless it has failed."""
        if self._sink is not None:
            for note in self._control.take_notes():
                self._sink.event(note.kind, note.text)

    def _require_free_space(self, now: float) -> None:
        """Check every `SPACE_CHECK_PERIOD` that the sink can store the plan's `free_space`.

        Otherwise the sink raises `SinkFailed`. A sink that has failed is not checked.
        """
        if self._sink is not None and now >= self._check_space_at:
            self._check_space_at = now + SPACE_CHECK_PERIOD
            self._sink.require_room(self._limits.free_space)

    def _let_watchdogs_expire(self) -> None:
        """Feed no watchdog until all have stopped their drives, which then are de-energised.

        Raises:
            RigTimeout: One was not seen to stop its drive within `WATCHDOG_LIMIT`.
            StopRequested: An emergency stop was requested meanwhile.
        """
        motors, began = self._bench.motors, self._clock.now()
        motors.feeding = False
        try:
            while running := motors.unexpired():
                self._clock.sleep(self._period)
                self._bench.read()
                if self._control.stop.latched:
                    self._raise_if_stopped()
                if (waited := self._clock.now() - began) > WATCHDOG_LIMIT:
                    problem = f"the watchdog of the {running}, sent nothing, did not expire"
                    advice = f"expected within {WATCHDOG_LIMIT:g} s; {motors.watchdog_advice}"
                    raise RigTimeout(problem, waited=waited, advice=advice)
        finally:
            motors.feeding = True
        self._bench.disarm()

    def _energise(self) -> None:
        """Energise, and read until no fault is reported.

        Raises:
            RigError: A drive does not energise, or a fault is reported after `FAULT_CLEAR_TIME`.
        """
        self._bench.arm()
        end = self._clock.now() + FAULT_CLEAR_TIME
        while True:
            self._clock.sleep(self._period)
            self._bench.read()
            try:
                self._bench.require_healthy()
            except DeviceFault:
                if self._clock.now() >= end:
                    raise
            else:
                return

    def _raise_if_stopped(self) -> None:
        """Raise `StopRequested` for a pending stop harder than the ignored category.

        An emergency stop de-energises first.
        """
        stop = self._control.stop.pending
        if stop is None or (self._ignored is not None and stop.category <= self._ignored):
            return
        if stop.category is StopCategory.EMERGENCY:
            self.disarm()
        raise StopRequested(stop)

    def _command_speeds(self) -> None:
        """Send the present set-points to both discs where they differ from those last sent."""
        wanted = self.wanted
        if wanted != self._sent:
            self._bench.turn(*wanted)
            self._sent = wanted
