# SPDX-License-Identifier: MIT
"""A composite picture resampled on the level plane at the height of the robot's top."""

from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.body.plane import Plane
from tracking.composite.body_raster import BodyRaster
from tracking.composite.known import KnownExposure

CELLS = 40
"""Default of the number of raster points along the robot."""


@dataclass(frozen=True)
class Reading:
    """A composite picture with one known exposure, on a raster at the height of the robot's top.

    Attributes:
        known: The picture with the known exposure.
        plane: Raster of the level plane at the height of the robot's top.
        picture: The picture's colours on `plane`, slightly blurred, shape (rows, columns, 3) [grey
            levels].
        used: True at points inside the picture and over 2 px from pixels to ignore, shape (rows,
            columns).
        body: Raster of the robot's body.
    """

    known: KnownExposure
    plane: Plane
    picture: NDArray[np.float32]
    used: NDArray[np.bool_]
    body: BodyRaster

    @classmethod
    def of(cls, known: KnownExposure, *, cells: int = CELLS) -> Self:
        """Build a reading: resample the picture on the plane of the robot's top.

        Args:
            known: The picture with the known exposure.
            cells: Number of raster points along the robot.
        """
        half, cell = 0.5 * float(np.hypot(*known.size)), known.size[0] / cells
        plane = Plane.over(
            known.camera, known.view, height=known.prior.height + known.plate.height,
            low=known.area[0] - half, high=known.area[1] + half, cell=cell,
        )  # fmt: skip
        widened = cv2.dilate(known.hidden.astype(np.uint8), np.ones((5, 5), np.uint8))
        edge = np.subtract(known.camera.size, 1)
        inside = ((plane.seen_px >= 0) & (plane.seen_px <= edge)).all(axis=-1)
        used = inside & (plane.read(255 * widened) < 1)
        body = BodyRaster.over(plane, known.size)
        return cls(known, plane, plane.read_smooth(known.pixels), used, body)

    @property
    def length(self) -> float:
        """The robot's length [m]."""
        return self.known.size[0]
