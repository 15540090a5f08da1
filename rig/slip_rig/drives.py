# SPDX-License-Identifier: MIT
"""Driver of two ODrive velocity drives on one CAN bus: stream of both speeds, and commands.

The watchdog inside each drive stops the discs when this program fails. The thread that reads the
stream feeds it on purpose: a program that no longer reads must not keep the discs turning.
"""

import contextlib
import math
from collections.abc import Callable
from typing import Final, Self

import can

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Limits, Sample
from rig.errors import DeviceFault, RigError, RigTimeout
from rig.links.byte_link import LinkedStream
from rig.links.can import CanLink
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
    WATCHDOG_EXPIRED,
    AxisState,
    Command,
    can_id,
    describe_error,
    split_id,
)
from rig.slip_rig.profile import DiscDrive, DriveProfile

TEMPERATURE_INTERVAL: Final = 0.1
"""Interval between requests for the drives' temperatures [s]."""
HEARTBEAT_TIMEOUT: Final = 1.0
"""Timeout for the heartbeats of both drives when the bus is opened [s]."""


class DriveBus(LinkedStream[CanLink]):
    """Stream of both drives: counts are position [rev] and velocity [rev/s] of a motor.

    A sample's channel is the drive's node, its status the axis error of the last heartbeat.
    CANSimple has no sequence numbers and no device time, so that losses are not detected. Entering
    waits for a heartbeat of each drive and raises `RigTimeout` after `HEARTBEAT_TIMEOUT`; leaving
    de-energises both drives.

    Args:
        link: Link to the bus of both drives.
        profile: Profile of both drives.
        limits: Limits of the rig; commanded speeds must be within its speed.
        clock: Host time.

    Attributes:
        leg: Drive of the leg disc.
        ground: Drive of the ground disc.
        feeding: Whether `read` feeds the watchdogs of armed drives; while False nothing is sent.
    """

    watchdog_advice: Final = (
        "nothing has moved; on each drive set axis.config.watchdog_timeout to 0.1 to 0.25 s and "
        "axis.config.enable_watchdog to True, and save its configuration"
    )

    def __init__(
        self,
        link: CanLink,
        *,
        profile: DriveProfile,
        limits: Limits,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        super().__init__(link, name="drives", clock=clock)
        self.profile = profile
        self.limits = limits
        self.leg = OdriveDrive(self, "leg disc", profile.leg)
        self.ground = OdriveDrive(self, "ground disc", profile.ground)
        self.feeding = True
        self._axes = {drive.place.node: drive for drive in (self.leg, self.ground)}
        self._pending: list[Sample] = []  # arrived while another answer was awaited
        self._feed_at = -math.inf
        self._temperatures_at = math.inf

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far, without losses, which are not detected.

        Estimates of a wrong length, or that are not finite, count as refused.
        """
        return Counters(
            received=self._received,
            damaged=self._link.damaged,
            refused=self._refused,
            reconnected=self._link.reconnected,
        )

    def read(self, timeout: float) -> list[Sample]:
        """Return samples of both drives by host time, waiting at most `timeout` for the first [s].

        Feeds the watchdogs of armed drives while it waits, unless `feeding` is False.

        Raises:
            RigTimeout: The bus takes no frame.
        """
        end = self._clock.now() + timeout
        while True:
            if self.feeding:
                self._feed()
                self._request_due_temperatures()
            left = max(end - self._clock.now(), 0.0)
            samples = self._take(min(left, self.profile.feed_interval))
            if samples or left <= 0:
                # Frames of two drives come in one batch; a log's time never runs back.
                return sorted(samples, key=lambda sample: sample.host_time)

    def request_temperatures(self) -> None:
        """Start to request both drives' temperatures in `read`, every `TEMPERATURE_INTERVAL`."""
        self._temperatures_at = -math.inf

    def take_temperatures(self) -> dict[int, list[float]]:
        """Return and clear the temperatures received since the last call, by node [degC].

        Each is the higher finite one of a drive's transistors and its motor.
        """
        taken = {node: axis.temperatures for node, axis in self._axes.items()}
        for axis in self._axes.values():
            axis.temperatures = []
        return taken

    def require_healthy(self) -> None:
        """Check both drives by their last heartbeats.

        Raises:
            DeviceFault: A drive reports an error, or an armed one has left closed-loop control.
        """
        for axis in self._axes.values():
            axis.require_no_error()
            if axis.armed and axis.state != AxisState.CLOSED_LOOP:
                raise DeviceFault(
                    f"drive of the {axis.name} left closed-loop control: its axis state is "
                    f"{axis.state} (expected {int(AxisState.CLOSED_LOOP)})",
                    status=axis.state,
                )

    def unexpired(self) -> str:
        """Name the drives that an expired watchdog has not stopped, by their last heartbeats.

        Returns:
            Each drive's name, axis state and error as text; empty where both left closed-loop
            control and report an expired watchdog.
        """
        expired = WATCHDOG_EXPIRED[self.profile.firmware]
        return " and of the ".join(
            f"drive of the {axis.name} (axis state {axis.state}, error {axis.error:#x})"
            for axis in self._axes.values()
            if axis.state == AxisState.CLOSED_LOOP or not axis.error & expired
        )

    def __enter__(self) -> Self:
        super().__enter__()
        try:
            self._wait(
                lambda: all(axis.state for axis in self._axes.values()),
                HEARTBEAT_TIMEOUT,
                "no heartbeat came from at least one of the two drives",
                "check their power, and in the profile drives.baudrate and the node of each",
            )
        except BaseException:
            self._link.close()
            raise
        return self

    def __exit__(self, *exception: object) -> None:
        try:
            for axis in self._axes.values():
                axis.disarm()
        finally:
            super().__exit__(*exception)

    def _feed(self) -> None:
        """Send the set-points of armed drives again every `feed_interval`, for their watchdogs."""
        now = self._clock.now()
        if now < self._feed_at:
            return
        self._feed_at = now + self.profile.feed_interval
        for axis in self._axes.values():
            if axis.armed:
                axis.send_velocity()

    def _request_due_temperatures(self) -> None:
        """Request both drives' temperatures where the interval has passed."""
        now = self._clock.now()
        if now >= self._temperatures_at:
            self._temperatures_at = now + TEMPERATURE_INTERVAL
            for node in self._axes:
                self._link.request(can_id(node, Command.TEMPERATURE), TEMPERATURES.size)

    def _wait(self, holds: Callable[[], bool], timeout: float, problem: str, advice: str) -> None:
        """Receive and feed the watchdogs until a condition holds; keep samples for the next `read`.

        Raises:
            RigTimeout: The condition did not hold within `timeout` [s]; `problem` and `advice` are
                its message.
        """
        end = self._clock.now() + timeout
        while not holds():
            left = end - self._clock.now()
            if left <= 0:
                raise RigTimeout(problem, waited=timeout, advice=advice)
            self._feed()
            self._pending += self._receive(min(left, self.profile.feed_interval))

    def _take(self, timeout: float) -> list[Sample]:
        """Return the pending samples and those that arrive, and count them as received."""
        kept, self._pending = self._pending, []
        samples = kept + self._receive(0.0 if kept else timeout)
        self._received += len(samples)
        return samples

    def _receive(self, timeout: float) -> list[Sample]:
        """Return the samples that arrive, and store heartbeats and temperatures in their drives.

        Frames of nodes other than the two drives' are ignored.
        """
        messages = self._link.read(timeout)
        samples = []
        for message, arrived in zip(messages, self._link.arrivals(messages), strict=True):
            node, command = split_id(message.arbitration_id)
            axis = self._axes.get(node)
            if axis is None:
                continue  # another device on a shared bus
            if command == Command.HEARTBEAT and message.dlc >= HEARTBEAT.size:
                axis.error, axis.state = HEARTBEAT.unpack_from(message.data)
            elif command == Command.ENCODER_ESTIMATES:
                samples += self._estimate(axis, message, arrived)
            elif command == Command.TEMPERATURE and message.dlc == TEMPERATURES.size:
                # A motor without a sensor answers NaN or 0, which the transistors' exceed.
                known = [t for t in TEMPERATURES.unpack(message.data) if math.isfinite(t)]
                axis.temperatures += [max(known)] if known else []
        return samples

    def _estimate(self, axis: "OdriveDrive", message: can.Message, arrived: float) -> list[Sample]:
        """Return one sample of an encoder estimate; none, counted as refused, if it is invalid."""
        if message.dlc == ESTIMATES.size:
            counts = ESTIMATES.unpack(message.data)
            if all(map(math.isfinite, counts)):
                return [Sample(arrived, None, None, counts, axis.error, axis.place.node)]
        self._refused += 1
        return []


class OdriveDrive:
    """One of the two drives with its state; implements the protocol `rig.device.Drive`.

    Args:
        bus: Driver of both drives.
        name: Name of the disc that the drive turns.
        place: Node of the drive on the bus, gear and sign.

    Attributes:
        armed: Whether the drive was commanded to closed loop, and not to idle since.
        state: Axis state of the last heartbeat; 0 before the first, and from `arm` to the next one.
        error: Axis error of the last heartbeat; 0 without a fault, and from `arm` to the next one.
        temperatures: Temperatures received since the last `take_temperatures` [degC].
    """

    def __init__(self, bus: DriveBus, name: str, place: DiscDrive) -> None:
        self.name = name
        self.place = place
        self.armed = False
        self.state = 0
        self.error = 0
        self.temperatures: list[float] = []
        self._bus = bus
        self._velocity = 0.0

    def arm(self, timeout: float) -> None:
        """Clear errors and energise with velocity 0; see `Drive.arm`.

        Waits at most `timeout` for closed-loop control [s]; a drive that does not enter it, or that
        reports a fault, is disarmed.
        """
        self._velocity = 0.0
        self._send(Command.CLEAR_ERRORS, b"")
        self._send(
            Command.SET_CONTROLLER_MODE, CONTROLLER_MODE.pack(VELOCITY_CONTROL, PASS_THROUGH)
        )
        self.send_velocity()  # before closed loop: the drive would else begin at its last set-point
        self._send(Command.SET_AXIS_STATE, AXIS_STATE.pack(AxisState.CLOSED_LOOP))
        self.armed, self.state, self.error = True, 0, 0
        try:
            self._bus._wait(lambda: self.state == AxisState.CLOSED_LOOP, timeout,
                            f"drive of the {self.name} did not enter closed-loop control",
                            "check its supply voltage and its calibration")  # fmt: skip
            self.require_no_error()
        except RigError:
            self.disarm()
            self.require_no_error()  # says more than that time ran out
            raise

    def set_speed(self, omega: float) -> None:
        """Send the motor velocity for a disc's angular speed [rad/s]; see `Drive.set_speed`."""
        limit = self._bus.limits.speed
        require_within(omega, limit, quantity=f"speed of the {self.name}", unit="rad/s")
        self._velocity = self.place.sign * omega * self.place.gear / (2 * math.pi)
        self.send_velocity()

    def disarm(self) -> None:
        """Command velocity 0 and de-energise (idle); errors of sending are suppressed."""
        self._velocity, self.armed = 0.0, False
        with contextlib.suppress(RigError, can.CanError, OSError):  # the watchdog remains
            self.send_velocity()
        with contextlib.suppress(RigError, can.CanError, OSError):
            self._send(Command.SET_AXIS_STATE, AXIS_STATE.pack(AxisState.IDLE))

    def send_velocity(self) -> None:
        """Send the latest velocity set-point of the motor again, which feeds the watchdog."""
        self._send(Command.SET_INPUT_VELOCITY, INPUT_VELOCITY.pack(self._velocity, 0.0))

    def require_no_error(self) -> None:
        """Check the axis error of the last heartbeat.

        Raises:
            DeviceFault: The drive reports an error.
        """
        if self.error:
            raise DeviceFault(
                f"drive of the {self.name} reports "
                f"{describe_error(self.error, self._bus.profile.firmware)}",
                status=self.error,
            )

    def _send(self, command: Command, data: bytes) -> None:
        """Send a frame to the drive; on a disconnected bus it is lost, and the watchdog remains."""
        self._bus._link.write(can_id(self.place.node, command), data)
