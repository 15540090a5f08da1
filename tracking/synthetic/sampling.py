# SPDX-License-Identifier: MIT
"""Where in a pixel, and when in an exposure, a picture is sampled.

A pixel is the mean over its square. It is taken at the points of a Fibonacci lattice, which has a
different x and a different y for each point: an upright or level edge is then placed to 1/68 of a
pixel where a 6 x 6 grid would place it to 1/12. Along an oblique edge errors of single pixels are
larger and change sign; over some twenty pixels 1/25 is left at worst, 1/600 as a rule.
"""

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

CORNERS = tuple(  # the lattice points nearest to a pixel's middle and corners
    int(np.argmin(np.hypot(*(OFFSETS_PX - place).T)))
    for place in ((0.0, 0.0), (-0.45, -0.45), (0.45, -0.45), (-0.45, 0.45), (0.45, 0.45))
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
    def shape(self) -> tuple[int, int]:
        """Its height and width [px]."""
        return self.rows.stop - self.rows.start, self.columns.stop - self.columns.start


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


@dataclass(frozen=True)
class RayField:
    """The rays of some pixels; linear in the offset within each, to better than 1e-5 px.

    Attributes:
        middle: Direction through each pixel's centre, inertial, shape (3, n).
        per_u: Its change for a pixel to the right, shape (3, n) [1/px].
        per_v: Its change for a pixel down, shape (3, n) [1/px].
    """

    middle: NDArray[np.float32]
    per_u: NDArray[np.float32]
    per_v: NDArray[np.float32]

    def at(self, sample: int) -> NDArray[np.float32]:
        """Return directions through one of the `SAMPLES` lattice points, shape (3, n)."""
        du, dv = OFFSETS_PX[sample].astype(np.float32)
        return self.middle + du * self.per_u + dv * self.per_v

    def only(self, pixels: NDArray) -> "RayField":
        """Return the rays of some of these pixels, by index or mask."""
        return RayField(self.middle[:, pixels], self.per_u[:, pixels], self.per_v[:, pixels])


def ray_field(camera: SyntheticCamera, patch: Patch) -> RayField:
    """Compute the rays of a patch, row by row."""
    v, u = np.mgrid[patch.rows, patch.columns].astype(float)
    centre = np.stack([u, v], axis=-1)
    middle = camera.rays(centre)
    per_u = camera.rays(centre + _HALF_U) - camera.rays(centre - _HALF_U)
    per_v = camera.rays(centre + _HALF_V) - camera.rays(centre - _HALF_V)
    return RayField(*(
        (camera.rotation.T @ part.reshape(-1, 3).T).astype(np.float32)
        for part in (middle, per_u, per_v)
    ))  # fmt: skip
