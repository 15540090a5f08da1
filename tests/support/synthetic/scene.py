# SPDX-License-Identifier: MIT
"""Static parts of the scene: camera, floor, light, and printed sheets."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from support.synthetic.lens import SyntheticCamera
from support.synthetic.patterns import (
    FLOOR_TEXTURE_SIDE,
    Grid,
    floor_texture,
    look_up,
    marker_cells,
)
from support.synthetic.sampling import SAMPLES, Patch, patch_around, ray_field
from support.synthetic.surfaces import rectangle_hit

Picture = NDArray[np.float32]

_EDGE_POINTS = 33  # along each edge of a sheet, to follow how a lens bends it
_SKY = 0.75  # brightness above the horizon [-]


@dataclass(frozen=True)
class Light:
    """A distant lamp and ambient light.

    Attributes:
        direction: Towards the lamp, of any length, shape (3,).
        ambient: Brightness of a white surface in the lamp's shadow [-].
        lamp: What the lamp adds to a white surface that faces it [-].
        radius: Angular radius of the lamp, which sets the softness of shadows [rad].
    """

    direction: tuple[float, float, float] = (0.35, 0.25, 1.0)
    ambient: float = 0.5
    lamp: float = 0.55
    radius: float = 0.03

    @property
    def towards(self) -> Array:
        """Unit vector towards the lamp, shape (3,)."""
        direction = np.array(self.direction)
        return direction / np.linalg.norm(direction)

    def on(self, normal: Array) -> float:
        """Return the brightness of a white surface with this unit normal [-]."""
        return self.ambient + self.lamp * max(0.0, float(normal @ self.towards))


@dataclass(frozen=True)
class Sheet:
    """A flat print.

    Attributes:
        grid: Albedo, top row first, shape (rows, columns) or (rows, columns, 3).
        size: Lengths along its x (to the right of the print) and y (up the print) [m].
        position: Of its centre, shape (3,) [m].
        rotation: From its frame, z out of the print, to the inertial one, shape (3, 3).
    """

    grid: Grid
    size: tuple[float, float]
    position: Array
    rotation: Array = field(default_factory=lambda: np.eye(3))

    def at(self, across: Array, up: Array) -> Array:
        """Compute inertial positions of points given from the sheet's centre, shape (..., 3) [m].

        Args:
            across: To the right of the print [m].
            up: Up the print [m].
        """
        flat = np.stack(np.broadcast_arrays(across, up, 0.0), axis=-1)
        return flat @ self.rotation.T + self.position

    @property
    def outline(self) -> Array:
        """Points along its edges, shape (n, 3) [m]."""
        along, one = np.linspace(-0.5, 0.5, _EDGE_POINTS), np.ones(_EDGE_POINTS)
        x = np.concatenate([along, along, -0.5 * one, 0.5 * one]) * self.size[0]
        y = np.concatenate([-0.5 * one, 0.5 * one, along, along]) * self.size[1]
        return self.at(x, y)


@dataclass(frozen=True)
class DrawnFloorMarker:
    """A square marker on the floor, its white border one cell wide.

    Attributes:
        marker_id: Its number in the dictionary.
        centre: Of the marker, x and y in the inertial frame [m].
        side: Of the black square [m].
        yaw: From the inertial x axis to the print's right, counter-clockwise [rad].
        thickness: Height of the print above the floor [m].
        dictionary: Name of a dictionary in `cv2.aruco`.
    """

    marker_id: int
    centre: tuple[float, float]
    side: float = 0.12
    yaw: float = 0.0
    thickness: float = 0.0
    dictionary: str = "DICT_4X4_50"

    @property
    def sheet(self) -> Sheet:
        """The print with its border."""
        grid = marker_cells(self.marker_id, dictionary=self.dictionary)
        whole = self.side * len(grid) / (len(grid) - 2)
        cos, sin = np.cos(self.yaw), np.sin(self.yaw)
        rotation = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        return Sheet(grid, (whole, whole), np.array([*self.centre, self.thickness]), rotation)

    @property
    def corners(self) -> Array:
        """Corners of the black square: top left, top right, bottom right, bottom left, (4, 3)."""
        half = self.side / 2
        return self.sheet.at(half * np.array([-1, 1, 1, -1]), half * np.array([1, 1, -1, -1]))


@dataclass(frozen=True)
class DrawnScene:
    """A camera, its light and a floor with markers on it.

    Attributes:
        camera: The camera.
        markers: On the floor.
        light: The light.
        floor_seed: Seed of the floor's speckles.
    """

    camera: SyntheticCamera
    markers: tuple[DrawnFloorMarker, ...] = ()
    light: Light = field(default_factory=Light)
    floor_seed: int = 0


def render_background(scene: DrawnScene) -> Picture:
    """Draw the scene without a robot.

    Returns:
        Brightness in blue, green and red, 1 for white paper in full light, shape
        (height, width, 3) [-].
    """
    picture = _floor(scene)
    sheets = [marker.sheet for marker in scene.markers]
    return paint_sheets(picture, sheets, camera=scene.camera, light=scene.light)


def paint_sheets(
    picture: Picture, sheets: Sequence[Sheet], *, camera: SyntheticCamera, light: Light
) -> Picture:
    """Draw prints over a picture, the last on top.

    Args:
        picture: Brightness, shape (height, width, 3) [-].
        sheets: Prints, seen from the front.
        camera: The camera.
        light: The light.

    Returns:
        A new picture.
    """
    painted = picture.copy()
    for sheet in sheets:
        patch = patch_around(camera, sheet.outline)
        if patch is None:
            continue
        brightness = light.on(sheet.rotation[:, 2])
        seen, share = _sheet_samples(sheet, camera=camera, patch=patch)
        under = painted[patch.area].reshape(-1, 3)
        blended = brightness * seen + (1 - share)[:, None] * under
        painted[patch.area] = blended.reshape(painted[patch.area].shape)
    return painted


def _sheet_samples(
    sheet: Sheet, *, camera: SyntheticCamera, patch: Patch
) -> tuple[Picture, Picture]:
    """Average the print's albedo, and how much of each pixel it covers, over the lattice."""
    to_sheet = sheet.rotation.T
    x, y, z = (float(v) for v in to_sheet @ (camera.position - sheet.position))
    count = patch.shape[0] * patch.shape[1]
    seen, share = np.zeros((count, 3), np.float32), np.zeros(count, np.float32)
    rays = ray_field(camera, patch)
    for sample in range(SAMPLES):
        along = to_sheet.astype(np.float32) @ rays.at(sample)
        far, px, py = rectangle_hit(
            (x, y, z), (along[0], along[1], along[2]), size=sheet.size, z=0.0
        )
        hit = np.flatnonzero(np.isfinite(far))
        across, down = px[hit] / sheet.size[0] + 0.5, 0.5 - py[hit] / sheet.size[1]
        seen[hit] += look_up(sheet.grid, across, down)
        share[hit] += 1
    each = np.float32(1 / SAMPLES)
    return seen * each, share * each


def _floor(scene: DrawnScene) -> Picture:
    camera = scene.camera
    texture = floor_texture(np.random.default_rng(scene.floor_seed))
    scale = len(texture) / FLOOR_TEXTURE_SIDE
    picture = np.empty((camera.height, camera.width, 3), np.float32)
    for top in range(0, camera.height, 256):  # in strips, to limit the memory of the rays
        v, u = np.mgrid[top : min(top + 256, camera.height), 0 : camera.width].astype(float)
        rays = camera.rays(np.stack([u, v], axis=-1)) @ camera.rotation
        below = rays[..., 2] < -1e-3
        distance = camera.position[2] / np.where(below, -rays[..., 2], np.inf)
        places = (camera.position[:2] + distance[..., None] * rays[..., :2]) * scale
        where = np.mod(places, len(texture)).astype(np.float32)
        strip = cv2.remap(texture, where[..., 0], where[..., 1], cv2.INTER_LINEAR,
                          borderMode=cv2.BORDER_WRAP)  # fmt: skip
        strip[~below] = _SKY
        picture[top : top + 256] = strip
    return picture * np.float32(scene.light.on(np.array([0.0, 0.0, 1.0])))
