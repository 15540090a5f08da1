# SPDX-License-Identifier: MIT
"""Sample points within a pixel and within an exposure (lattice rule with random shifts).

A pixel is the mean over its square. It is sampled on a lattice whose points all differ in x and in
y. In one pixel an upright or level edge is then placed to 1/55 of a pixel, where an 8 x 8 grid
would place it to 1/8. An oblique edge may run along the lattice's own rows, and the same lattice in
all pixels would place it wrongly in each alike, by up to 1/15. Each pixel therefore has one of 14
lattices, shifted, both chosen by a hash of its coordinates. Its error is independent, with a
standard deviation of 0.017 px, and an edge of n pixels is placed to 0.017 / sqrt(n) px.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from support.synthetic.lens import SyntheticCamera

SAMPLES = 55
# Of the lattices whose rows are closest together.
_GENERATORS = np.array([7, 8, 12, 16, 21, 23, 24, 31, 32, 34, 39, 43, 47, 48])

_INDEX = np.arange(SAMPLES)
_ACROSS = ((_INDEX + 0.5) / SAMPLES).astype(np.float32)  # px
_DOWN = ((_INDEX[:, None] * _GENERATORS % SAMPLES + 0.5) / SAMPLES).astype(np.float32)  # px
MOMENTS = (_INDEX * 17 % SAMPLES + 0.5) / SAMPLES - 0.5  # in the exposure, from its middle [-]
_SPIRAL = np.sqrt((_INDEX * 38 % SAMPLES + 0.5) / SAMPLES)
_GOLDEN_ANGLE = np.pi * (3 - np.sqrt(5))
DISC = _SPIRAL[:, None] * np.column_stack(  # in the lamp's disc, of radius 1 [-]
    [np.cos(_INDEX * _GOLDEN_ANGLE), np.sin(_INDEX * _GOLDEN_ANGLE)]
)

CORNERS = ((0.0, 0.0), (-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5))
"""A pixel's middle and corners, from its centre [px]."""

_HALF = np.float32(0.5)
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
    """Compute the bounding patch of pixels around projected points.

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
        lattice: Which of the lattices each pixel has, shape (n,).
        shift: By which it is shifted, across and down, shape (2, n) [px].
    """

    middle: NDArray[np.float32]
    per_u: NDArray[np.float32]
    per_v: NDArray[np.float32]
    lattice: NDArray[np.intp]
    shift: NDArray[np.float32]

    def at(self, sample: int) -> NDArray[np.float32]:
        """Return directions through one of the `SAMPLES` lattice points, shape (3, n)."""
        across, down = _ACROSS[sample] + self.shift[0], _DOWN[sample, self.lattice] + self.shift[1]
        du, dv = across - np.floor(across) - _HALF, down - np.floor(down) - _HALF
        return self.middle + du * self.per_u + dv * self.per_v

    def beside(self, du: float, dv: float) -> NDArray[np.float32]:
        """Return directions through one offset from every pixel's centre [px], shape (3, n)."""
        away = np.float32(du) * self.per_u + np.float32(dv) * self.per_v
        return (self.middle + away).astype(np.float32)

    def only(self, pixels: NDArray) -> "RayField":
        """Return the rays of some of these pixels, by index or mask."""
        return RayField(
            self.middle[:, pixels], self.per_u[:, pixels], self.per_v[:, pixels],
            self.lattice[pixels], self.shift[:, pixels],
        )  # fmt: skip


def ray_field(camera: SyntheticCamera, patch: Patch) -> RayField:
    """Compute the rays of a patch, row by row."""
    v, u = np.mgrid[patch.rows, patch.columns]
    centre = np.stack([u, v], axis=-1).astype(float)
    middle = camera.rays(centre)
    per_u = camera.rays(centre + _HALF_U) - camera.rays(centre - _HALF_U)
    per_v = camera.rays(centre + _HALF_V) - camera.rays(centre - _HALF_V)
    middle, per_u, per_v = (
        (camera.rotation.T @ part.reshape(-1, 3).T).astype(np.float32)
        for part in (middle, per_u, per_v)
    )
    return RayField(middle, per_u, per_v, *_own_lattices(u.ravel(), v.ravel()))


def _own_lattices(u: NDArray, v: NDArray) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """Choose a lattice and its shift for each pixel, shapes (n,) and (2, n) [px]."""
    chosen, across, down = ((_hashed(u, v, salt) / 2**32).astype(np.float32) for salt in range(3))
    lattice = (chosen * len(_GENERATORS)).astype(np.intp) % len(_GENERATORS)
    return lattice, np.stack([across, down])


def _hashed(u: NDArray, v: NDArray, salt: int) -> NDArray[np.uint32]:
    """Hash coordinates, so that neighbours are uncorrelated (Wellons, lowbias32)."""
    h = np.full(u.shape, salt, np.uint32)
    for more in (u, v):
        h = h + more.astype(np.uint32)
        h = (h ^ (h >> np.uint32(16))) * np.uint32(0x7FEB352D)
        h = (h ^ (h >> np.uint32(15))) * np.uint32(0x846CA68B)
        h = h ^ (h >> np.uint32(16))
    return h
