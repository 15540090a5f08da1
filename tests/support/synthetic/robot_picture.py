# SPDX-License-Identifier: MIT
"""Draw the robot: a box with a red head, a top plate, six bent legs, and its shadow."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from support.synthetic.lens import SyntheticCamera
from support.synthetic.patterns import Grid, look_up, marker_cells, plate_cells
from support.synthetic.robot import PLATE_TOP, DrawnPose, RobotLook, RobotState
from support.synthetic.sampling import (
    CORNERS,
    DISC,
    MOMENTS,
    SAMPLES,
    Patch,
    RayField,
    patch_around,
    ray_field,
)
from support.synthetic.scene import Light, Picture
from support.synthetic.surfaces import (
    Components,
    box_hit,
    half_circle_hit,
    meets_box,
    rectangle_hit,
)

BODY_HALF_HEIGHT = 0.0345  # m
LEG_RADIUS = 0.035  # m
LEG_WIDTH = 0.018  # m
HIPS = tuple((x, side * 0.1156, 0.0) for x in (0.097, 0.0, -0.097) for side in (1, -1))  # m
REACH = 0.17  # from the body's centre to anything of the robot, level [m]

# axis-aligned boxes in the body frame: low corner, high corner [m], albedo in blue, green, red;
# body, head, top plate
_BOXES = (
    ((-0.120, -0.100, -BODY_HALF_HEIGHT), (0.120, 0.100, BODY_HALF_HEIGHT), (0.50, 0.24, 0.08)),
    ((0.120, -0.045, -0.025), (0.130, 0.045, 0.020), (0.10, 0.10, 0.75)),
    ((-0.088, -0.088, BODY_HALF_HEIGHT), (0.088, 0.088, PLATE_TOP), (0.45, 0.45, 0.45)),
)
_PLATE_SIDE = 0.176  # m
_LEG_BRIGHTNESS = 0.07  # black rubber, from every side [-]
_PARTS = 5  # of a value: blue, green, red, cover, floor light
_FLAT = 1e-4  # values closer than this show one surface [-]
_BELOW = 0.2  # brightness of white paper seen from below, on a mast [-]


def paint_robot(
    picture: Picture,
    state: RobotState,
    *,
    look: RobotLook,
    camera: SyntheticCamera,
    light: Light,
    exposure_time: float = 0.0,
) -> tuple[Picture, Picture]:
    """Draw a robot and its shadow over a picture.

    Args:
        picture: Brightness without the robot, shape (height, width, 3) [-].
        state: Where the robot is; it moves during the exposure.
        look: How it looks.
        camera: The camera.
        light: The light.
        exposure_time: [s].

    Returns:
        A new picture, and the share of each pixel the robot covers, shape (height, width) [-].
    """
    painted, cover = picture.copy(), np.zeros(picture.shape[:2], np.float32)
    patch = _robot_patch(state, look, camera=camera, light=light, exposure_time=exposure_time)
    if patch is None:
        return painted, cover
    sampler = _Sampler(state, look, camera.position, light, exposure_time)
    values = sampler.averages(ray_field(camera, patch), patch.shape)
    painted[patch.area] = values[..., :3] + values[..., 4:] * picture[patch.area]
    cover[patch.area] = values[..., 3]
    return painted, cover


@dataclass(frozen=True)
class _Sampler:
    """Sampler of a robot's appearance, ray by ray.

    A value has five parts: the robot's blue, green and red, whether it is there, and the share of
    the floor's light; the last is 0 where the robot is, the first four where it is not.
    """

    state: RobotState
    look: RobotLook
    origin: Array
    light: Light
    exposure_time: float

    def averages(self, rays: RayField, shape: tuple[int, int]) -> Picture:
        """Average the values over each pixel, shape (*shape, 5) (adaptive sampling).

        A robot at rest is sampled at a few points of each pixel. All points are used only where
        these, or those of the pixels around, disagree. Every surface has a uniform colour: an edge
        separates the corners of the pixels it crosses, and a tip crosses a side.
        """
        if self._moves:
            return self._mean(rays, range(SAMPLES)).reshape(*shape, _PARTS)
        few = np.stack([
            self._values(rays.beside(*place), sample) for sample, place in enumerate(CORNERS)
        ])  # fmt: skip
        low, high = (part.reshape(*shape, _PARTS) for part in (few.min(axis=0), few.max(axis=0)))
        around = np.ones((3, 3), np.uint8)
        edge = np.any(cv2.dilate(high, around) - cv2.erode(low, around) > _FLAT, axis=-1).ravel()
        values = few[0]
        values[edge] = self._mean(rays.only(edge), range(SAMPLES))
        return values.reshape(*shape, _PARTS)

    @property
    def _moves(self) -> bool:
        return self.exposure_time > 0 and any((*self.state.velocity_xy, self.state.yaw_rate))

    def _mean(self, rays: RayField, samples: Sequence[int]) -> Picture:
        total = np.zeros((rays.middle.shape[1], _PARTS), np.float32)
        for sample in samples:
            total += self._values(rays.at(sample), sample)
        return total / np.float32(len(samples))

    def _values(self, directions: NDArray[np.float32], sample: int) -> Picture:
        pose = self.state.pose_at(float(MOMENTS[sample]) * self.exposure_time)
        plate = _plate(self.look.plate_seed, self.look.parts)
        seen = _Seen(pose, self.state.leg_angles, self.look, self.light, plate)
        found, colour = seen.along(self.origin, directions)
        lit = np.zeros(len(found), np.float32)
        lit[~found] = seen.floor_light(self.origin, directions[:, ~found], DISC[sample])
        return np.column_stack([colour, found, lit]).astype(np.float32)


@lru_cache(maxsize=16)
def _plate(seed: int, parts: int) -> Grid:
    grid = plate_cells(np.random.default_rng(seed), parts=parts)
    grid.setflags(write=False)
    return grid


@dataclass(frozen=True)
class _Print:
    """A square print, level in the body frame, its top towards the head."""

    grid: Grid
    side: float
    height: float
    brightness: float


def _paint_print(
    sheet: _Print, start: Components, along: Components, *, nearest: NDArray, colour: Picture
) -> None:
    """Colour the rays that meet a print first; update `nearest` and `colour` in place."""
    far, x, y = rectangle_hit(start, along, size=(sheet.side, sheet.side), z=sheet.height)
    front = np.flatnonzero(far < nearest * np.float32(1 + 1e-5))  # on a box, the print wins
    nearest[front] = far[front]
    cells = look_up(sheet.grid, 0.5 - y[front] / sheet.side, 0.5 - x[front] / sheet.side)
    colour[front] = (sheet.brightness if start[2] > sheet.height else _BELOW) * cells


@dataclass(frozen=True)
class _Seen:
    """A robot at one moment, for intersection with rays."""

    pose: DrawnPose
    leg_angles: tuple[float, ...]
    look: RobotLook
    light: Light
    plate: Grid

    def along(self, origin: Array, rays: NDArray) -> tuple[NDArray, Picture]:
        """Find which rays meet the robot, shape (n,), and how bright it is there, (n, 3) [-]."""
        turn = self.pose.rotation.T
        start = _components(turn @ (origin - self.pose.position))
        directions = turn.astype(np.float32) @ rays
        near = np.flatnonzero(self._near(start, _rows(directions)))
        nearest, colour = self._nearest(start, directions[:, near])
        found, all_colours = np.zeros(rays.shape[1], bool), np.zeros((rays.shape[1], 3), np.float32)
        found[near], all_colours[near] = np.isfinite(nearest), colour
        return found, all_colours

    def floor_light(self, origin: Array, rays: NDArray, disc: Array) -> Picture:
        """Compute the share of the floor's brightness where each ray meets it, shape (n,)."""
        down = np.minimum(rays[2], np.float32(-1e-6))  # rays to the sky end far away
        places = origin[:, None].astype(np.float32) - rays * np.float32(origin[2]) / down
        turn = self.pose.rotation.T.astype(np.float32)
        start = turn @ (places - self.pose.position[:, None].astype(np.float32))
        along = _components(turn @ _towards(self.light, disc))
        near = np.flatnonzero(self._near(_rows(start), along))
        start = _rows(start[:, near])
        hits = [box_hit(start, along, low=low, high=high).distance for low, high, _ in _BOXES]
        shadow = np.isfinite(np.min([*hits, *self._legs(start, along)], axis=0))
        left = np.ones(rays.shape[1], np.float32)
        left[near[shadow]] = self.light.ambient / self.light.on(np.array([0.0, 0.0, 1.0]))
        return left

    def _near(self, start: Components, along: Components) -> NDArray:
        """Return which rays meet a bounding box of the robot; the others need no further test."""
        marker = self.look.marker
        top = PLATE_TOP if marker is None else max(PLATE_TOP, marker.height)
        low, high = (-REACH, -REACH, -2.1 * LEG_RADIUS), (REACH, REACH, top + 2.1 * LEG_RADIUS)
        return meets_box(start, along, low=low, high=high)

    def _nearest(self, start: Components, directions: NDArray) -> tuple[NDArray, Picture]:
        along, faces = _rows(directions), self._faces()
        nearest = np.full(directions.shape[1], np.inf, np.float32)
        colour = np.zeros((directions.shape[1], 3), np.float32)
        for low, high, albedo in _BOXES:
            far, axis = box_hit(start, along, low=low, high=high)
            front = np.flatnonzero(far < nearest)
            nearest[front] = far[front]
            facing = (directions[axis[front], front] < 0).astype(int)
            colour[front] = faces[axis[front], facing][:, None] * np.array(albedo, np.float32)
        for far in self._legs(start, along):
            front = far < nearest
            nearest[front], colour[front] = far[front], _LEG_BRIGHTNESS
        for print_ in self._prints():
            _paint_print(print_, start, along, nearest=nearest, colour=colour)
        return nearest, colour

    def _prints(self) -> list[_Print]:
        """List the prints on level sheets: the plate's parts and the marker."""
        lit = float(self._faces()[2, 1])
        prints = [_Print(self.plate, _PLATE_SIDE, PLATE_TOP, lit)]
        if (marker := self.look.marker) is not None:
            grid = marker_cells(marker.marker_id, dictionary=marker.dictionary)
            whole = marker.side * len(grid) / (len(grid) - 2)
            prints.append(_Print(grid, whole, marker.height, lit))
        return prints

    def _legs(self, start: Components, along: Components) -> list[NDArray]:
        return [
            half_circle_hit(start, along, hip=hip, radius=LEG_RADIUS, width=LEG_WIDTH, angle=angle)
            for hip, angle in zip(HIPS, self.leg_angles, strict=True)
        ]

    def _faces(self) -> Picture:
        """Compute how bright white faces are, by axis, away from it and along it, shape (3, 2)."""
        normals = self.pose.rotation.T
        return np.array([[self.light.on(-n), self.light.on(n)] for n in normals], np.float32)


def _components(vector: Array) -> Components:
    x, y, z = np.asarray(vector, dtype=np.float32)
    return x, y, z


def _rows(vectors: NDArray) -> Components:
    return vectors[0], vectors[1], vectors[2]


def _towards(light: Light, disc: Array) -> Array:
    """Compute the direction to one point of the lamp, given in its unit disc."""
    axis = light.towards
    side = np.cross(axis, [0.0, 1.0, 0.0] if abs(axis[1]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    return axis + light.radius * (disc[0] * side + disc[1] * np.cross(axis, side))


def _robot_patch(
    state: RobotState, look: RobotLook, *, camera: SyntheticCamera, light: Light,
    exposure_time: float,
) -> Patch | None:  # fmt: skip
    """Find the pixels that may show the robot, its marker or its shadow."""
    reach = REACH + exposure_time * float(np.hypot(*state.velocity_xy))
    top = PLATE_TOP if look.marker is None else max(PLATE_TOP, look.marker.height)
    corner = np.array([-reach, reach])
    x, y, z = np.meshgrid(corner, corner, [-0.1, top + 0.02], indexing="ij")
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3) @ state.pose.rotation.T
    points = points + state.pose.position
    points[:, 2] = np.maximum(points[:, 2], 0.0)
    slope = light.towards[:2] / max(light.towards[2], 0.2)
    shadow = points.copy()
    shadow[:, :2] -= points[:, 2:] * (slope + np.sign(slope) * 2 * light.radius)
    shadow[:, 2] = 0.0
    return patch_around(camera, np.concatenate([points, shadow]))
