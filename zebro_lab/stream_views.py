# SPDX-License-Identifier: MIT
"""What a log holds of each device beside its raw counts: messages that every ROS 2 viewer knows.

They are for eyes. Stages go back to the raw counts and the profile.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Final, Protocol

import numpy as np

from model.slip.law import Array
from rig.device import Sample
from rig.imu.profile import ImuProfile, decode_orientation
from rig.slip_rig.decode import DiscSpeeds, Forces, decode_board, decode_forces
from rig.slip_rig.drives import disc_speed
from rig.slip_rig.profile import BoardProfile, DriveProfile, LoadCellProfile
from rig.zebro.profile import LegProfile, decode_angles
from zebro_lab.raw_log import COUNTS_NAME, VALUES_NAME
from zebro_lab.ros_messages import IMU, JOINT_STATE, WRENCH, Schema, imu, joint_state, wrench

FASTEST: Final = 200.0
"""Messages in a second that a viewer is given at most [Hz]."""


class View(Protocol):
    """How one device shows in a log."""

    @property
    def raw_schema(self) -> str:
        """Name of the schema of its raw samples, of `RAW_SCHEMAS`."""
        ...

    @property
    def metadata(self) -> Mapping[str, str]:
        """Names and units of its counts, for whoever has only the log."""
        ...

    @property
    def topics(self) -> Mapping[str, Schema]:
        """Topics that it writes, and their types."""
        ...

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Make the messages of samples, at least one.

        Args:
            samples: The next samples of the device.
            stamps: When each was read, since the Unix epoch [ns].

        Yields:
            Topic, stamp and message.
        """
        ...


class LegsView:
    """Leg angles as joint states, unwrapped; satisfies `View`.

    Args:
        name: Name of the stream.
        profile: Profile of the robot.
    """

    raw_schema = COUNTS_NAME

    def __init__(self, name: str, *, profile: LegProfile) -> None:
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
        """Make joint states; see `View.messages`."""
        theta = self._continued(samples)
        names = [f"leg_{leg}" for leg in sorted(self._profile.legs)]
        for row in range(0, len(samples), self._stride):
            yield self._topic, stamps[row], joint_state(stamps[row], names, position=theta[row])

    def _continued(self, samples: Sequence[Sample]) -> Array:
        """Decode angles so that they go on from the last sample of the call before."""
        if self._last is None:
            theta = decode_angles(self._profile, samples).theta
        else:
            before, angles = self._last
            decoded = decode_angles(self._profile, [before, *samples]).theta
            theta = decoded[1:] + (angles - decoded[0])
        self._last = samples[-1], theta[-1]
        return theta


class ImuView:
    """Orientation, rate and specific force of the body; satisfies `View`.

    Args:
        name: Name of the stream.
        profile: Profile of the unit.
    """

    raw_schema = COUNTS_NAME

    def __init__(self, name: str, *, profile: ImuProfile) -> None:
        self._topic = f"/{name}/data"
        self._profile = profile
        self._stride = _stride(profile.rate)
        self.topics = {self._topic: IMU}
        self.metadata = {
            "counts": "quaternion w, x, y, z, angular rate x, y, z, specific force x, y, z",
            "unit": f"1/{profile.quaternion_scale:g}, 1/{profile.rate_scale:g} rad/s, "
            f"1/{profile.force_scale:g} m/s2",
        }

    def messages(
        self, samples: Sequence[Sample], stamps: Sequence[int]
    ) -> Iterator[tuple[str, int, bytes]]:
        """Make `Imu` messages; see `View.messages`."""
        from scipy.spatial.transform import Rotation

        chosen = range(0, len(samples), self._stride)
        found = decode_orientation(self._profile, [samples[row] for row in chosen])
        angles = np.column_stack([found.yaw, found.pitch, found.roll])
        orientation = Rotation.from_euler("ZYX", angles).as_quat()
        for i, row in enumerate(chosen):
            message = imu(
                stamps[row],
                orientation=orientation[i],
                angular_rate=found.angular_rate[i],
                specific_force=found.specific_force[i],
            )
            yield self._topic, stamps[row], message


class DrivesView:
    """Angles and speeds of both discs as joint states; satisfies `View`.

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
        """Make joint states of one disc each; see `View.messages`."""
        for sample, stamp in zip(samples, stamps, strict=True):
            disc, place = self._discs[sample.channel]
            # What turns a velocity in revolutions into rad/s turns a position into rad.
            angle, speed = (disc_speed(place, count) for count in sample.counts)
            yield self._topic, stamp, joint_state(stamp, [disc], position=[angle], velocity=[speed])


class LoadCellView:
    """Mean force of each stretch of samples as a wrench; satisfies `View`.

    Args:
        name: Name of the stream.
        profile: Profile of the cell.
    """

    raw_schema = COUNTS_NAME

    def __init__(self, name: str, *, profile: LoadCellProfile) -> None:
        self._topic = f"/{name}/wrench"
        self._profile = profile
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
        """Make one wrench; see `View.messages`."""
        yield _mean_wrench(self._topic, decode_forces(self._profile, samples), stamps)


class BoardView:
    """Mean force and speeds of each stretch of samples; satisfies `View`.

    Args:
        name: Name of the stream.
        profile: Profile of the board.
    """

    raw_schema = COUNTS_NAME

    def __init__(self, name: str, *, profile: BoardProfile) -> None:
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
        """Make one wrench and one joint state; see `View.messages`."""
        forces, speeds = decode_board(self._profile, samples)
        yield _mean_wrench(self._wrench, forces, stamps)
        yield self._joints, stamps[-1], _mean_speeds(speeds, stamps[-1])


def _mean_wrench(topic: str, forces: Forces, stamps: Sequence[int]) -> tuple[str, int, bytes]:
    message = wrench(
        stamps[-1], normal=float(forces.normal.mean()), traction=float(forces.traction.mean())
    )
    return topic, stamps[-1], message


def _mean_speeds(speeds: DiscSpeeds, stamp: int) -> bytes:
    means = [float(speeds.leg.mean()), float(speeds.ground.mean())]
    return joint_state(stamp, ["leg_disc", "ground_disc"], velocity=means)


def _stride(rate: float) -> int:
    return max(int(np.ceil(rate / FASTEST)), 1)


def _axis(sign: int, index: int) -> str:
    return f"{'+' if sign > 0 else '-'}F{'xyz'[index]}"
