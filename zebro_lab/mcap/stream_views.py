# SPDX-License-Identifier: MIT
"""Standard ROS 2 messages of each device, which a log holds besides the raw counts.

Only for display. Stages compute from the raw counts and the profile.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Final, Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from model.slip.law import Array
from rig.device import Sample
from rig.imu.profile import ImuProfile
from rig.sample_columns import as_columns
from rig.slip_rig.decode import Forces, decode_board, decode_forces
from rig.slip_rig.drives import disc_speed
from rig.slip_rig.profile import BoardProfile, DriveProfile, LoadCellProfile, RigProfile
from rig.zebro.profile import LegProfile, decode_angles
from zebro_lab.mcap.raw_log import COUNTS_NAME, VALUES_NAME
from zebro_lab.mcap.ros_messages import IMU, JOINT_STATE, WRENCH, Schema, imu, joint_state, wrench

FASTEST: Final = 50.0
"""Largest rate of display messages [Hz]."""


MEAN_OVER: Final = 0.02
"""Interval over which fast samples are averaged for display [s]."""
ENOUGH: Final = 1000.0
"""Rate to which samples are thinned before they are averaged for display [Hz]."""
_DISCS: Final = ("leg_disc", "ground_disc")


class StreamView(Protocol):
    """Converter of one device's samples to display messages of a log."""

    @property
    def raw_schema(self) -> str:
        """Name of the schema of its raw samples, of `RAW_SCHEMAS`."""
        ...

    @property
    def metadata(self) -> Mapping[str, str]:
        """Names and units of its counts, so that the log can be read on its own."""
        ...

    @property
    def topics(self) -> Mapping[str, Schema]:
        """Topics that it writes, and their types."""
        ...

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield the display messages of samples.

        Args:
            samples: The next samples of the device, at least one.
            stamps: Time at which each was read, since the Unix epoch [ns].

        Yields:
            Topic, stamp and message.
        """
        ...


class LegsView:
    """Leg angles as joint states, unwrapped; satisfies `StreamView`.

    Args:
        name: Name of the stream.
        profile: Profile of the robot.
    """

    def __init__(self, name: str, *, profile: LegProfile) -> None:
        self.raw_schema = VALUES_NAME if profile.layout == "table" else COUNTS_NAME
        self._topic = f"/{name}/joint_states"
        self._profile = profile
        self._stride = _stride(profile.rate)
        self._last: tuple[Sample, Array] | None = None
        self.topics = {self._topic: JOINT_STATE}
        self.metadata = {
            "counts": ", ".join(f"leg_{leg}" for leg in profile.legs),
            "unit": f"1/{profile.counts_per_revolution} turn",
            "zero": ", ".join(f"{count:g}" for count in profile.zero_counts),
            "sign": ", ".join(map(str, profile.sign)),
        }

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield joint states of the legs; see `StreamView.messages`.

        Args:
            samples: The next samples of the robot.
            stamps: Time at which each was read, since the Unix epoch [ns].
        """
        theta = self._continued(samples)
        names = [f"leg_{leg}" for leg in sorted(self._profile.legs)]
        for row in range(0, len(samples), self._stride):
            yield self._topic, stamps[row], joint_state(stamps[row], names, position=theta[row])

    def _continued(self, samples: Sequence[Sample]) -> Array:
        """Decode angles, unwrapped continuously from the last sample of the previous call."""
        if self._last is None:
            theta = decode_angles(self._profile, samples).theta
        else:
            before, angles = self._last
            decoded = decode_angles(self._profile, [before, *samples]).theta
            theta = decoded[1:] + (angles - decoded[0])
        self._last = samples[-1], theta[-1]
        return theta


class ImuView:
    """Orientation, rate and specific force of the body; satisfies `StreamView`.

    Args:
        name: Name of the stream.
        profile: Profile of the unit.
    """

    def __init__(self, name: str, *, profile: ImuProfile) -> None:
        self.raw_schema = VALUES_NAME if profile.link == "table" else COUNTS_NAME
        self._topic = f"/{name}/data"
        self._profile = profile
        self._stride = _stride(profile.rate)
        self._mount = Rotation.from_quat(profile.mounting, scalar_first=True)
        self._unmount = self._mount.inv()
        self.topics = {self._topic: IMU}
        self.metadata = {
            "counts": "quaternion w, x, y, z, angular rate x, y, z, specific force x, y, z",
            "unit": f"1/{profile.quaternion_scale:g}, 1/{profile.rate_scale:g} rad/s, "
            f"1/{profile.force_scale:g} m/s2",
        }

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield `Imu` messages; see `StreamView.messages`.

        Args:
            samples: The next samples of the unit.
            stamps: Time at which each was read, since the Unix epoch [ns].
        """
        chosen = range(0, len(samples), self._stride)
        counts = as_columns(samples).counts[:: self._stride]
        # Not from roll, pitch and yaw, as in decode_orientation: that would take several times as
        # long, ten times a second.
        measured = Rotation.from_quat(counts[:, :4], scalar_first=True)
        orientation = (measured * self._unmount).as_quat().tolist()
        rate = self._mount.apply(counts[:, 4:7] / self._profile.rate_scale).tolist()
        force = self._mount.apply(counts[:, 7:] / self._profile.force_scale).tolist()
        for i, row in enumerate(chosen):
            message = imu(
                stamps[row],
                orientation=orientation[i],
                angular_rate=rate[i],
                specific_force=force[i],
            )
            yield self._topic, stamps[row], message


class DrivesView:
    """Angles and speeds of both discs as joint states; satisfies `StreamView`.

    Args:
        name: Name of the stream.
        profile: Both drives.
    """

    raw_schema = VALUES_NAME

    def __init__(self, name: str, *, profile: DriveProfile) -> None:
        self._topic = f"/{name}/joint_states"
        self._discs = {
            profile.leg.node: ("leg_disc", profile.leg),
            profile.ground.node: ("ground_disc", profile.ground),
        }
        self.topics = {self._topic: JOINT_STATE}
        self.metadata = {
            "counts": "motor position, motor velocity",
            "unit": "turn, turn/s",
            "channels": ", ".join(f"{node} {disc}" for node, (disc, _) in self._discs.items()),
            "turns of the motor in one of the disc": ", ".join(
                f"{place.sign * place.gear:g}" for _, place in self._discs.values()
            ),
        }

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield joint states of one disc each; see `StreamView.messages`.

        Args:
            samples: The next samples of both drives.
            stamps: Time at which each was read, since the Unix epoch [ns].
        """
        for sample, stamp in zip(samples, stamps, strict=True):
            disc, place = self._discs[sample.channel]
            # The factor from rev/s to rad/s also converts a position from rev to rad.
            angle, speed = (disc_speed(place, count) for count in sample.counts)
            yield self._topic, stamp, joint_state(stamp, [disc], position=[angle], velocity=[speed])


class LoadCellView:
    """Mean force of each `MEAN_OVER` as a wrench; satisfies `StreamView`.

    Args:
        name: Name of the stream.
        profile: Profile of the cell.
    """

    raw_schema = COUNTS_NAME

    def __init__(self, name: str, *, profile: LoadCellProfile) -> None:
        self._topic = f"/{name}/wrench"
        self._profile = profile
        self._thin = max(int(profile.rate / ENOUGH), 1)
        self.topics = {self._topic: WRENCH}
        self.metadata = {
            "counts": "Fx, Fy, Fz, Tx, Ty, Tz",
            "unit": f"1/{profile.counts_per_force:g} N for the forces",
            "normal force": _axis(profile.normal.sign, profile.normal.index),
            "traction force": _axis(profile.traction.sign, profile.traction.index),
        }

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield wrenches of mean forces; see `StreamView.messages`.

        Args:
            samples: The next samples of the load cell.
            stamps: Time at which each was read, since the Unix epoch [ns].
        """
        step = self._thin
        forces = decode_forces(self._profile, samples[::step])
        yield from _mean_wrenches(self._topic, forces, stamps[::step], self._profile.rate / step)


class RigBoardView:
    """Mean force and speeds of each `MEAN_OVER`; satisfies `StreamView`.

    Args:
        name: Name of the stream.
        profile: Profile of the board.
    """

    def __init__(self, name: str, *, profile: BoardProfile) -> None:
        self.raw_schema = VALUES_NAME if profile.link == "table" else COUNTS_NAME
        self._profile = profile
        self._wrench = f"/{name}/wrench"
        self._joints = f"/{name}/joint_states"
        self.topics = {self._wrench: WRENCH, self._joints: JOINT_STATE}
        self.metadata = {
            "counts": "normal force, traction force, speed of leg disc, speed of ground disc",
            "unit": f"1/{profile.counts_per_force:g} N (signs {profile.normal_sign}, "
            f"{profile.traction_sign}), 1/{profile.counts_per_speed:g} rad/s",
        }

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Yield wrenches and joint states of mean forces and speeds; see `StreamView.messages`.

        Args:
            samples: The next samples of the board.
            stamps: Time at which each was read, since the Unix epoch [ns].
        """
        forces, speeds = decode_board(self._profile, samples)
        yield from _mean_wrenches(self._wrench, forces, stamps, self._profile.rate)
        for part in _parts(len(samples), self._profile.rate):
            means = [float(speeds.leg[part].mean()), float(speeds.ground[part].mean())]
            stamp = stamps[part.stop - 1]
            yield self._joints, stamp, joint_state(stamp, _DISCS, velocity=means)


def rig_views(profile: RigProfile) -> dict[str, StreamView]:
    """Return the views of all streams of a slip rig, by the streams' names."""
    views: dict[str, StreamView] = {}
    if profile.board is not None:
        views["board"] = RigBoardView("board", profile=profile.board)
    if profile.drives is not None:
        views["drives"] = DrivesView("drives", profile=profile.drives)
    if profile.load_cell is not None:
        views["load_cell"] = LoadCellView("load_cell", profile=profile.load_cell)
    return views


def _mean_wrenches(
    topic: str, forces: Forces, stamps: Sequence[int], rate: float
) -> Iterator[tuple[str, int, bytes]]:
    for part in _parts(len(stamps), rate):
        normal, traction = float(forces.normal[part].mean()), float(forces.traction[part].mean())
        stamp = stamps[part.stop - 1]
        yield topic, stamp, wrench(stamp, normal=normal, traction=traction)


def _parts(count: int, rate: float) -> Iterator[slice]:
    """Split samples into intervals of `MEAN_OVER`, the last one shorter."""
    length = max(round(rate * MEAN_OVER), 1)
    for first in range(0, count, length):
        yield slice(first, min(first + length, count))


def _stride(rate: float) -> int:
    return max(int(np.ceil(rate / FASTEST)), 1)


def _axis(sign: int, index: int) -> str:
    return f"{'+' if sign > 0 else '-'}F{'xyz'[index]}"
