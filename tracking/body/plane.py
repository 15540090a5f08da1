# SPDX-License-Identifier: MIT
"""A photograph rectified onto the level plane of the robot's top."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.template import sample
from tracking.camera.lens import Camera, CameraPose, project


@dataclass(frozen=True)
class Plane:
    """A raster on a level plane and its pixels in a photograph; row 0 at the highest y.

    x, y are those of the floor frame.

    Attributes:
        low: Lowest x and y, shape (2,) [m].
        high: Highest x and y, shape (2,) [m].
        cell: Distance between neighbouring points [m].
        seen_px: Pixels of the points in the photograph, shape (rows, columns, 2) [px].
    """

    low: Array
    high: Array
    cell: float
    seen_px: Array

    @classmethod
    def over(
        cls, camera: Camera, view: CameraPose, *, height: float, low: Array, high: Array,
        cell: float,
    ) -> "Plane":  # fmt: skip
        """Build a raster over a level rectangle and project it into the photograph.

        Its first point has the lowest x and the highest y; the sides opposite are not reached.

        Args:
            camera: Camera intrinsics and distortion.
            view: Pose of the camera.
            height: Height of the plane over the floor [m].
            low: Lowest x and y, shape (2,) [m].
            high: Highest x and y, shape (2,) [m].
            cell: Distance between neighbouring points [m].
        """
        xx, yy = np.meshgrid(np.arange(low[0], high[0], cell), np.arange(high[1], low[1], -cell))
        world = np.stack((xx, yy, np.full_like(xx, height)), axis=-1)
        seen = project(camera, view, world.reshape(-1, 3)).reshape(*xx.shape, 2)
        return cls(low, high, cell, seen)

    def read(self, pixels: NDArray) -> NDArray[np.float32]:
        """Interpolate a photograph (height, width, ...) at the raster's points; 0 outside it.

        Returns:
            Values, shape (rows, columns, ...).
        """
        return sample(pixels, self.seen_px)

    def read_smooth(self, pixels: NDArray[np.uint8]) -> NDArray[np.float32]:
        """Interpolate a photograph as `read` does, after a blur against aliasing.

        Its standard deviation is 0.4 of the points' median distance along a row, 0.3 px or more.
        """
        spacing = float(np.median(np.linalg.norm(np.diff(self.seen_px, axis=1), axis=2)))
        # The blur loses nothing of the far floor, where pixels are larger than cells.
        return self.read(np.asarray(cv2.GaussianBlur(pixels, (0, 0), max(0.4 * spacing, 0.3))))

    def xy_at(self, row: float, column: float) -> Array:
        """Compute x and y on the floor of a point of the raster, shape (2,) [m].

        Args:
            row: Row of the point, may be fractional.
            column: Column of the point, may be fractional.
        """
        return np.array([self.low[0] + column * self.cell, self.high[1] - row * self.cell])

    def part(self, rows: slice, columns: slice) -> "Plane":
        """Return the raster cropped to some rows and columns.

        Args:
            rows: Rows to keep, with start and stop, without step.
            columns: Columns to keep, with start and stop, without step.
        """
        low = (self.low[0] + columns.start * self.cell, self.high[1] - rows.stop * self.cell)
        high = (self.low[0] + columns.stop * self.cell, self.high[1] - rows.start * self.cell)
        return Plane(np.array(low), np.array(high), self.cell, self.seen_px[rows, columns])
