# SPDX-License-Identifier: MIT
"""A composite picture resampled on the level plane at the height of the robot's top."""

from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.plane import Plane
from tracking.body.template import BodyTemplate, TopPlate, sample
from tracking.composite.known import KnownExposure


@dataclass(frozen=True)
class BodyRaster:
    """Points of a level rectangle in the body frame, front to rear and in each row left to right.

    Attributes:
        plane: Raster of the plane on which the robot is sampled.
        x: Distance of each point ahead of the body's middle, shape (rows, columns) [m].
        y: Distance of each point left of the body's middle, shape (rows, columns) [m].
        cell: Distance between neighbouring points [m].
    """

    plane: Plane
    x: Array
    y: Array
    cell: float

    @classmethod
    def over(cls, plane: Plane, size: tuple[float, float]) -> "BodyRaster":
        """Build a raster, as fine as that of a plane, that covers a body.

        Args:
            plane: Raster of the plane, whose cell is taken.
            size: Length and width of the body [m].
        """
        cell = plane.cell
        rows, columns = (round(side / cell) for side in size)
        ahead = ((rows - 1) / 2 - np.arange(rows)) * cell
        left = ((columns - 1) / 2 - np.arange(columns)) * cell
        x, y = np.meshgrid(ahead, left, indexing="ij")
        return cls(plane, x, y, cell)

    def thinned(self) -> "BodyRaster":
        """Return a raster of every second row and column, from the second on."""
        return BodyRaster(self.plane, self.x[1::2, 1::2], self.y[1::2, 1::2], 2 * self.cell)

    def template(self, values: NDArray[np.float32], height: float) -> BodyTemplate:
        """Build the template of a flat top, the size of the body, from its colours.

        Args:
            values: Colours on the raster, shape (rows, columns, 3).
            height: Height of the top over the body's origin [m].
        """
        rows, columns = self.x.shape
        points = np.stack((self.x, self.y, np.full_like(self.x, height)), axis=-1)
        plate = TopPlate(
            rows * self.cell, columns * self.cell, height, margin=0.0, front_margin=0.0
        )
        return BodyTemplate(plate, self.cell, points, values)

    def on(self, poses: Array) -> NDArray[np.float32]:
        """Compute the coordinates of the points on the plane's raster.

        Args:
            poses: x, y [m] and yaw [rad] of the robot, shape (n, 3).

        Returns:
            Column and row on the plane's raster, shape (n, rows, columns, 2) [cells].
        """
        c, s = (f(poses[:, 2])[:, None, None] for f in (np.cos, np.sin))
        ahead, left = self.x[:, :1], self.y[:1]
        x = poses[:, 0][:, None, None] + c * ahead - s * left
        y = poses[:, 1][:, None, None] + s * ahead + c * left
        plane, place = self.plane, np.empty((*x.shape, 2), np.float32)  # as `sample` takes it
        place[..., 0] = (x - plane.low[0]) / plane.cell
        place[..., 1] = (plane.high[1] - y) / plane.cell
        return place

    def read(self, layer: NDArray, pose: Array) -> NDArray[np.float32]:
        """Interpolate a layer of the plane at the points of the robot.

        Args:
            layer: Values on the plane's raster, shape (plane rows, plane columns, ...).
            pose: x, y [m] and yaw [rad] of the robot, shape (3,).

        Returns:
            Values, shape (rows, columns, ...) of the robot's raster; 0 outside the plane.
        """
        return sample(layer, self.on(pose[None])[0])


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
