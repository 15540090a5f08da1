# SPDX-License-Identifier: MIT
"""Standard ROS 2 messages of each device, which a log holds besides the raw counts.

Only for display. Stages compute from the raw counts and the profile.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from rig.device import Sample
from rig.imu.profile import ImuProfile, decode_motion
from rig.sample_columns import as_columns
from rig.slip_rig.decode import Forces, decode_board, decode_forces
from rig.slip_rig.drives import disc_speed
from rig.slip_rig.profile import BoardProfile, DriveProfile, LoadCellProfile, RigProfile
from rig.zebro.profile import LegProfile, decode_angles
from zebro_lab.mcap.raw_log import COUNTS_NAME, VALUES_NAME
from zebro_lab.mcap.ros_messages import IMU, JOINT_STATE, WRENCH, Schema, imu, joint_state, wrench

FASTEST: Final = 50.0
"""Largest rate of display messages of legs and IMU; each call begins with a message [Hz]."""


MEAN_OVER: Final = 0.02
"""Interval over which forces and speeds are averaged for display, with the last time in it [s]."""
ENOUGH: Final = 1000.0
"""Least rate to which samples of the load cell are thinned before averaging for display [Hz]."""
_DISCS: Final = ("leg_disc", "ground_disc")


Messages = Iterator[tuple[str, int, bytes]]
"""Topic, time since the Unix epoch [ns] and CDR content of each message."""


@dataclass(frozen=True)
class StreamView:
    """Converter of one device's samples to display messages of a log.

    Attributes:
        raw_schema: Name of the schema of the device's raw samples, a key of `RAW_SCHEMAS`.
        metadata: Names and units of the device's counts, so that the log needs no profile.
        topics: Message type of each topic of the display messages.
        messages: Yields the display messages of the next samples of the device, at least one;
            the second argument is the time of reading of each sample since the Unix epoch [ns].
    """

    raw_schema: str
    metadata: Mapping[str, str]
    topics: Mapping[str, Schema]
    messages: Callable[[Sequence[Sample], Sequence[int]], Messages]


def legs_view(name: str, *, profile: LegProfile) -> StreamView:
    """Return the converter of leg counts to joint states of unwrapped angles, not of speeds.

    Messages are thinned to `FASTEST` or fewer. Another number of counts raises ProtocolError.

    Args:
        name: Name of the stream; the topic is `/NAME/joint_states`.
        profile: Profile of the robot's legs.
    """
    topic, unwrapped = f"/{name}/joint_states", UnwrappedAngles(profile)
    names = [f"leg_{leg}" for leg in sorted(profile.legs)]
    metadata = {
        "counts": ", ".join(f"leg_{leg}" for leg in profile.legs),
        "unit": f"1/{profile.counts_per_revolution} turn",
        "zero": ", ".join(f"{count:g}" for count in profile.zero_counts),
        "sign": ", ".join(map(str, profile.sign)),
    }

    def messages(samples: Sequence[Sample], stamps: Sequence[int]) -> Messages:
        theta = unwrapped(samples)
        for row in range(0, len(samples), _stride(profile.rate)):
            yield topic, stamps[row], joint_state(stamps[row], names, position=theta[row])

    raw_schema = VALUES_NAME if profile.layout == "table" else COUNTS_NAME
    return StreamView(raw_schema, metadata, {topic: JOINT_STATE}, messages)


class UnwrappedAngles:
    """Decoder of leg angles that stay unwrapped across calls.

    Args:
        profile: Profile of the robot's legs.
    """

    def __init__(self, profile: LegProfile) -> None:
        self._profile = profile
        self._last: tuple[Sample, Array] | None = None

    def __call__(self, samples: Sequence[Sample]) -> Array:
        """Decode the unwrapped angles of the next samples, at least one, shape (n, legs) [rad].

        Columns by ascending leg number; the first angles of all are in [-pi, pi]. Another number of
        counts than the profile's legs raises ProtocolError.
        """
        if self._last is None:
            theta = decode_angles(self._profile, samples).theta
        else:
            before, angles = self._last
            decoded = decode_angles(self._profile, [before, *samples]).theta
            theta = decoded[1:] + (angles - decoded[0])
        self._last = samples[-1], theta[-1]
        return theta


def imu_view(name: str, *, profile: ImuProfile) -> StreamView:
    """Return the converter of IMU counts to orientation, rate and specific force of the body.

    Args:
        name: Name of the stream; the topic is `/NAME/data`, its rate in a call at most `FASTEST`.
        profile: Profile of the inertial unit, with its mounting on the body.
    """
    topic, stride = f"/{name}/data", _stride(profile.rate)
    metadata = {
        "counts": ", ".join(name for name, _ in profile.record),
        "unit": f"quaternion 1/{profile.quaternion_scale:g}, angle 1/{profile.angle_scale:g} rad, "
        f"rate 1/{profile.rate_scale:g} rad/s, force 1/{profile.force_scale:g} m/s2",
    }

    def messages(samples: Sequence[Sample], stamps: Sequence[int]) -> Messages:
        counts = as_columns(samples).counts[::stride]
        body, rates, forces = decode_motion(profile, counts)
        motion = (body.as_quat().tolist(), rates.tolist(), forces.tolist())
        for stamp, q, w, f in zip(stamps[::stride], *motion, strict=True):
            yield topic, stamp, imu(stamp, orientation=q, angular_rate=w, specific_force=f)

    raw_schema = VALUES_NAME if profile.has_fractions else COUNTS_NAME
    return StreamView(raw_schema, metadata, {topic: IMU}, messages)


def drives_view(name: str, *, profile: DriveProfile) -> StreamView:
    """Return the converter of motor counts to joint states: each sample's disc, angle and speed.

    Args:
        name: Name of the stream; the topic is `/NAME/joint_states`.
        profile: Profile of both drives; a sample of another node raises KeyError.
    """
    topic = f"/{name}/joint_states"
    discs = {
        profile.leg.node: ("leg_disc", profile.leg),
        profile.ground.node: ("ground_disc", profile.ground),
    }
    metadata = {
        "counts": "motor position, motor velocity",
        "unit": "turn, turn/s",
        "channels": ", ".join(f"{node} {disc}" for node, (disc, _) in discs.items()),
        "turns of the motor in one of the disc": ", ".join(
            f"{place.sign * place.gear:g}" for _, place in discs.values()
        ),
    }

    def messages(samples: Sequence[Sample], stamps: Sequence[int]) -> Messages:
        for sample, stamp in zip(samples, stamps, strict=True):
            disc, place = discs[sample.channel]
            # The factor from rev/s to rad/s also converts a position from rev to rad.
            angle, speed = (disc_speed(place, count) for count in sample.counts)
            yield topic, stamp, joint_state(stamp, [disc], position=[angle], velocity=[speed])

    return StreamView(VALUES_NAME, metadata, {topic: JOINT_STATE}, messages)


def load_cell_view(name: str, *, profile: LoadCellProfile) -> StreamView:
    """Return the converter of load cell counts to wrenches: mean forces over `MEAN_OVER`.

    The zero offset is not subtracted; each mean is stamped with its last sample's time.

    Args:
        name: Name of the stream; the topic is `/NAME/wrench`.
        profile: Profile of the load cell.
    """
    topic, step = f"/{name}/wrench", max(int(profile.rate / ENOUGH), 1)
    metadata = {
        "counts": "Fx, Fy, Fz, Tx, Ty, Tz",
        "unit": f"1/{profile.counts_per_force:g} N for the forces",
        "normal force": _axis(profile.normal.sign, profile.normal.index),
        "traction force": _axis(profile.traction.sign, profile.traction.index),
    }

    def messages(samples: Sequence[Sample], stamps: Sequence[int]) -> Messages:
        forces = decode_forces(profile, samples[::step])
        return _mean_wrenches(topic, forces, stamps[::step], profile.rate / step)

    return StreamView(COUNTS_NAME, metadata, {topic: WRENCH}, messages)


def board_view(name: str, *, profile: BoardProfile) -> StreamView:
    """Return the converter of the board's counts to wrenches and joint states: `MEAN_OVER` means.

    Args:
        name: Name; topics `/NAME/wrench`, zero not subtracted, and `/NAME/joint_states`, no angles.
        profile: Profile of the rig's board.
    """
    wrenches, joints = f"/{name}/wrench", f"/{name}/joint_states"
    metadata = {
        "counts": "normal force, traction force, speed of leg disc, speed of ground disc",
        "unit": f"1/{profile.counts_per_force:g} N (signs {profile.normal_sign}, "
        f"{profile.traction_sign}), 1/{profile.counts_per_speed:g} rad/s",
    }

    def messages(samples: Sequence[Sample], stamps: Sequence[int]) -> Messages:
        forces, speeds = decode_board(profile, samples)
        yield from _mean_wrenches(wrenches, forces, stamps, profile.rate)
        for part in _parts(len(samples), profile.rate):
            means = [float(speeds.leg[part].mean()), float(speeds.ground[part].mean())]
            stamp = stamps[part.stop - 1]
            yield joints, stamp, joint_state(stamp, _DISCS, velocity=means)

    raw_schema = VALUES_NAME if profile.link == "table" else COUNTS_NAME
    return StreamView(raw_schema, metadata, {wrenches: WRENCH, joints: JOINT_STATE}, messages)


def rig_views(profile: RigProfile) -> dict[str, StreamView]:
    """Return the views of a slip rig by stream: `board`, `drives`, `load_cell` as it has them."""
    views: dict[str, StreamView] = {}
    if profile.board is not None:
        views["board"] = board_view("board", profile=profile.board)
    if profile.drives is not None:
        views["drives"] = drives_view("drives", profile=profile.drives)
    if profile.load_cell is not None:
        views["load_cell"] = load_cell_view("load_cell", profile=profile.load_cell)
    return views


def _mean_wrenches(topic: str, forces: Forces, stamps: Sequence[int], rate: float) -> Messages:
    for part in _parts(len(stamps), rate):
        normal, traction = float(forces.normal[part].mean()), float(forces.traction[part].mean())
        stamp = stamps[part.stop - 1]
        yield topic, stamp, wrench(stamp, normal=normal, traction=traction)


def _parts(count: int, rate: float) -> Iterator[slice]:
    """Yield slices of `count` samples at `rate` [Hz] over `MEAN_OVER` each, at least one sample.

    The last may be shorter.
    """
    length = max(round(rate * MEAN_OVER), 1)
    for first in range(0, count, length):
        yield slice(first, min(first + length, count))


def _stride(rate: float) -> int:
    return max(int(np.ceil(rate / FASTEST)), 1)


def _axis(sign: int, index: int) -> str:
    return f"{'+' if sign > 0 else '-'}F{'xyz'[index]}"
