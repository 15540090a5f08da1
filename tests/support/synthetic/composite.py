# SPDX-License-Identifier: MIT
"""Composite photographs: exposures of one walk cut out and pasted into one picture."""

from collections.abc import Sequence

import cv2
import numpy as np

from support.synthetic.photograph import Pixels, SyntheticPhoto

_CUT_MARGIN_PX = 5  # margin of a cut-out around the robot
_FEATHER_PX = 1.5


def composite(photos: Sequence[SyntheticPhoto]) -> Pixels:
    """Cut the robot with a margin out of each photograph, paste it over the first, later on top.

    Args:
        photos: In order of time; of one camera that did not move.

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
    merged = photos[0].pixels.astype(np.float32)
    side = 2 * _CUT_MARGIN_PX + 1
    scissors = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    for photo in photos[1:]:
        mask = cv2.dilate((photo.cover > 0).astype(np.float32), scissors)
        mask = np.asarray(cv2.GaussianBlur(mask, (0, 0), _FEATHER_PX))[..., None]
        merged = mask * photo.pixels + (1 - mask) * merged
    return np.rint(merged).astype(np.uint8)
