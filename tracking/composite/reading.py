# SPDX-License-Identifier: MIT
"""What every reading of a composite picture begins with."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracking.composite.body_raster import BodyRaster
from tracking.composite.plane import Plane


@dataclass(frozen=True)
class Reading:
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
