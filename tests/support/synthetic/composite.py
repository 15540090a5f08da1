# SPDX-License-Identifier: MIT
"""Composite photographs: several exposures of one walk merged into one picture."""

from collections.abc import Sequence
from enum import StrEnum

import cv2
import numpy as np

from support.synthetic.photograph import Pixels, SyntheticPhoto

_CUT_MARGIN_PX = 5  # margin of a cut-out around the robot
_FEATHER_PX = 1.5


class CompositeKind(StrEnum):
    """How exposures were merged."""

    PASTED = "pasted"
    """Each robot cut out with a margin and pasted over the first picture, later ones on top."""
    MEAN = "mean"
    """The mean of all: n exposures leave ghosts of 1/n contrast."""
    DARKEST = "darkest"
    """The darkest value of each pixel and colour; bright parts vanish in a brighter floor."""


def composite(photos: Sequence[SyntheticPhoto], kind: CompositeKind | str) -> Pixels:
    """Merge photographs of one scene.

    Args:
        photos: In order of time; of one camera that did not move.
        kind: How they are merged.

    Returns:
        One picture, shape (height, width, 3).

    Raises:
        ValueError: There is no photograph, or they differ in size.
    """
    if not photos:
        raise ValueError("no photographs to merge; expected one or more")
    sizes = {photo.pixels.shape[:2] for photo in photos}
    if len(sizes) > 1:
        found = ", ".join(f"{width}x{height}" for height, width in sorted(sizes))
        raise ValueError(f"photographs of sizes {found} px; expected one size")
    pictures = [photo.pixels for photo in photos]
    match CompositeKind(kind):
        case CompositeKind.MEAN:
            return np.rint(np.mean(pictures, axis=0)).astype(np.uint8)
        case CompositeKind.DARKEST:
            return np.min(pictures, axis=0)
        case CompositeKind.PASTED:
            return _pasted(photos)


def _pasted(photos: Sequence[SyntheticPhoto]) -> Pixels:
    merged = photos[0].pixels.astype(np.float32)
    side = 2 * _CUT_MARGIN_PX + 1
    scissors = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    for photo in photos[1:]:
        mask = cv2.dilate((photo.cover > 0).astype(np.float32), scissors)
        mask = np.asarray(cv2.GaussianBlur(mask, (0, 0), _FEATHER_PX))[..., None]
        merged = mask * photo.pixels + (1 - mask) * merged
    return np.rint(merged).astype(np.uint8)
