# SPDX-License-Identifier: MIT
"""Prewhitening of a floor's pattern: the error of predicting a pixel from its neighbours.

Planks and grain are correlated along the floor, and alignment of a robot that is as faint as 1/n
in a mean of n exposures is biased by them. What neighbouring pixels predict of a pixel says nothing
about the robot. The prediction error of the floor is white noise, for which least squares is the
best estimator of the robot's pose.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.errors import CompositeError

REACH_PX = 3
"""Largest offset, in rows and in columns, of a neighbour in the prediction filter [px]."""

_MOST_POINTS = 60_000
_RIDGE = 1e-3  # ridge penalty of the filter's coefficients, as a share of the neighbours' power


@dataclass(frozen=True)
class FloorPattern:
    """Linear prediction filter of a floor's pattern.

    Attributes:
        width: Standard deviation of the blur that is subtracted before filtering [px].
        filters: For each colour, the kernel that gives the prediction error, scaled so that the
            error on the floor has standard deviation 1, shape (3, side, side).
    """

    width: float
    filters: NDArray[np.float32]

    @classmethod
    def of(
        cls, picture: NDArray[np.float32], floor: NDArray[np.bool_], *, width: float
    ) -> "FloorPattern":
        """Fit an autoregressive model: a pixel by those before it in reading order (Whittle 1954).

        Args:
            picture: Colours, shape (height, width, 3).
            floor: True at pixels that show only the floor, shape (height, width).
            width: Standard deviation of the blur that is subtracted before filtering [px].

        Raises:
            CompositeError: Nowhere is a neighbourhood of `REACH_PX` all floor.
        """
        flat = _flat(picture, width)
        side = 2 * REACH_PX + 1
        whole = cv2.erode(
            floor.astype(np.uint8), np.ones((side, side)), borderType=cv2.BORDER_CONSTANT,
            borderValue=(0,),
        )  # fmt: skip
        rows, columns = np.nonzero(whole)
        if not len(rows):
            raise CompositeError(
                f"nowhere between the exposures are {side} by {side} px of floor visible; expected "
                "a picture with floor around them, from whose pattern exposures are distinguished"
            )
        some = slice(None, None, 1 + len(rows) // _MOST_POINTS)
        chosen = (rows[some], columns[some])
        return cls(width, np.stack([_filter(flat[..., colour], *chosen) for colour in range(3)]))

    def flat(self, picture: NDArray[np.float32]) -> NDArray[np.float32]:
        """Subtract the picture blurred by `width` (high-pass filter); same shape."""
        return _flat(picture, self.width)

    def prediction_error(self, picture: NDArray) -> NDArray[np.float32]:
        """Filter one or n pictures: each pixel minus its prediction from those above and left.

        Args:
            picture: High-pass filtered (`flat`), shape (rows, columns, 3) or (rows, columns, 3, n).

        Returns:
            Prediction error over its standard deviation on the floor, shape of `picture` [-].
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
    """Fit the kernel (side, side) that gives the prediction error of one colour at some pixels.

    Least squares with a ridge; scaled to an error of standard deviation 1 (robust).
    """
    side = 2 * REACH_PX + 1
    around = np.indices((side, side)).reshape(2, -1).T - REACH_PX
    before = around[: len(around) // 2]
    neighbours = np.stack([layer[rows + dy, columns + dx] for dy, dx in before], axis=1).astype(
        float
    )
    own = layer[rows, columns].astype(float)
    power = neighbours.T @ neighbours
    ridge = _RIDGE * np.trace(power) / len(before) * np.eye(len(before))
    shares = np.linalg.solve(power + ridge, neighbours.T @ own)
    left = own - neighbours @ shares
    size = 1.4826 * float(np.median(np.abs(left)))
    weights = np.concatenate((-shares, [1.0], np.zeros(len(before)))) / max(size, 1e-6)
    return weights.reshape(side, side).astype(np.float32)
