# SPDX-License-Identifier: MIT
"""Convert raw samples of a rig to speeds, forces and instantaneous slip ratio, in SI."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from model.slip.definition import SlipDefinition, slip_ratio
from rig.device import Sample
from rig.errors import ProtocolError
from rig.sample_columns import as_columns
from rig.slip_rig.profile import (
    BoardProfile,
    DiscDrive,
    ForceAxis,
    LoadCellProfile,
    RigProfile,
    Zero,
)

BATCHES: Final = 10
"""Number of consecutive batches whose means give a standard error."""


@dataclass(frozen=True)
class Forces:
    """Forces at the contact of both discs.

    Attributes:
        time: Host time at which each force was read, shape (n,) [s].
        normal: Normal force, positive when pressed together, shape (n,) [N].
        traction: Traction force, positive when driving, shape (n,) [N].
    """

    time: Array
    normal: Array
    traction: Array


@dataclass(frozen=True)
class DiscSpeeds:
    """Angular speeds of both discs at the same instants.

    Attributes:
        time: Host time at which the speeds were read, shape (n,) [s].
        leg: Speed of the leg disc, positive driving, shape (n,) [rad/s].
        ground: Speed of the ground disc, positive driving, shape (n,) [rad/s].
    """

    time: Array
    leg: Array
    ground: Array


def disc_speed(drive: DiscDrive, velocity: float) -> float:
    """Compute the angular speed of a disc from its motor's, positive driving [rad/s].

    Args:
        drive: Drive of the disc, with gear and sign.
        velocity: Speed of the motor, the second count of a sample [rev/s].

    >>> round(disc_speed(DiscDrive(node=0, gear=10.0, sign=-1), -20.0), 3)
    12.566
    """
    return drive.sign * velocity * 2 * math.pi / drive.gear


def measured_slip(omega_leg: Array, omega_ground: Array, profile: RigProfile) -> Array:
    """Compute the instantaneous material slip ratio from both speeds, Eq. (4-44).

    Args:
        omega_leg: Speed of the leg disc, shape (n,) [rad/s].
        omega_ground: Speed of the ground disc, shape (n,) [rad/s].
        profile: Profile of the rig, with the radii of the discs.

    Returns:
        Slip ratio, NaN or infinite where the leg disc stands still, shape (n,) [-].
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return slip_ratio(
            omega_leg * profile.radius_leg,
            omega_ground * profile.radius_ground,
            SlipDefinition.MATERIAL,
        )


def decode_forces(profile: LoadCellProfile, samples: Sequence[Sample]) -> Forces:
    """Compute forces from the counts of a load cell.

    Args:
        profile: Profile of the cell, with scale, axes and signs.
        samples: Samples of the cell.

    Returns:
        Normal and traction force; the zero offset is not subtracted.
    """
    columns = as_columns(samples)
    counts = columns.counts.reshape(-1, 6)

    def newtons(axis: ForceAxis) -> Array:
        """Convert the counts of a channel to a force with the sign of the conventions, (n,) [N]."""
        return counts[:, axis.index] / (axis.sign * profile.counts_per_force)

    return Forces(columns.host_time, newtons(profile.normal), newtons(profile.traction))


def decode_further_loads(
    profile: LoadCellProfile, samples: Sequence[Sample]
) -> tuple[Array, Array | None]:
    """Compute the lateral force and the largest torque from the counts of a load cell.

    Args:
        profile: Profile of the cell.
        samples: Samples of the cell.

    Returns:
        Force on the axis that is neither normal nor traction, with the cell's sign, shape (n,) [N],
        and the largest magnitude of the three torques, shape (n,) [N m]; None for the torques where
        the profile has no scale for them.
    """
    counts = as_columns(samples).counts.reshape(-1, 6).astype(float)
    lateral = counts[:, 3 - profile.normal.index - profile.traction.index]  # 0 + 1 + 2 = 3
    scale = profile.counts_per_torque
    torque = None if scale is None else np.abs(counts[:, 3:]).max(axis=1) / scale
    return lateral / profile.counts_per_force, torque


def decode_speeds(leg: DiscDrive, ground: DiscDrive, samples: Sequence[Sample]) -> DiscSpeeds:
    """Compute the speeds of both discs at the instants of the leg disc's samples.

    The drives report in turns, so the ground disc's speed is interpolated linearly, and held before
    its first and after its last sample.

    Args:
        leg: Drive of the leg disc.
        ground: Drive of the ground disc.
        samples: Samples of both drives, in order of time.

    Returns:
        Both speeds, positive driving.

    Raises:
        ProtocolError: There is no sample of one of the drives.
    """
    return DiscSpeeds(*_across(leg, ground, samples, count=1))


def decode_disc_angles(
    leg: DiscDrive, ground: DiscDrive, samples: Sequence[Sample]
) -> tuple[Array, Array]:
    """Compute the angles of both discs at the instants of `decode_speeds`, from motor positions.

    They count from where the encoders do, which is usually where the drives were switched on.

    Args:
        leg: Drive of the leg disc.
        ground: Drive of the ground disc.
        samples: Samples of both drives, in order of time.

    Returns:
        Angle of leg disc and ground disc, accumulated, positive driving, shape (n,) each [rad].

    Raises:
        ProtocolError: There is no sample of one of the drives.
    """
    return _across(leg, ground, samples, count=0)[1:]


def _across(
    leg: DiscDrive, ground: DiscDrive, samples: Sequence[Sample], *, count: int
) -> tuple[Array, Array, Array]:
    """Return the leg drive's sample times [s], and angles or speeds of both discs at these times.

    `count` selects them: 0 for angles [rad], 1 for speeds [rad/s], as counts of a sample are motor
    position [rev] and velocity [rev/s]. The ground disc's are interpolated linearly, and held
    before its first and after its last sample.

    Raises:
        ProtocolError: There is no sample of one of the drives.
    """
    columns = as_columns(samples)
    time, turned = {}, {}
    for drive in (leg, ground):
        own = columns.channel == drive.node
        if not own.any():
            raise ProtocolError(f"no sample came from the drive with node {drive.node}")
        time[drive.node] = columns.host_time[own]
        turned[drive.node] = disc_speed(drive, 1.0) * columns.counts[own, count]
    at = time[leg.node]
    return at, turned[leg.node], np.interp(at, time[ground.node], turned[ground.node])


def decode_board(profile: BoardProfile, samples: Sequence[Sample]) -> tuple[Forces, DiscSpeeds]:
    """Compute forces and speeds from the counts of a board.

    Args:
        profile: Profile of the board, with scales and signs of the forces.
        samples: Samples of the board.

    Returns:
        Forces and speeds at the same instants; the zero offset is not subtracted.
    """
    columns = as_columns(samples)
    counts, time = columns.counts.reshape(-1, 4), columns.host_time
    newtons = counts[:, :2] / profile.counts_per_force
    speeds = counts[:, 2:4] / profile.counts_per_speed
    forces = Forces(
        time, profile.normal_sign * newtons[:, 0], profile.traction_sign * newtons[:, 1]
    )
    return forces, DiscSpeeds(time, speeds[:, 0], speeds[:, 1])


def standard_error(values: Array) -> float:
    """Compute the standard error of the mean of autocorrelated values from batch means.

    Args:
        values: At least `BATCHES` values in order of time, shape (n,), in any unit.

    Returns:
        Standard deviation of the `BATCHES` batch means over the root of `BATCHES`.
    """
    means = [batch.mean() for batch in np.array_split(values, BATCHES)]
    return float(np.std(means, ddof=1) / np.sqrt(BATCHES))


def tare(forces: Forces) -> Zero:
    """Compute the zero offset of an unloaded rig: the mean of both forces.

    Args:
        forces: At least ten readings without load.

    Returns:
        The zero. Its standard error comes from batch means, because readings are autocorrelated.

    Raises:
        ProtocolError: There are fewer than ten readings.
    """
    if len(forces.time) < BATCHES:
        raise ProtocolError(
            f"found {len(forces.time)} forces for a zero; expected at least {BATCHES}: take longer"
        )
    return Zero(
        normal=float(forces.normal.mean()),
        traction=float(forces.traction.mean()),
        standard_error=max(map(standard_error, (forces.normal, forces.traction))),
    )


def zero_change(before: Zero, after: Zero, *, limit: float) -> str:
    """Say by how much a zero has moved, of the channel that moved more; empty within the limit.

    Args:
        before: Earlier zero.
        after: Later zero.
        limit: Largest change allowed, to which twice the standard error of the change is added [N].
    """
    error = float(np.hypot(before.standard_error, after.standard_error))
    moved = {name: getattr(after, name) - getattr(before, name) for name in ("normal", "traction")}
    name = max(moved, key=lambda each: abs(moved[each]))
    if abs(moved[name]) <= limit + 2 * error:
        return ""
    return f"the {name} force's zero has moved by {moved[name]:.3g} N; its limit is {limit:g} N"
