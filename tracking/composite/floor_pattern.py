# SPDX-License-Identifier: MIT
"""What a floor's pattern leaves to be told, when the pixels beside have told what they can.

Planks and grain repeat themselves along the floor, and a robot that is as faint as 1/n in a mean of
n exposures is drawn to them. What a pixel's neighbours foretell of it says nothing about the robot;
taken off, what is left of the floor is white noise, in which least squares find the robot best.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

REACH_PX = 3
"""How far a pixel is foretold from [px]."""

_MOST_POINTS = 60_000
_HELD = 1e-3  # of the neighbours' power: their shares are held near zero by so much


@dataclass(frozen=True)
class FloorPattern:
    """How a floor's pattern is foretold.

    Attributes:
        width: What changes over more than this is no pattern [px].
        filters: For each colour, what is multiplied with a pixel and those around it to leave what
            the others do not foretell, with standard deviation 1; shape (3, side, side).
    """

    width: float
    filters: NDArray[np.float32]

    @classmethod
    def of(
        cls, picture: NDArray[np.float32], floor: NDArray[np.bool_], *, width: float
    ) -> "FloorPattern":
        """Judge a floor by the pixels above and to the left of each (Whittle 1954).

        Args:
            picture: Colours, shape (height, width, 3).
            floor: Pixels that show the floor alone, shape (height, width).
            width: What changes over more than this is no pattern [px].

        Returns:
            The filters.
        """
        flat = _flat(picture, width)
        side = 2 * REACH_PX + 1
        whole = cv2.erode(
            floor.astype(np.uint8), np.ones((side, side)), borderType=cv2.BORDER_CONSTANT,
            borderValue=(0,),
        )  # fmt: skip
        rows, columns = np.nonzero(whole)
        some = slice(None, None, 1 + len(rows) // _MOST_POINTS)
        chosen = (rows[some], columns[some])
        return cls(width, np.stack([_filter(flat[..., colour], *chosen) for colour in range(3)]))

    def flat(self, picture: NDArray[np.float32]) -> NDArray[np.float32]:
        """Take off what changes slowly."""
        return _flat(picture, self.width)

    def new_in(self, picture: NDArray) -> NDArray[np.float32]:
        """Compute what neighbours do not foretell, in one picture or n at once.

        Args:
            picture: Flat, shape (rows, columns, 3) or (rows, columns, 3, n).

        Returns:
            The same shape.
        """
        layers = picture.reshape(*picture.shape[:2], 3, -1)
        left = np.empty(layers.shape, np.float32)
        for colour, weights in enumerate(self.filters):
            layer = np.ascontiguousarray(layers[:, :, colour], np.float32)
            left[:, :, colour] = cv2.filter2D(layer, -1, weights).reshape(layer.shape)
        return left.reshape(picture.shape)


def _flat(picture: NDArray[np.float32], width: float) -> NDArray[np.float32]:
    return picture - cv2.GaussianBlur(picture, (0, 0), width)


def _filter(
    layer: NDArray[np.float32], rows: NDArray[np.intp], columns: NDArray[np.intp]
) -> NDArray[np.float32]:
    """Foretell pixels from those before them by least squares; what is left is 1 in size."""
    side = 2 * REACH_PX + 1
    around = np.indices((side, side)).reshape(2, -1).T - REACH_PX
    before = around[: len(around) // 2]
    told = np.stack([layer[rows + dy, columns + dx] for dy, dx in before], axis=1).astype(float)
    own = layer[rows, columns].astype(float)
    power = told.T @ told
    held = _HELD * np.trace(power) / len(before) * np.eye(len(before))
    shares = np.linalg.solve(power + held, told.T @ own)
    left = own - told @ shares
    size = 1.4826 * float(np.median(np.abs(left)))
    weights = np.concatenate((-shares, [1.0], np.zeros(len(before)))) / max(size, 1e-6)
    return weights.reshape(side, side).astype(np.float32)
