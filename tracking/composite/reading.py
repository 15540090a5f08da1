# SPDX-License-Identifier: MIT
"""Ways to merge exposures into one picture, and the interface of their readings."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tracking.body.plane import Plane
from tracking.camera.lens import Array
from tracking.composite.body_raster import BodyRaster
from tracking.composite.exposure import Exposure


class Merged(StrEnum):
    """How exposures were merged into one picture."""

    PASTED = "pasted"
    """The robot was cut out of each photograph and pasted on the others: it shows whole, or is
    hidden by another."""
    DARKEST = "darkest"
    """Each pixel has the darkest value of all photographs."""
    MEAN = "mean"
    """Each pixel has the mean of all photographs: of n exposures each is as faint as 1/n."""


class Reading(Protocol):
    """Interface: find and align the exposures of a picture from one that is known."""

    def find(self) -> Array:
        """Find all exposures on a raster.

        Returns:
            x, y [m] and yaw [rad] of each, the known one first, shape (n, 3).
        """
        ...

    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align exposures with the photograph.

        Args:
            poses: What `find` returned, shape (n, 3), n at least 2.

        Returns:
            The exposures, the known one first; without those that are rejected.
        """
        ...


@dataclass(frozen=True)
class PictureRaster:
    """A picture on a raster, and a raster of the robot to compare with it.

    Attributes:
        plane: The raster.
        picture: Colours on it, shape (rows, columns, 3).
        used: Where it shows floor or robot, shape (rows, columns).
        body: Points of the robot's top, and perhaps some around it.
    """

    plane: Plane
    picture: NDArray[np.float32]
    used: NDArray[np.bool_]
    body: BodyRaster
