# SPDX-License-Identifier: MIT
"""State and appearance of the robot in a synthetic photograph."""

from dataclasses import dataclass, field, replace

import numpy as np

from model.arrays import Array

PLATE_TOP = 0.0385  # of the top plate above the body's centre [m]


@dataclass(frozen=True)
class DrawnPose:
    """Pose of the body's centre, R = Rz(yaw) Ry(pitch) Rx(roll).

    Attributes:
        x: Inertial [m].
        y: Inertial [m].
        yaw: [rad].
        z: Height of the body's centre above the floor [m].
        roll: Left side up [rad].
        pitch: Nose down [rad].
    """

    x: float
    y: float
    yaw: float
    z: float = 0.0645
    roll: float = 0.0
    pitch: float = 0.0

    @property
    def position(self) -> Array:
        """Shape (3,) [m]."""
        return np.array([self.x, self.y, self.z])

    @property
    def rotation(self) -> Array:
        """From the body frame to the inertial one, shape (3, 3)."""
        (cr, cp, cy), (sr, sp, sy) = (
            f(np.array([self.roll, self.pitch, self.yaw])) for f in (np.cos, np.sin)
        )
        return np.array([
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ])  # fmt: skip


@dataclass(frozen=True)
class RobotState:
    """Pose, leg angles and velocity of the robot during a photograph.

    Attributes:
        pose: In the middle of the exposure.
        leg_angles: Shape (6,) [rad].
        velocity_xy: Of the body's centre, inertial [m/s].
        yaw_rate: [rad/s].
    """

    pose: DrawnPose
    leg_angles: tuple[float, ...] = (1.2, 4.4, 4.4, 1.2, 1.2, 4.4)
    velocity_xy: tuple[float, float] = (0.0, 0.0)
    yaw_rate: float = 0.0

    def pose_at(self, time: float) -> DrawnPose:
        """Return the pose some time after the middle of the exposure [s]."""
        return replace(
            self.pose,
            x=self.pose.x + time * self.velocity_xy[0],
            y=self.pose.y + time * self.velocity_xy[1],
            yaw=self.pose.yaw + time * self.yaw_rate,
        )


@dataclass(frozen=True)
class DrawnRobotMarker:
    """A square marker on the robot, its top towards the head, its border one cell wide.

    Attributes:
        marker_id: Its number in the dictionary.
        side: Of the black square [m].
        height: Above the body's centre; more than the top plate's puts it on a thin mast that the
            picture leaves out [m].
        dictionary: Name of a dictionary in `cv2.aruco`.
    """

    marker_id: int = 0
    side: float = 0.12
    height: float = PLATE_TOP
    dictionary: str = "DICT_4X4_50"

    @property
    def corners_body(self) -> Array:
        """Corners of the black square in the body frame, shape (4, 3) [m].

        Top left, top right, bottom right, bottom left of the print: the first is left of the head.
        """
        half = self.side / 2
        return np.array([(x, y, self.height) for x, y in
                         ((half, half), (half, -half), (-half, -half), (-half, half))])  # fmt: skip


@dataclass(frozen=True)
class RobotLook:
    """Appearance of a robot.

    Attributes:
        marker: On its plate; None for a robot without a marker.
        plate_seed: Of the parts on its top plate.
        parts: Number of parts on its top plate; 0 leaves it plain.
    """

    marker: DrawnRobotMarker | None = field(default_factory=DrawnRobotMarker)
    plate_seed: int = 7
    parts: int = 18


def marker_corners(state: RobotState, marker: DrawnRobotMarker) -> Array:
    """Compute the inertial corners of a marker in the middle of the exposure, shape (4, 3) [m]."""
    return marker.corners_body @ state.pose.rotation.T + state.pose.position
