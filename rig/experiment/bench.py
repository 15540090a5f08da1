# SPDX-License-Identifier: MIT
"""Common interface of a slip rig for experiments: disc speeds out, samples in, for any wiring.

A bench reads either drives and load cell, or one micro-controller (board) in place of both, in one
thread, and interpolates their samples to common times.
"""

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence
from contextlib import ExitStack
from typing import Final, Self

import numpy as np

from model.arrays import Array
from rig.backends import RigDevices
from rig.device import Drive, Stream
from rig.errors import ProfileError
from rig.experiment.readings import Batch, HostTime, Readings, join
from rig.sample_columns import SampleColumns
from rig.slip_rig.board import RigBoard
from rig.slip_rig.decode import decode_board, decode_forces, decode_further_loads, disc_speed
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.load_cell import NetFtCell, describe_status
from rig.slip_rig.profile import RigProfile

ARM_TIMEOUT: Final = 2.0
"""Timeout for a drive to enter closed-loop control [s]."""


class Bench(ABC):
    """Slip rig whose discs are commanded and whose samples are read; a context manager.

    Args:
        motors: Driver of both discs, not yet entered.
        sensors: Drivers of further devices, not yet entered.
        profile: Profile of the rig.

    Attributes:
        profile: Profile of the rig.
        source: Origin of the samples: `real` or `sim:WHAT`.
        motors: Driver of both discs.
        streams: Streams of the devices, for their counters, the motors' first.
        watched: Names of the devices, and of requested answers, that are checked for silence.
    """

    watched: tuple[str, ...]

    def __init__(self, motors: DriveBus | RigBoard, *sensors: Stream, profile: RigProfile) -> None:
        self.profile = profile
        self.source = motors.source
        self.streams: tuple[Stream, ...] = (motors, *sensors)
        self.motors = motors
        self._leg: Drive = motors.leg
        self._ground: Drive = motors.ground
        self._time = HostTime()
        self._stack = ExitStack()

    @abstractmethod
    def watch(self, limits: Collection[str]) -> None:
        """Select the quantities to return in `Batch.further`, which need further measurements.

        Args:
            limits: Names of their limits in `FURTHER_LIMITS`: of lateral force, torque and
                temperature; all among `RigProfile.measured`.
        """

    @abstractmethod
    def read(self) -> Batch:
        """Return the samples that have arrived, without waiting; feeds the watchdogs."""

    def arm(self) -> None:
        """Energise the drive of the leg disc, then that of the ground disc, at standstill.

        Raises:
            RigError: A drive did not energise within `ARM_TIMEOUT`, or reports a fault.
        """
        self._leg.arm(ARM_TIMEOUT)
        self._ground.arm(ARM_TIMEOUT)

    def turn(self, leg: float, ground: float) -> None:
        """Command the speeds of both discs, positive driving.

        Args:
            leg: Speed of the leg disc [rad/s].
            ground: Speed of the ground disc [rad/s].

        Raises:
            LimitExceeded: A speed is NaN or beyond the limit of the rig's profile.
            RigTimeout: A link does not take the command.
        """
        self._leg.set_speed(leg)
        self._ground.set_speed(ground)

    def disarm(self) -> None:
        """Command both drives to stand and de-energise; errors of sending are suppressed.

        Of a rig on one micro-controller (`BoardBench`) both discs only get speed 0, because it has
        no command to de-energise.
        """
        self._leg.disarm()
        self._ground.disarm()

    def require_healthy(self) -> None:
        """Check the drives or the board by their latest status.

        Raises:
            DeviceFault: A drive or the board reports an error, or an armed drive left closed loop.
        """
        self.motors.require_healthy()

    def __enter__(self) -> Self:
        with ExitStack() as stack:
            for stream in reversed(self.streams):  # the motors are left first: it de-energises
                stack.enter_context(stream)
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *exception: object) -> None:
        self._stack.close()


class BoardBench(Bench):
    """Slip rig on one micro-controller.

    Args:
        board: Driver of the board, not yet entered.
        profile: Profile of the rig.
    """

    watched = ("board",)

    def __init__(self, board: RigBoard, *, profile: RigProfile) -> None:
        super().__init__(board, profile=profile)
        self._board = board

    def watch(self, limits: Collection[str]) -> None:
        """Do nothing: a board measures no further quantities; see `Bench.watch`."""

    def read(self) -> Batch:
        """Return the samples that have arrived, with the board's times converted to host time."""
        samples = self._board.read(0.0)
        forces, speeds = decode_board(self._board.profile, samples)
        taken = self._time.map(samples)
        readings = Readings(taken, speeds.leg, speeds.ground, forces.normal, forces.traction)
        return Batch(
            readings=readings,
            normal=forces.normal,
            traction=forces.traction,
            speeds={"leg": speeds.leg, "ground": speeds.ground},
            arrived={"board": samples},
            further={},
            taken={"board": taken},
            fault="",
            raw={self._board.name: samples},
        )


class DrivesBench(Bench):
    """Slip rig of two drives on a CAN bus and a load cell.

    Args:
        drives: Driver of both drives, not yet entered.
        cell: Driver of the load cell, not yet entered.
        profile: Profile of the rig.
    """

    def __init__(self, drives: DriveBus, cell: NetFtCell, *, profile: RigProfile) -> None:
        super().__init__(drives, cell, profile=profile)
        self.watched = ("load cell", "leg drive", "ground drive")
        self._drives = drives
        self._cell = cell
        self._further: frozenset[str] = frozenset()
        self._hot: dict[int, float] = {}
        # Columns time, normal and traction force: forces whose disc speeds are not known yet
        self._waiting = np.empty((0, 3))
        # Columns time and speed, from the last speed before the first waiting force on
        self._speeds = {"leg": np.empty((0, 2)), "ground": np.empty((0, 2))}

    def watch(self, limits: Collection[str]) -> None:
        """Select the quantities of `Batch.further`; request temperatures if they are among them.

        Requested temperatures are also checked for silence; see `Bench.watch`.
        """
        self._further = frozenset(limits)
        if "temperature_celsius" in self._further:
            self.watched += ("temperature of the leg drive", "temperature of the ground drive")
            self._drives.request_temperatures()

    def read(self) -> Batch:
        """Return the samples that have arrived, speeds interpolated at the times of the forces."""
        turned, weighed = self._drives.read(0.0), self._cell.read(0.0)
        hot = self._drives.take_temperatures()
        forces = decode_forces(self._cell.profile, weighed)
        taken = {"load cell": self._time.map(weighed)}
        new = np.column_stack([taken["load cell"], forces.normal, forces.traction])
        self._waiting = np.concatenate([self._waiting, new])
        arrived: dict[str, Sequence[object]] = {"load cell": weighed}
        speeds: dict[str, Array] = {}
        drives = self._drives.profile
        for disc, drive in (("leg", drives.leg), ("ground", drives.ground)):
            own = [sample for sample in turned if sample.channel == drive.node]
            arrived[f"{disc} drive"] = own
            rows = np.reshape([(s.host_time, disc_speed(drive, s.counts[1])) for s in own], (-1, 2))
            taken[f"{disc} drive"], speeds[disc] = rows.T
            self._speeds[disc] = np.concatenate([self._speeds[disc], rows])
            arrived[f"temperature of the {disc} drive"] = hot[drive.node]
        fault = describe_status(int(np.bitwise_or.reduce(weighed.status)))
        return Batch(
            readings=self._interpolate_speeds(),
            normal=forces.normal,
            traction=forces.traction,
            speeds=speeds,
            arrived=arrived,
            further=self._further_loads(weighed, hot),
            taken=taken,
            fault=f"load cell: {fault}" if fault else "",
            raw={self._drives.name: turned, self._cell.name: weighed},
        )

    def _further_loads(
        self, weighed: SampleColumns, hot: Mapping[int, list[float]]
    ) -> dict[str, Array]:
        """Compute the new values of the watched quantities by the name of their limit.

        They are lateral force [N], largest torque [N m], and the higher of the drives' latest
        temperatures at each answer of a drive [degC], each of shape (m,). The dictionary is empty
        where `watch` selected none, and lacks a torque for which the profile has no scale.
        """
        if not self._further:
            return {}
        lateral, torque = decode_further_loads(self._cell.profile, weighed)
        hottest = []
        for node, answers in hot.items():
            for self._hot[node] in answers:  # one series: a cool drive hides no hot one
                hottest.append(max(self._hot.values()))
        found = {
            "lateral_force": lateral,
            "torque": torque,
            "temperature_celsius": np.array(hottest),
        }
        return {k: v for k, v in found.items() if k in self._further and v is not None}

    def _interpolate_speeds(self) -> Readings:
        """Interpolate both discs' speeds linearly at the times of the waiting forces.

        Forces later than a disc's last speed wait for the next call; forces are discarded until
        both discs have sent a speed. A force before a disc's first speed gets that speed.
        """
        if not all(len(speeds) for speeds in self._speeds.values()):
            self._waiting = self._waiting[:0]
            return join([])
        known = min(speeds[-1, 0] for speeds in self._speeds.values())
        ready = self._waiting[self._waiting[:, 0] <= known]
        self._waiting = self._waiting[len(ready) :]
        across = [np.interp(ready[:, 0], s[:, 0], s[:, 1]) for s in self._speeds.values()]
        if len(ready):
            for disc, speeds in self._speeds.items():
                before = np.searchsorted(speeds[:, 0], ready[-1, 0], side="right") - 1
                self._speeds[disc] = speeds[max(before, 0) :]
        return Readings(ready[:, 0], across[0], across[1], ready[:, 1], ready[:, 2])


def make_bench(devices: RigDevices) -> Bench:
    """Return the bench of a rig: `BoardBench` with a board, else `DrivesBench`.

    Args:
        devices: Drivers of the rig, real or simulated, not yet entered.

    Returns:
        The bench, not yet entered.

    Raises:
        ProfileError: There is neither a board nor drives and a load cell.
    """
    if devices.board is not None:
        return BoardBench(devices.board, profile=devices.profile)
    if devices.drives is not None and devices.load_cell is not None:
        return DrivesBench(devices.drives, devices.load_cell, profile=devices.profile)
    raise ProfileError(
        f"the rig '{devices.profile.name}' has neither a board nor both drives and a load cell"
    )
