# SPDX-License-Identifier: MIT
"""Intersections of rays with boxes, rectangles and bent strips.

A ray is an origin and a direction, each three components x, y, z. A component is a number or an
array, and broadcasts against the others. Distances are in units of the direction's length, infinite
where the ray misses.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array

Component = float | np.floating | NDArray[np.float32] | Array
Components = tuple[Component, Component, Component]


class Hit(NamedTuple):
    """Intersection of rays with a surface.

    Attributes:
        distance: Along the ray, infinite where it misses.
        axis: Axis of the face's normal where the surface is a box: 0, 1 or 2.
    """

    distance: NDArray
    axis: NDArray


def box_hit(
    origin: Components,
    direction: Components,
    *,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
) -> Hit:
    """Compute where rays enter an axis-aligned box; rays that start inside miss.

    Args:
        origin: Of the rays, in the box's frame [m].
        direction: Of the rays.
        low: Corner of least x, y, z [m].
        high: Corner of greatest x, y, z [m].
    """
    entries, enter, leave = _slabs(origin, direction, low, high)
    axis = np.where(enter == entries[0], 0, np.where(enter == entries[1], 1, 2))
    return Hit(np.where((enter < leave) & (enter > 0), enter, np.inf), axis)


def meets_box(
    origin: Components,
    direction: Components,
    *,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
) -> NDArray:
    """Return which rays pass through an axis-aligned box, or start in it.

    Args:
        origin: Of the rays, in the box's frame [m].
        direction: Of the rays.
        low: Corner of least x, y, z [m].
        high: Corner of greatest x, y, z [m].
    """
    _, enter, leave = _slabs(origin, direction, low, high)
    return (enter < leave) & (leave > 0)


def _slabs(
    origin: Components,
    direction: Components,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
) -> tuple[list[NDArray], NDArray, NDArray]:
    """Compute where rays enter each axis's slab, the last entry and the first exit."""
    entries, exits = [], []
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for start, step, near, far in zip(origin, direction, low, high, strict=True):
            first, second = (near - start) / step, (far - start) / step
            entries.append(np.minimum(first, second))
            exits.append(np.maximum(first, second))
    enter = np.maximum(np.maximum(entries[0], entries[1]), entries[2])
    return entries, enter, np.minimum(np.minimum(exits[0], exits[1]), exits[2])


def rectangle_hit(
    origin: Components, direction: Components, *, size: tuple[float, float], z: float
) -> tuple[NDArray, NDArray, NDArray]:
    """Intersect rays with a rectangle parallel to the xy plane, centred on the z axis.

    Args:
        origin: Of the rays, in the rectangle's frame [m].
        direction: Of the rays.
        size: Lengths along x and y [m].
        z: Of its plane [m].

    Returns:
        Distance, and x and y of the meeting point [m]. Only those with a finite distance mean
        something.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        distance = (z - origin[2]) / direction[2]
        x, y = origin[0] + distance * direction[0], origin[1] + distance * direction[1]
        inside = (np.abs(x) <= size[0] / 2) & (np.abs(y) <= size[1] / 2) & (distance > 0)
    return np.where(inside, distance, np.inf), np.asarray(x), np.asarray(y)


def half_circle_hit(
    origin: Components,
    direction: Components,
    *,
    hip: tuple[float, float, float],
    radius: float,
    width: float,
    angle: float,
) -> NDArray:
    """Intersect rays with a leg: a thin strip, bent to half a circle about an axis along y.

    Args:
        origin: Of the rays, in the body frame [m].
        direction: Of the rays.
        hip: One end of the half circle, mid strip [m].
        radius: Of the half circle [m].
        width: Of the strip along y [m].
        angle: Leg angle, as in `docs/conventions.md` [rad].

    Returns:
        Distances.
    """
    cos, sin = float(np.cos(angle)), float(np.sin(angle))  # plain floats keep rays' precision
    from_x, from_z = origin[0] - hip[0] - radius * cos, origin[2] - hip[2] + radius * sin
    along_x, along_z = direction[0], direction[2]
    a = along_x * along_x + along_z * along_z
    b = from_x * along_x + from_z * along_z
    root = np.asarray(b * b - a * (from_x * from_x + from_z * from_z - radius * radius))
    nearest = np.full(root.shape, np.inf)
    near = np.flatnonzero(root >= 0)  # few do, and only these are tested further
    parts = (a, b, from_x, from_z, along_x, along_z, direction[1], origin[1] - hip[1])
    a, b, from_x, from_z, along_x, along_z, along_y, from_y = (
        part[near] if isinstance(part, np.ndarray) and part.ndim else part for part in parts
    )
    root = np.sqrt(root.ravel()[near])
    found = np.full(len(near), np.inf)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for sign in (1.0, -1.0):  # the near crossing last, so that it wins
            distance = (-b + sign * root) / a
            x, z = from_x + distance * along_x, from_z + distance * along_z
            y = from_y + distance * along_y
            # the half on which the strip is: behind the line from hip to toe
            inside = (-sin * x - cos * z >= 0) & (np.abs(y) <= width / 2) & (distance > 0)
            found = np.where(inside, distance, found)
    nearest.flat[near] = found
    return nearest
