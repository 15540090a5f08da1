# SPDX-License-Identifier: MIT
"""Raster on the robot's top, to interpolate a picture at a pose and to draw the robot there."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.plane import Plane
from tracking.body.template import BodyTemplate, TopPlate, sample

Window = tuple[slice, slice]


@dataclass(frozen=True)
class BodyRaster:
    """Points of a level rectangle in the body frame, front to rear and in each row left to right.

    Attributes:
        plane: Raster of the plane on which the robot is drawn and sampled.
        x: Distance of each point ahead of the body's middle, shape (rows, columns) [m].
        y: Distance of each point left of the body's middle, shape (rows, columns) [m].
        cell: Distance between neighbouring points [m].
        margin: Number of rows and columns on each side that lie around the body, not on it.
    """

    plane: Plane
    x: Array
    y: Array
    cell: float
    margin: int = 0

    @classmethod
    def over(cls, plane: Plane, size: tuple[float, float], margin: int = 0) -> "BodyRaster":
        """Build a raster, as fine as that of a plane, that covers a body and a margin around it.

        Args:
            plane: Raster of the plane, whose cell is taken.
            size: Length and width of the body [m].
            margin: Number of rows and columns to add on each side.
        """
        cell = plane.cell
        rows, columns = (round(side / cell) + 2 * margin for side in size)
        ahead = ((rows - 1) / 2 - np.arange(rows)) * cell
        left = ((columns - 1) / 2 - np.arange(columns)) * cell
        x, y = np.meshgrid(ahead, left, indexing="ij")
        return cls(plane, x, y, cell, margin)

    @property
    def body(self) -> Window:
        """Slices of the rows and columns on the body, without the margin."""
        rows, columns = self.x.shape
        return slice(self.margin, rows - self.margin), slice(self.margin, columns - self.margin)

    def thinned(self) -> "BodyRaster":
        """Return a raster of every second row and column, from the second on; its `margin` is 0."""
        return BodyRaster(self.plane, self.x[1::2, 1::2], self.y[1::2, 1::2], 2 * self.cell)

    def template(self, values: NDArray[np.float32], height: float) -> BodyTemplate:
        """Build the template of a flat top, the size of the body, from its colours.

        Args:
            values: Colours on the whole raster, shape (rows, columns, 3); those around the body are
                not used.
            height: Height of the top over the body's origin [m].
        """
        rows, columns = self.body
        x, y = self.x[rows, columns], self.y[rows, columns]
        points = np.stack((x, y, np.full_like(x, height)), axis=-1)
        plate = TopPlate(
            x.shape[0] * self.cell, x.shape[1] * self.cell, height, margin=0.0, front_margin=0.0
        )
        return BodyTemplate(plate, self.cell, points, values[rows, columns])

    def on(self, poses: Array) -> Array:
        """Compute the coordinates of the points on the plane's raster.

        Args:
            poses: x, y [m] and yaw [rad] of the robot, shape (n, 3).

        Returns:
            Column and row on the plane's raster, shape (n, rows, columns, 2) [cells].
        """
        c, s = (f(poses[:, 2])[:, None, None] for f in (np.cos, np.sin))
        x = poses[:, 0][:, None, None] + c * self.x - s * self.y
        y = poses[:, 1][:, None, None] + s * self.x + c * self.y
        plane = self.plane
        return np.stack(((x - plane.low[0]) / plane.cell, (plane.high[1] - y) / plane.cell), -1)

    def read(self, layer: NDArray, pose: Array) -> NDArray[np.float32]:
        """Interpolate a layer of the plane at the points of the robot.

        Args:
            layer: Values on the plane's raster, shape (plane rows, plane columns, ...).
            pose: x, y [m] and yaw [rad] of the robot, shape (3,).

        Returns:
            Values, shape (rows, columns, ...) of the robot's raster; 0 outside the plane.
        """
        return sample(layer, self.on(pose[None])[0])

    def window(self, pose: Array) -> Window:
        """Compute the bounding box of the robot's raster in rows and columns of `plane`.

        Args:
            pose: x, y [m] and yaw [rad] of the robot, shape (3,).

        Returns:
            Rows and columns, clipped to the plane.
        """
        columns_rows = self.on(pose[None])[0][[0, 0, -1, -1], [0, -1, 0, -1]]
        size = np.array(self.plane.seen_px.shape[1::-1])
        low = np.clip(np.floor(columns_rows.min(axis=0)).astype(int), 0, size)
        high = np.clip(np.ceil(columns_rows.max(axis=0)).astype(int) + 1, low, size)
        return slice(low[1], high[1]), slice(low[0], high[0])

    def laid(self, values: NDArray[np.float32], pose: Array) -> tuple[Window, NDArray[np.float32]]:
        """Interpolate values of the robot's raster at the plane's points around a pose.

        Args:
            values: Values on the robot's raster, shape (rows, columns, ...).
            pose: x, y [m] and yaw [rad] of the robot, shape (3,).

        Returns:
            Rows and columns of the plane (`window`), and the values there, 0 outside the robot's
            raster.
        """
        window = self.window(pose)
        rows, columns = (np.arange(part.start, part.stop) for part in window)
        dx = (self.plane.low[0] + columns * self.plane.cell - pose[0])[None, :]
        dy = (self.plane.high[1] - rows * self.plane.cell - pose[1])[:, None]
        c, s = np.cos(pose[2]), np.sin(pose[2])
        ahead, left = c * dx + s * dy, c * dy - s * dx
        place = np.stack((self.y[0, 0] - left, self.x[0, 0] - ahead), axis=-1) / self.cell
        if place.size == 0:
            return window, np.zeros((*place.shape[:2], *values.shape[2:]), np.float32)
        return window, sample(values, place)

    def between(self, pose: Array, other: Array) -> Array:
        """Compute the affine map from raster coordinates at one pose to those at another.

        Args:
            pose: First pose: x, y [m] and yaw [rad], shape (3,).
            other: Second pose, shape (3,).

        Returns:
            Matrix from (column, row, 1) at the first pose to (column, row) at the second of the
            same point of the plane, shape (2, 3).
        """
        return (np.linalg.inv(self._to_world(other)) @ self._to_world(pose))[:2]

    def _to_world(self, pose: Array) -> Array:
        raster = np.array([[0, -self.cell, self.x[0, 0]], [-self.cell, 0, self.y[0, 0]], [0, 0, 1]])
        c, s = np.cos(pose[2]), np.sin(pose[2])
        return np.array([[c, -s, pose[0]], [s, c, pose[1]], [0, 0, 1]]) @ raster
