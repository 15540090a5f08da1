# SPDX-License-Identifier: MIT
"""Driver of two ODrive velocity drives on one CAN bus: stream of both speeds, and commands.

The watchdog inside each drive stops the discs when this program fails. The thread that reads the
stream feeds it on purpose: a program that no longer reads must not keep the discs turning.
"""

import contextlib
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from types import TracebackType
from typing import Final, Self

import can

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Limits, Sample
from rig.errors import DeviceFault, RigError, RigTimeout
from rig.links.can import CanLink
from rig.links.linked_stream import LinkedStream
from rig.safety import require_within
from rig.slip_rig.can_simple import (
    AXIS_STATE,
    CONTROLLER_MODE,
    ESTIMATES,
    HEARTBEAT,
    INPUT_VELOCITY,
    PASS_THROUGH,
    TEMPERATURES,
    VELOCITY_CONTROL,
    AxisState,
    Command,
    can_id,
    describe_error,
    split_id,
)
from rig.slip_rig.profile import DiscDrive, DriveProfile

TEMPERATURE_INTERVAL: Final = 0.1
"""Interval between requests for the drives' temperatures [s]."""
HELLO_LIMIT: Final = 1.0
"""Timeout for the heartbeats of both drives when the bus is opened [s]."""


@dataclass
class _Axis:
    """State of one drive."""

    name: str
    place: DiscDrive
    velocity: float = 0.0
    armed: bool = False
    state: int = 0
    error: int = 0
    pending: list[Sample] = field(default_factory=list)
    temperatures: list[float] = field(default_factory=list)


class DriveBus(LinkedStream[CanLink]):
    """Stream of both drives: counts are position [rev] and velocity [rev/s] of a motor.

    A sample's channel is the drive's node, its status the axis error of the last heartbeat.
    CANSimple has no sequence numbers and no device time, so that losses are not detected.

    Args:
        link: The bus.
        profile: Both drives.
        limits: What the discs are allowed.
        name: Name of the stream.
        clock: Host time.
    """

    def __init__(
        self,
        link: CanLink,
        *,
        profile: DriveProfile,
        limits: Limits,
        name: str = "drives",
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        super().__init__(link)
        self.name = name
        self.profile = profile
        self.limits = limits
        self._clock = clock
        self._axes = {
            profile.leg.node: _Axis("leg disc", profile.leg),
            profile.ground.node: _Axis("ground disc", profile.ground),
        }
        self._feed_at = -math.inf
        self._ask_at = math.inf
        self._received = 0
        self._refused = 0

    @property
    def leg(self) -> "OdriveDrive":
        """Drive of the leg disc."""
        return OdriveDrive(self, self._axes[self.profile.leg.node])

    @property
    def ground(self) -> "OdriveDrive":
        """Drive of the ground disc."""
        return OdriveDrive(self, self._axes[self.profile.ground.node])

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far."""
        return Counters(
            received=self._received,
            damaged=self._link.damaged,
            refused=self._refused,
            reconnected=self._link.reconnected,
        )

    def read(self, timeout: float) -> list[Sample]:
        """Return samples of both drives, waiting at most `timeout` for the first [s].

        Feeds the watchdogs of armed drives while it waits.
        """
        end = self._clock.now() + timeout
        while True:
            self._feed()
            self._ask()
            left = max(end - self._clock.now(), 0.0)
            samples = self._take(min(left, self.profile.feed_interval))
            if samples or left <= 0:
                # Frames of two drives come in one batch; a log's time never runs back.
                return sorted(samples, key=lambda sample: sample.host_time)

    def ask_for_temperatures(self) -> None:
        """Start to request the temperatures of both drives whenever the stream is read."""
        self._ask_at = -math.inf

    def take_temperatures(self) -> dict[int, list[float]]:
        """Return and clear the temperatures received since the last call, by node [degC]."""
        taken = {node: axis.temperatures for node, axis in self._axes.items()}
        for axis in self._axes.values():
            axis.temperatures = []
        return taken

    def require_healthy(self) -> None:
        """Check both drives.

        Raises:
            DeviceFault: An armed drive reports an error, or has left closed loop by itself.
        """
        for axis in self._axes.values():
            self._require_no_error(axis)
            if axis.armed and axis.state != AxisState.CLOSED_LOOP:
                raise DeviceFault(
                    f"drive of the {axis.name} left closed loop for state {axis.state}",
                    status=axis.state,
                )

    def __enter__(self) -> Self:
        super().__enter__()
        try:
            self._wait(
                lambda: all(axis.state for axis in self._axes.values()),
                HELLO_LIMIT,
                "no heartbeat came from both drives (power, nodes and bit rate as in the profile?)",
            )
        except BaseException:
            self._link.close()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            for axis in self._axes.values():
                self._disarm(axis)
        finally:
            super().__exit__(kind, error, trace)

    def _arm(self, axis: _Axis, timeout: float) -> None:
        axis.velocity = 0.0
        self._send(axis, Command.CLEAR_ERRORS, b"")
        mode = CONTROLLER_MODE.pack(VELOCITY_CONTROL, PASS_THROUGH)
        self._send(axis, Command.SET_CONTROLLER_MODE, mode)
        # Standstill before closed loop: the drive would else begin at its last set-point.
        self._send(axis, Command.SET_INPUT_VELOCITY, INPUT_VELOCITY.pack(0.0, 0.0))
        self._send(axis, Command.SET_AXIS_STATE, AXIS_STATE.pack(AxisState.CLOSED_LOOP))
        axis.armed, axis.error = True, 0
        try:
            self._wait(lambda: axis.state == AxisState.CLOSED_LOOP, timeout,
                       f"drive of the {axis.name} did not enter closed loop")  # fmt: skip
            self._require_no_error(axis)
        except RigError:
            self._disarm(axis)
            self._require_no_error(axis)  # says more than that time ran out
            raise

    def _set_speed(self, axis: _Axis, omega: float) -> None:
        require_within(omega, self.limits.speed, quantity=f"speed of the {axis.name}", unit="rad/s")
        axis.velocity = axis.place.sign * omega * axis.place.gear / (2 * math.pi)
        self._send(axis, Command.SET_INPUT_VELOCITY, INPUT_VELOCITY.pack(axis.velocity, 0.0))

    def _disarm(self, axis: _Axis) -> None:
        axis.velocity, axis.armed = 0.0, False
        for command, data in (
            (Command.SET_INPUT_VELOCITY, INPUT_VELOCITY.pack(0.0, 0.0)),
            (Command.SET_AXIS_STATE, AXIS_STATE.pack(AxisState.IDLE)),
        ):
            with contextlib.suppress(RigError, can.CanError, OSError):  # the watchdog remains
                self._send(axis, command, data)

    def _send(self, axis: _Axis, command: Command, data: bytes) -> None:
        self._link.write(can_id(axis.place.node, command), data)

    def _feed(self) -> None:
        now = self._clock.now()
        if now < self._feed_at:
            return
        self._feed_at = now + self.profile.feed_interval
        for axis in self._axes.values():
            if axis.armed:
                data = INPUT_VELOCITY.pack(axis.velocity, 0.0)
                self._send(axis, Command.SET_INPUT_VELOCITY, data)

    def _ask(self) -> None:
        now = self._clock.now()
        if now >= self._ask_at:
            self._ask_at = now + TEMPERATURE_INTERVAL
            for node in self._axes:
                self._link.request(can_id(node, Command.TEMPERATURE), TEMPERATURES.size)

    def _wait(self, holds: Callable[[], bool], timeout: float, problem: str) -> None:
        """Read, keeping the samples for later, until something holds."""
        end = self._clock.now() + timeout
        while not holds():
            left = end - self._clock.now()
            if left <= 0:
                raise RigTimeout(problem, waited=timeout)
            self._feed()
            for sample in self._receive(min(left, self.profile.feed_interval)):
                self._axes[sample.channel].pending.append(sample)

    def _take(self, timeout: float) -> list[Sample]:
        kept = [sample for axis in self._axes.values() for sample in axis.pending]
        for axis in self._axes.values():
            axis.pending.clear()
        samples = kept + self._receive(0.0 if kept else timeout)
        self._received += len(samples)
        return samples

    def _receive(self, timeout: float) -> list[Sample]:
        messages = self._link.read(timeout)
        samples = []
        for message, arrived in zip(messages, self._link.arrivals(messages), strict=True):
            node, command = split_id(message.arbitration_id)
            axis = self._axes.get(node)
            if axis is None:
                continue  # somebody else's, on a shared bus
            if command == Command.HEARTBEAT and message.dlc >= HEARTBEAT.size:
                axis.error, axis.state = HEARTBEAT.unpack_from(message.data)
            elif command == Command.ENCODER_ESTIMATES:
                samples += self._estimate(axis, message, arrived)
            elif command == Command.TEMPERATURE and message.dlc == TEMPERATURES.size:
                # A motor without a sensor answers NaN or 0, which the transistors' exceed.
                known = [t for t in TEMPERATURES.unpack(message.data) if math.isfinite(t)]
                axis.temperatures += [max(known)] if known else []
        return samples

    def _estimate(self, axis: _Axis, message: can.Message, arrived: float) -> list[Sample]:
        if message.dlc == ESTIMATES.size:
            counts = ESTIMATES.unpack(message.data)
            if all(map(math.isfinite, counts)):
                return [Sample(arrived, None, None, counts, axis.error, axis.place.node)]
        self._refused += 1
        return []

    def _require_no_error(self, axis: _Axis) -> None:
        if axis.error:
            raise DeviceFault(
                f"drive of the {axis.name} reports "
                f"{describe_error(axis.error, self.profile.firmware)}",
                status=axis.error,
            )


class OdriveDrive:
    """One of the two drives; satisfies `rig.device.Drive`."""

    def __init__(self, bus: DriveBus, axis: _Axis) -> None:
        self._bus = bus
        self._axis = axis

    @property
    def name(self) -> str:
        """Name of the disc that it turns."""
        return self._axis.name

    def arm(self, timeout: float) -> None:
        """Energise at standstill, waiting at most `timeout` [s]; see `Drive.arm`."""
        self._bus._arm(self._axis, timeout)

    def set_speed(self, omega: float) -> None:
        """Command an angular speed of the disc [rad/s]; see `Drive.set_speed`."""
        self._bus._set_speed(self._axis, omega)

    def disarm(self) -> None:
        """Command standstill and de-energise."""
        self._bus._disarm(self._axis)


def disc_speed(drive: DiscDrive, velocity: float) -> float:
    """Compute the angular speed of a disc, positive driving [rad/s].

    Args:
        drive: The disc's drive.
        velocity: Second count of a sample, speed of the motor [rev/s].

    >>> round(disc_speed(DiscDrive(node=0, gear=10.0, sign=-1), -20.0), 3)
    12.566
    """
    return drive.sign * velocity * 2 * math.pi / drive.gear
