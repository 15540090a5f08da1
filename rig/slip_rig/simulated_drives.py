# SPDX-License-Identifier: MIT
"""Simulated ODrive axes on a CAN bus, watchdog included, that turn the discs of a simulated rig.

Not modelled: currents, warming up, calibration, and every command this project does not send.
"""

import math
from dataclasses import dataclass
from typing import Final

import can

from rig.slip_rig.can_simple import (
    AXIS_STATE,
    ESTIMATES,
    HEARTBEAT,
    INPUT_VELOCITY,
    TEMPERATURES,
    WATCHDOG_EXPIRED,
    AxisState,
    Command,
    can_id,
    split_id,
)
from rig.slip_rig.profile import DiscDrive, DriveProfile
from rig.slip_rig.simulated import SimulatedRig

HEARTBEAT_INTERVAL: Final = 0.05
"""Interval between the heartbeats of an axis [s]."""
ESTIMATE_INTERVAL: Final = 0.01
"""Interval between the position and velocity frames of an axis [s]."""
EMERGENCY_STOP: Final = {"0.5": 0x4000, "0.6": 0x2}


@dataclass
class _Axis:
    """State of a simulated axis.

    Attributes:
        disc: Disc that it turns, `leg` or `ground`.
        place: Node, gear and sign.
        state: Present `AxisState`.
        error: Bits of the axis error.
        velocity: Set-point of the motor [rev/s].
        fed: Time of the last message to the axis, which feeds its watchdog [s].
    """

    disc: str
    place: DiscDrive
    state: int = AxisState.IDLE
    error: int = 0
    velocity: float = 0.0
    fed: float = -math.inf


class SimulatedDrives:
    """Simulated ODrive axes of both discs, on one end of a CAN bus.

    Args:
        rig: Simulated rig whose discs the axes turn.
        bus: The axes' own end of the bus; the caller closes it.
        profile: Nodes, gears, signs and firmware of the drives.
        watchdog: Time without a message after which an energised axis stops by itself; infinite
            without one [s].

    Attributes:
        temperature: Temperature of both drives' transistors; the motors have no sensor [degC].
    """

    def __init__(
        self, rig: SimulatedRig, bus: can.BusABC, *, profile: DriveProfile, watchdog: float = 0.2
    ) -> None:
        self.source = "sim:rig"
        self.temperature = 30.0
        self._rig = rig
        self._bus = bus
        self._firmware = profile.firmware
        self._watchdog = watchdog
        self._axes = {
            profile.leg.node: _Axis("leg", profile.leg),
            profile.ground.node: _Axis("ground", profile.ground),
        }
        self._heartbeat_at = self._estimate_at = -math.inf

    def turning(self) -> bool:
        """Return whether any axis is in closed loop with a velocity set-point other than 0."""
        return any(a.state == AxisState.CLOSED_LOOP and a.velocity for a in self._axes.values())

    def trip(self, disc: str, error: int) -> None:
        """Inject a fault: stop and de-energise an axis, and add an axis error.

        Args:
            disc: Disc of the axis, `leg` or `ground`.
            error: Bits of the axis error that the axis then reports.
        """
        for axis in self._axes.values():
            if axis.disc == disc:
                self._fail(axis, error)

    def restart(self) -> None:
        """Switch both drives off and on: they come up idle, without errors and set-points."""
        for axis in self._axes.values():
            self._release(axis)
            axis.error, axis.velocity = 0, 0.0

    def poll(self, now: float) -> None:
        """Execute commands, check watchdogs, simulate the rig, and send frames due at `now` [s]."""
        while (message := self._bus.recv(0.0)) is not None:
            node, command = split_id(message.arbitration_id)
            if node in self._axes and message.is_remote_frame:
                self._answer(self._axes[node], command, now)
            elif node in self._axes:
                self._execute(self._axes[node], command, bytes(message.data), now)
        for axis in self._axes.values():
            if axis.state == AxisState.CLOSED_LOOP and now - axis.fed > self._watchdog:
                self._fail(axis, WATCHDOG_EXPIRED[self._firmware])
        self._rig.advance(now)
        self._send_due(now)

    def _send_due(self, now: float) -> None:
        """Send the heartbeats and the encoder estimates of both axes where they are due."""
        if now >= self._heartbeat_at:
            self._heartbeat_at = now + HEARTBEAT_INTERVAL
            for axis in self._axes.values():
                data = HEARTBEAT.pack(axis.error, axis.state) + bytes(3)
                self._send(axis, Command.HEARTBEAT, data)
        if now >= self._estimate_at:
            self._estimate_at = now + ESTIMATE_INTERVAL
            speeds = self._rig.speeds()
            for axis in self._axes.values():
                turns = axis.place.sign * axis.place.gear / (2 * math.pi)
                angle, omega = speeds[axis.disc]
                data = ESTIMATES.pack(turns * angle, turns * omega)
                self._send(axis, Command.ENCODER_ESTIMATES, data)

    def _send(self, axis: _Axis, command: Command, data: bytes) -> None:
        """Send a frame of an axis to the host."""
        arbitration_id = can_id(axis.place.node, command)
        self._bus.send(can.Message(arbitration_id=arbitration_id, data=data, is_extended_id=False))

    def _answer(self, axis: _Axis, command: int, now: float) -> None:
        """Answer a remote frame: the temperatures, with NaN for the motor, and nothing else."""
        axis.fed = now
        if command == Command.TEMPERATURE:
            self._send(axis, Command.TEMPERATURE, TEMPERATURES.pack(self.temperature, math.nan))

    def _execute(self, axis: _Axis, command: int, data: bytes, now: float) -> None:
        """Execute a command to an axis; unknown commands and lengths are ignored."""
        axis.fed = now  # any message to an axis feeds its watchdog
        if command == Command.SET_INPUT_VELOCITY and len(data) == INPUT_VELOCITY.size:
            axis.velocity, _ = INPUT_VELOCITY.unpack(data)
            if axis.state == AxisState.CLOSED_LOOP:
                self._turn(axis)
        elif command == Command.SET_AXIS_STATE and len(data) == AXIS_STATE.size:
            (wanted,) = AXIS_STATE.unpack(data)
            if wanted == AxisState.CLOSED_LOOP and not axis.error:
                axis.state = AxisState.CLOSED_LOOP
                self._turn(axis)
            elif wanted == AxisState.IDLE:
                self._release(axis)
        elif command == Command.CLEAR_ERRORS:
            axis.error = 0
        elif command == Command.EMERGENCY_STOP:
            self._fail(axis, EMERGENCY_STOP[self._firmware])

    def _turn(self, axis: _Axis) -> None:
        """Set the speed of the disc from the motor's velocity set-point."""
        omega = axis.place.sign * axis.velocity * 2 * math.pi / axis.place.gear
        self._rig.command(axis.disc, omega)

    def _release(self, axis: _Axis) -> None:
        """De-energise an axis; the disc of one in closed loop is stopped."""
        if axis.state == AxisState.CLOSED_LOOP:
            self._rig.command(axis.disc, 0.0)
        axis.state = AxisState.IDLE

    def _fail(self, axis: _Axis, error: int) -> None:
        """De-energise an axis and add bits to its error."""
        self._release(axis)
        axis.error |= error
