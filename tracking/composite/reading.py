# SPDX-License-Identifier: MIT
"""Ways to merge exposures into one picture, and the interface of their readings."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar, Self

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.plane import Plane
from tracking.composite.body_raster import BodyRaster
from tracking.composite.exposure import Exposure
from tracking.composite.known import KnownExposure


class Merged(StrEnum):
    """Method by which exposures were merged into one picture."""

    PASTED = "pasted"
    """The robot was cut out of each photograph and pasted on the others: each exposure is visible
    or, in part or whole, hidden by another."""
    DARKEST = "darkest"
    """Each pixel has the darkest value of all photographs."""
    MEAN = "mean"
    """Each pixel has the mean of all photographs: of n exposures each is as faint as 1/n."""


@dataclass(frozen=True)
class Reading(ABC):
    """Find and align the exposures of a composite picture, given the pose of one exposure.

    Attributes:
        known: The picture with the known exposure.
        plane: Raster of the level plane at the height of the robot's top.
        picture: The picture's colours on `plane`, slightly blurred, shape (rows, columns, 3) [grey
            levels].
        used: True at points inside the picture and over 2 px from pixels to ignore, shape (rows,
            columns).
        body: Raster of the robot's body, with the margin of the class around it.
    """

    cells: ClassVar[int] = 32  # points of the raster along the robot
    margin: ClassVar[float] = 0.0  # width around the robot that belongs to it, of its length

    known: KnownExposure
    plane: Plane
    picture: NDArray[np.float32]
    used: NDArray[np.bool_]
    body: BodyRaster

    @classmethod
    def of(cls, known: KnownExposure, *, cells: int | None = None) -> Self:
        """Build a reading: resample the picture on the plane of the robot's top.

        Args:
            known: The picture with the known exposure.
            cells: Number of raster points along the robot; None for the class's `cells`.
        """
        cells = cells or cls.cells
        half, cell = 0.5 * float(np.hypot(*known.size)), known.size[0] / cells
        plane = Plane.over(
            known.camera, known.view, height=known.prior.height + known.plate.height,
            low=known.area[0] - half, high=known.area[1] + half, cell=cell,
        )  # fmt: skip
        widened = cv2.dilate(known.hidden.astype(np.uint8), np.ones((5, 5), np.uint8))
        edge = np.subtract(known.camera.size, 1)
        inside = ((plane.seen_px >= 0) & (plane.seen_px <= edge)).all(axis=-1)
        used = inside & (plane.read(255 * widened) < 1)
        body = BodyRaster.over(plane, known.size, round(cls.margin * cells))
        return cls(known, plane, plane.read_smooth(known.pixels), used, body)

    @property
    def length(self) -> float:
        """The robot's length [m]."""
        return self.known.size[0]

    @abstractmethod
    def find(self) -> Array:
        """Find all exposures on the raster.

        Returns:
            x, y [m] and yaw [rad] of each exposure, the known one first, shape (n, 3).
        """

    @abstractmethod
    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align exposures with the photograph.

        Args:
            poses: Poses that `find` returned, shape (n, 3), n at least 2.

        Returns:
            The aligned exposures in the order of `poses`, without those that are rejected.
        """
