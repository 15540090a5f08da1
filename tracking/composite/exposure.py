# SPDX-License-Identifier: MIT
"""One exposure of the robot in a composite picture."""

from dataclasses import dataclass, replace

import numpy as np

from tracking.body import Alignment
from tracking.camera.lens import Array


@dataclass(frozen=True)
class Exposure:
    """One exposure of the robot in a composite picture.

    Attributes:
        alignment: Where it is.
        visible: Share of its top that no other hides [-].
    """

    alignment: Alignment
    visible: float

    @property
    def planar(self) -> Array:
        """x, y [m] and yaw [rad], shape (3,)."""
        return self.alignment.pose.planar

    @property
    def is_rough(self) -> bool:
        """Whether it could not be aligned and is where a raster showed it."""
        return self.alignment.score == 0.0


def disturbance(alignment: Alignment) -> float:
    """Compute the power of other things over that of the robot, from the correlation [-]."""
    return max(1 - alignment.score**2, 0.0) / alignment.score**2


def widened(alignment: Alignment, slip: float, *, lever: float) -> Alignment:
    """Add independent errors of x, y and heading to the covariance of an alignment.

    Args:
        alignment: The alignment.
        slip: Standard deviation of x and of y [m].
        lever: Lever arm that converts it to heading [m].
    """
    turn = slip / lever
    added = np.diag([slip, slip, 0.0, 0.0, 0.0, turn]) ** 2
    pose = replace(alignment.pose, covariance=alignment.pose.covariance + added)
    return replace(alignment, pose=pose)
