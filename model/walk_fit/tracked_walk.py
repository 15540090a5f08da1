# SPDX-License-Identifier: MIT
"""A walk with its leg angles, its tracked poses and their covariance."""

from dataclasses import dataclass

from model.arrays import Array
from model.errors import InsufficientData
from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference
from model.joint_covariance import JointCovariance
from model.walk_fit.tilt import MeasuredTilt

FEWEST_POSES = 3  # one to start from and two to compare


@dataclass(frozen=True)
class TrackedWalk:
    """A walk with its leg angles and its tracked poses.

    Attributes:
        name: Name of the walk.
        legs: Leg angles from time zero on.
        t: Times of the tracked poses by the clock of the leg angles, increasing from zero or later;
            the prediction is moved onto the first pose, shape (n,) [s].
        states: Tracked x, y [m] and yaw [rad], shape (n, 3).
        joint: The tracker's covariance of x, y and yaw of all poses.
        tilt: Roll and pitch by the robot's IMU; None without an IMU.

    Raises:
        InsufficientData: There are fewer than three poses.
    """

    name: str
    legs: LegReference | InexactLog
    t: Array
    states: Array
    joint: JointCovariance
    tilt: MeasuredTilt | None = None

    def __post_init__(self) -> None:
        """Check that there are enough tracked poses."""
        if len(self.t) < FEWEST_POSES:
            raise InsufficientData(
                f"walk '{self.name}' has {len(self.t)} tracked poses; expected {FEWEST_POSES} or "
                "more"
            )


def middle(legs: LegReference | InexactLog) -> LegReference:
    """Return an inexact log's leg angles smoothed within what it allows; others as they are."""
    return legs.smooth() if isinstance(legs, InexactLog) else legs
