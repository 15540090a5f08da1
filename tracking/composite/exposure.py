# SPDX-License-Identifier: MIT
"""One exposure of the robot in a composite picture."""

from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from tracking.body import Alignment


@dataclass(frozen=True)
class Exposure:
    """One exposure of the robot in a composite picture.

    Attributes:
        alignment: Pose of the robot in the exposure, with covariances and score.
        visible: Share of the robot's top that no other exposure hides, in a picture of darkest
            values where it is the darkest, 0 to 1; always 1 in a mean, and of exposures found by
            the robot's marker [-].
    """

    alignment: Alignment
    visible: float

    @property
    def planar(self) -> Array:
        """x, y [m] and yaw [rad] of the robot, shape (3,)."""
        return self.alignment.pose.planar

    @property
    def is_rough(self) -> bool:
        """Whether alignment failed, so that the pose is that found on the coarse raster."""
        return self.alignment.score == 0.0


def disturbance(alignment: Alignment) -> float:
    """Compute the ratio of power of other things to the robot's, (1 - score²) / score² [-].

    The score must not be 0.
    """
    return max(1 - alignment.score**2, 0.0) / alignment.score**2


def widened(alignment: Alignment, slip: float, *, lever: float) -> Alignment:
    """Add independent errors of x, y and heading to the covariance of an alignment.

    Args:
        alignment: The alignment.
        slip: Standard deviation of the added error of x and of y [m].
        lever: Lever arm [m]; the added error of heading has standard deviation `slip / lever`
            [rad].
    """
    turn = slip / lever
    added = np.diag([slip, slip, 0.0, 0.0, 0.0, turn]) ** 2
    pose = replace(alignment.pose, covariance=alignment.pose.covariance + added)
    return replace(alignment, pose=pose)
