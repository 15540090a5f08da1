# SPDX-License-Identifier: MIT
"""Guards of an experiment: each poll's samples are checked against every limit."""

import math
from collections import deque
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from rig.device import Counters
from rig.errors import DeviceFault, FrozenReading, StaleReading, UnreliableRecords
from rig.experiment.bench import Bench
from rig.experiment.plan import LIMIT_UNITS, RunLimits, rig_limits
from rig.experiment.readings import Batch
from rig.experiment.rest import DISCS
from rig.safety import FollowingGuard, SampleGuard, SilenceGuard
from rig.slip_rig.profile import FURTHER_LIMITS

Values: TypeAlias = Array

TURNING: Final = 1.0
"""Set-point above which a disc's sensors are checked, and change of the set-point above which the
speed must change too [rad/s]."""
MIN_REPEATS: Final = 8
"""Least number of equal consecutive readings of a frozen sensor."""
LARGE: Final = 3.0
"""Factor on a sensor's smallest step above which a change is more than its rounding [-]."""
SCATTER_BATCHES: Final = 9
"""Number of latest batches with any change, more than half of which need a large change."""
SCATTER_TIME: Final = 1.0
"""Time over which the fraction of batches with a large change is averaged [s]."""
SINGLE_PRECISION: Final = 2.0**-22
"""Relative resolution of values sent in single precision [-]."""
RESTART_WINDOW: Final = 10.0
"""Time within which a device may restart its record numbers once [s]."""
ON_TIME: Final = 0.1
"""Longest time between two checks after which this program does not count as late [s]."""
BAD_FRACTION_WINDOW: Final = 0.25
"""Time over which the fraction of missing and rejected records is computed [s]."""
MAX_BAD_FRACTION: Final = 0.5
"""Largest allowed fraction of missing and rejected records [-]."""
MIN_RECORDS: Final = 20
"""Least number of records from which the fraction is computed."""


class AgeGuard:
    """Check that no reading is older than a limit, for example because it waited in a buffer.

    Args:
        name: Name of the stream, for the message.
        limit: Largest age allowed [s].
    """

    def __init__(self, name: str, *, limit: float) -> None:
        self._name = name
        self._limit = limit

    def check(self, taken: Array, *, now: float) -> None:
        """Check the age of the oldest reading of one batch; an empty batch passes.

        Args:
            taken: Host time at which each reading was taken, shape (n,) [s].
            now: Host time, less the time by which this program was late to read [s].

        Raises:
            StaleReading: A reading is older than the limit.
        """
        age = now - float(taken.min(initial=now))
        if age > self._limit:
            raise StaleReading(
                f"age of a reading of stream '{self._name}'", value=age, limit=self._limit, unit="s"
            )


class FrozenGuard:
    """Check for a sensor that gives the same value, bit for bit, while discs turn.

    A working sensor gives a constant value at rest, where its noise is below one count, and a
    simulated one without noise does so at any steady speed. A constant value therefore counts as
    frozen only where it must change: where it scattered by several of its smallest steps until its
    last change, or, for a speed, where its set-point has changed.

    Args:
        what: Name of the quantity, for the message.
        limit: Longest time without any change [s].
        follows: Whether the quantity is a disc's speed, which the set-point commands.
    """

    def __init__(self, what: str, *, limit: float, follows: bool = False) -> None:
        self._what = what
        self._limit = limit
        self._follows = follows
        self._last: Values | None = None
        self._checked_at = self._changed = 0.0
        self._same = 0
        self._wanted = self._steady = 0.0  # set-points at the last change, and of the last batch
        self._smallest = self._large_fraction = np.zeros(0)
        self._large: deque[NDArray[np.bool_]] = deque(maxlen=SCATTER_BATCHES)
        self._scattered = False

    def check(self, values: Values, *, wanted: float, now: float) -> None:
        """Check the values of a batch.

        At set-points of at most `TURNING` nothing is checked, and the time without a change starts
        anew; what was learned of the scatter is kept. An empty batch changes nothing.

        Args:
            values: Values in the sensor's unit, in order of time, shape (n, channels).
            wanted: Set-point of the disc that makes the values change [rad/s].
            now: Host time [s].

        Raises:
            FrozenReading: No channel has changed for longer than the limit, over at least
                `MIN_REPEATS` readings, though a channel scattered before or, for a speed, the
                set-point has moved by more than `TURNING` since.
        """
        if abs(wanted) <= TURNING:
            self._last = None
        elif len(values):
            if self._last is None or (values != self._last).any():
                self._changed, self._wanted, self._same = now, wanted, 0
            if self._last is not None and wanted == self._steady:
                self._learn(values, self._last, now)
            self._last, self._steady, self._checked_at = values[-1].copy(), wanted, now
            self._same += len(values)
            ramped = self._follows and abs(wanted - self._wanted) > TURNING
            must_change = self._scattered or ramped
            if must_change and self._same >= MIN_REPEATS and now - self._changed > self._limit:
                raise FrozenReading(self._what, value=now - self._changed, limit=self._limit)

    def _learn(self, values: Values, last: Values, now: float) -> None:
        """Update each channel's smallest step, and whether any channel scatters.

        A channel's change over a batch, from `last` to the batch's last value, is large if it is
        at least `LARGE` times the channel's resolution: its smallest step other than 0 so far, or
        `SINGLE_PRECISION` of its value if that is more. A channel scatters if its change was large

        * in more than half of the last `SCATTER_BATCHES` batches in which any channel changed, and
        * in more than half of all batches, by an exponential moving average of time constant
          `SCATTER_TIME`.

        A batch in which no channel changes leaves the result as it was.

        Args:
            values: Values of a batch, shape (n, channels), n > 0.
            last: Values before the batch, shape (channels,).
            now: Host time [s].
        """
        steps = np.abs(np.diff(values, axis=0, prepend=last[None]))
        if not len(self._smallest):
            self._smallest, self._large_fraction = np.full(len(last), np.inf), np.zeros(len(last))
        self._smallest = np.minimum(self._smallest, np.where(steps > 0, steps, np.inf).min(axis=0))
        resolution = np.maximum(self._smallest, SINGLE_PRECISION * np.abs(last))
        large = np.abs(values[-1] - last) >= LARGE * resolution
        weight = -np.expm1((self._checked_at - now) / SCATTER_TIME)  # of a moving average
        self._large_fraction += weight * (large - self._large_fraction)
        if steps.any():
            self._large.append(large)
            often = np.mean(self._large, axis=0) > 0.5
            self._scattered = bool((often & (self._large_fraction > 0.5)).any())


class RecordGuard:
    """Check for a stream whose record numbers restart repeatedly, or of which most records fail.

    Random record numbers count as restarts. Of a sensor one restart within `RESTART_WINDOW` is
    tolerated; of what turns the discs none is, nor a link that was lost and came back, for it would
    step to the next set-points. So is a fraction of missing and rejected records of up to
    `MAX_BAD_FRACTION` of each `BAD_FRACTION_WINDOW` that had at least `MIN_RECORDS` records.

    Args:
        name: Name of the stream, for the message.
        turns_discs: Whether the stream's device turns the discs.
    """

    def __init__(self, name: str, *, turns_discs: bool = False) -> None:
        self._name = name
        self._turns_discs = turns_discs
        self._restarts: deque[float] = deque()
        self._restarted = 0
        self._base: Counters | None = None
        self._since = 0.0

    def check(self, counters: Counters, *, now: float, late: float = 0.0) -> None:
        """Check the stream's counters; losses are checked only among `MIN_RECORDS` or more records.

        Args:
            counters: Counters of the stream so far.
            now: Host time [s].
            late: Time by which this program was late to read, so that buffers may have overflowed:
                losses pass unless it is 0 [s].

        Raises:
            UnreliableRecords: There are more restarts, or more missing and rejected records, than
                the class tolerates.
        """
        restarted = counters.restarted + self._turns_discs * counters.reconnected
        if self._base is None:
            self._base, self._since, self._restarted = counters, now, restarted
        self._restarts.extend([now] * (restarted - self._restarted))
        self._restarted = restarted
        while self._restarts and self._restarts[0] < now - RESTART_WINDOW:
            self._restarts.popleft()
        if len(self._restarts) > 1 - self._turns_discs:
            raise UnreliableRecords(
                f"stream '{self._name}' restarted its numbering or its link {len(self._restarts)} "
                f"times within {RESTART_WINDOW:g} s; allowed: {1 - self._turns_discs}; check its "
                "power and cable"
            )
        if late:
            self._base, self._since = counters, now
        elif now - self._since >= BAD_FRACTION_WINDOW:
            self._require_most(counters, self._base)
            self._base, self._since = counters, now

    def _require_most(self, counters: Counters, base: Counters) -> None:
        """Check the fraction of missing and rejected records between two states of the counters.

        Fewer than `MIN_RECORDS` records pass.

        Raises:
            UnreliableRecords: The fraction is above `MAX_BAD_FRACTION`.
        """
        received = counters.received - base.received
        bad = counters.lost + counters.rejected - base.lost - base.rejected
        if bad + received >= MIN_RECORDS and bad > MAX_BAD_FRACTION * (bad + received):
            raise UnreliableRecords(
                f"{100 * bad / (bad + received):.0f} % of the latest records of stream "
                f"'{self._name}' are missing, damaged, repeated or refused; the limit is "
                f"{100 * MAX_BAD_FRACTION:g} %"
            )


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

    Where the program itself was late, silence, age and losses are judged by what a device could
    have delivered: time beyond `ON_TIME` between two checks, less the time since, is taken off
    silences and ages. The drives' own watchdogs limit how late it can be.

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
        self._records: dict[str, RecordGuard] = {}
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
        self._checked_at = self._late = 0.0

    def expect_samples(self, *, now: float) -> None:
        """Start to check silence and records at host time `now` [s]; before, they are not."""
        self._checked_at = now
        for stream in self._bench.streams:
            turns_discs = stream is self._bench.motors
            self._records[stream.name] = RecordGuard(stream.name, turns_discs=turns_discs)
            self._records[stream.name].check(stream.counters, now=now)
        self._silence = {
            name: SilenceGuard(name, limit=self._limits.silence, now=now)
            for name in self._bench.watched
        }

    def check(
        self, batch: Batch, *, wanted: tuple[float, float], standing: bool, now: float
    ) -> None:
        """Check samples (value, age, silence, losses, freezing), discs' speed errors, and status.

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
        waited = now - self._checked_at if self._silence else 0.0
        self._late = late = max(waited - ON_TIME, self._late - waited, 0.0)
        self._checked_at = now
        for name, guard in self._silence.items():
            guard.check(batch.arrived.get(name, []), now=now, late=late)
        try:
            self._bench.require_healthy()
        except DeviceFault as fault:
            why = f"; this program was late by {late:.2g} s" if late else ""
            raise DeviceFault(f"{fault}{why}", status=fault.status) from fault
        for name, taken in batch.taken.items():
            self._age[name].check(taken, now=now - late)
        for stream in self._bench.streams:
            if stream.name in self._records:
                self._records[stream.name].check(stream.counters, now=now, late=late)
        self._check_motion(batch, wanted, standing, now)

    def _check_motion(
        self, batch: Batch, wanted: tuple[float, float], standing: bool, now: float
    ) -> None:
        """Check that both discs follow their set-points and that no sensor is frozen.

        Forces are checked by `FrozenGuard` while the leg disc is commanded to turn, a disc's speed
        while that disc is.
        """
        forces = np.column_stack([batch.normal, batch.traction])
        self._frozen_forces.check(forces, wanted=wanted[0], now=now)
        narrower = TURNING if standing else math.inf
        for disc, omega in zip(DISCS, wanted, strict=True):
            speeds = batch.speeds[disc]
            self._frozen_speeds[disc].check(speeds[:, None], wanted=omega, now=now)
            if len(speeds):
                self._following[disc].check(float(speeds[-1]), omega, now=now, narrower=narrower)
