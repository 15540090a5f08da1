# SPDX-License-Identifier: MIT
"""Take and check the zero of the load cell, settle the discs at a point, and record its samples."""

from collections.abc import Callable
from typing import Final, TypeAlias

from rig.clock import Clock
from rig.experiment.acquire import GuardedAcquisition
from rig.experiment.plan import Controls, Plan
from rig.experiment.readings import Batch, Readings, join
from rig.experiment.sink import RunSink
from rig.experiment.steps import Point
from rig.experiment.verdict import LEAST_COVERED, is_steady, span
from rig.slip_rig.decode import Forces, Zero, tare, zero_change

Ask: TypeAlias = Callable[[str], bool]
ZERO_ATTEMPTS: Final = 3
"""Largest number of recordings for a zero whose samples cover too little of the duration."""
STATUS_DELAY: Final = 0.12
"""Time after a point in which drives still may report what happened within: a heartbeat [s]."""


def take_zero(acquire: GuardedAcquisition, duration: float) -> Zero:
    """Average both forces of an unloaded load cell over a duration.

    While the readings span less than `LEAST_COVERED` of the duration, the recording is repeated,
    up to `ZERO_ATTEMPTS` in all; the last one is used in any case.

    Args:
        acquire: The rig, unloaded and at standstill.
        duration: Time over which the zero is averaged [s].

    Raises:
        ProtocolError: The last recording has fewer than ten readings.
        RigError: As `GuardedAcquisition.poll`.
    """
    readings = join([])
    for _ in range(ZERO_ATTEMPTS):
        readings = _collect(acquire, duration)
        if span(readings) >= LEAST_COVERED * duration:
            break  # otherwise the host was delayed
    return tare(Forces(readings.t, readings.normal_force, readings.traction_force))


def undoubted_zero(
    acquire: GuardedAcquisition, controls: Controls, sink: RunSink, known: Zero | None, *, ask: Ask
) -> Zero:
    """Take the zero of the load cell until it agrees with a known one, or a person confirms it.

    Each zero is stored as an event, and a difference from the known one as a warning. Without a
    known one any zero is in doubt: nothing else would tell a load that was left on the cell.

    Args:
        acquire: The rig, at standstill and said to be unloaded.
        controls: Duration of a zero, and its largest change.
        sink: Receiver of the events.
        known: Last zero of the experiment, or the profile's reading without load; None without.
        ask: Asks whether the cell is unloaded, and returns once that is confirmed; False where
            nobody is to be asked, as with a simulated operator.

    Raises:
        ProtocolError, RigError: As `take_zero`.
    """
    doubt, confirmed = "with nothing stored as its zero", None
    while True:
        zero = take_zero(acquire, controls.tare_duration)
        forces = f"normal {zero.normal:.4f} N, traction {zero.traction:.4f} N"
        sink.event("zero", f"{forces}, standard error {zero.standard_error:.4f} N")
        for before in filter(None, (confirmed, known)):
            if not (doubt := zero_change(before, zero, limit=controls.zero_drift)):
                return zero
        if known is not None:
            sink.event("warning", doubt)
        reads = f"the load cell reads {zero.normal:.2f} N (traction {zero.traction:.2f} N), {doubt}"
        if not ask(f"{reads}: is it unloaded? If not, unload it; then confirm"):
            return zero
        confirmed = zero


def settle(acquire: GuardedAcquisition, plan: Plan, point: Point, zero: Zero) -> bool:
    """Ramp the discs to a point's first slip ratio and wait for a steady state.

    Args:
        acquire: The rig, armed.
        plan: Plan with the speed of the leg disc and the criterion for a steady state.
        point: Point to be measured.
        zero: Zero of the load cell, subtracted from the forces.

    Returns:
        Whether the rig was steady, see `is_steady`, before the plan's timeout after the ramp.

    Raises:
        RigError: As `GuardedAcquisition.start_ramp` and `poll`. After its subclasses
            `StopRequested` and `SinkFailed` the discs are still energised.
    """
    criterion = plan.settle
    acquire.start_ramp(plan.points.omega_leg, point.slips[0])
    acquire.until(lambda _: not acquire.ramping, float("inf"))
    wanted = acquire.wanted
    window: list[Readings] = []

    def steady(batch: Batch) -> bool:
        """Add a batch to the window, drop what is older than the window, and test the rest."""
        if not len(batch.readings):
            return False
        window.append(batch.readings.without(zero))
        start = window[-1].t[-1] - criterion.window
        while window[0].t[-1] < start:
            window.pop(0)
        return is_steady(join(window).since(start), wanted, criterion)

    return acquire.until(steady, criterion.timeout)


def record(
    acquire: GuardedAcquisition,
    sink: RunSink,
    plan: Plan,
    point: Point,
    zero: Zero,
    *,
    clock: Clock,
) -> Readings:
    """Record a point for the plan's duration into the sink; a sweep changes the slip meanwhile.

    The guards look on for `STATUS_DELAY` after it.

    Args:
        acquire: The rig, at the point's set-points.
        sink: Recorder of the samples; its run is open.
        plan: Plan with the duration and the speed of the leg disc.
        point: Point to be measured.
        zero: Zero of the load cell, subtracted from the forces.
        clock: Host time.

    Returns:
        The recorded samples, taken since the start, zero subtracted.

    Raises:
        RigError: As `settle`; also `SinkFailed` where the sink cannot store the samples.
    """
    duration = plan.points.duration
    start = clock.now()
    kept: list[Readings] = []

    def keep(batch: Batch) -> None:
        """Store the samples of a batch and, in a sweep, command the slip ratio that is now due."""
        # Samples can be older than the recording, because they waited for their speeds.
        readings = batch.readings.without(zero).since(start)
        kept.append(readings)
        sink.write(readings, batch)
        if point.kind == "sweep":
            slip = point.slip_at((clock.now() - start) / duration)
            acquire.start_ramp(plan.points.omega_leg, slip)

    acquire.until(keep, duration)
    acquire.until(lambda _: False, STATUS_DELAY)
    return join(kept)


def _collect(acquire: GuardedAcquisition, duration: float) -> Readings:
    """Poll for a duration [s] and join all readings, zero not subtracted."""
    parts: list[Readings] = []
    acquire.until(lambda batch: parts.append(batch.readings), duration)
    return join(parts)
