# SPDX-License-Identifier: MIT
"""Where in a pixel, and when in an exposure, a picture is sampled.

A pixel is the mean over its square. It is taken at the points of a Fibonacci lattice, which has a
different x and a different y for each point: an edge, of whatever slope, is then placed to 1/68 of
a pixel or better where a 6 x 6 grid would place an upright one to 1/12.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracking.synthetic.lens import Array, SyntheticCamera

SAMPLES = 34  # a Fibonacci number, with the one before it for a generator
_GENERATOR = 21

_INDEX = np.arange(SAMPLES)
OFFSETS_PX = np.column_stack(  # in the pixel, from its centre [px]
    [(_INDEX + 0.5) / SAMPLES - 0.5, (_INDEX * _GENERATOR % SAMPLES + 0.5) / SAMPLES - 0.5]
)
MOMENTS = (_INDEX * 9 % SAMPLES + 0.5) / SAMPLES - 0.5  # in the exposure, from its middle [-]
_SPIRAL = np.sqrt((_INDEX * 13 % SAMPLES + 0.5) / SAMPLES)
_GOLDEN_ANGLE = np.pi * (3 - np.sqrt(5))
DISC = _SPIRAL[:, None] * np.column_stack(  # in the lamp's disc, of radius 1 [-]
    [np.cos(_INDEX * _GOLDEN_ANGLE), np.sin(_INDEX * _GOLDEN_ANGLE)]
)

_HALF_U, _HALF_V = np.array([0.5, 0.0]), np.array([0.0, 0.5])  # px


@dataclass(frozen=True)
class Patch:
    """A rectangle of a picture's pixels.

    Attributes:
        rows: Its rows in the picture.
        columns: Its columns in the picture.
    """

    rows: slice
    columns: slice

    @property
    def area(self) -> tuple[slice, slice]:
        """Index of the patch in an image."""
        return self.rows, self.columns

    @property
    def area_px(self) -> int:
        """Number of its pixels."""
        height, width = (part.stop - part.start for part in self.area)
        return height * width


def patch_around(camera: SyntheticCamera, points: Array, *, margin: float = 3.0) -> Patch | None:
    """Find the pixels that may show what lies within some points.

    Args:
        camera: The camera.
        points: Around what is to be shown, dense enough to follow bent edges, shape (n, 3) [m].
        margin: Around the points' pixels [px].

    Returns:
        The patch; None when it is outside the picture.
    """
    pixels = camera.project(points).reshape(-1, 2)
    if np.isnan(pixels).any():
        return _cut(camera, np.array([0, 0]), np.array([camera.width, camera.height]))
    low, high = np.floor(pixels.min(axis=0) - margin), np.ceil(pixels.max(axis=0) + margin)
    return _cut(camera, low, high)


def _cut(camera: SyntheticCamera, low: Array, high: Array) -> Patch | None:
    left, top = (int(v) for v in np.maximum(low, 0))
    right = int(min(high[0] + 1, camera.width))
    bottom = int(min(high[1] + 1, camera.height))
    if left >= right or top >= bottom:
        return None
    return Patch(slice(top, bottom), slice(left, right))


def sample_rays(camera: SyntheticCamera, patch: Patch) -> Iterator[NDArray[np.float32]]:
    """Yield the rays through one lattice point of each pixel, for all `SAMPLES` points in turn.

    Within a pixel the ray is linear in the offset; the error is below 1e-5 px.

    Args:
        camera: The camera.
        patch: Pixels.

    Yields:
        Directions in the inertial frame, shape (3, rows * columns).
    """
    v, u = np.mgrid[patch.rows, patch.columns].astype(float)
    centre = np.stack([u, v], axis=-1)
    middle = camera.rays(centre)
    per_u = camera.rays(centre + _HALF_U) - camera.rays(centre - _HALF_U)
    per_v = camera.rays(centre + _HALF_V) - camera.rays(centre - _HALF_V)
    middle, per_u, per_v = (
        (camera.rotation.T @ part.reshape(-1, 3).T).astype(np.float32)
        for part in (middle, per_u, per_v)
    )
    for du, dv in OFFSETS_PX.astype(np.float32):
        yield middle + du * per_u + dv * per_v
