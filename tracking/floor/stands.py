# SPDX-License-Identifier: MIT
"""Detect camera movement: split the photographs where the floor's marks jump in the picture."""

from collections.abc import Sequence

import numpy as np

from model.arrays import Array
from tracking.floor.locate import FloorView

JUMP_PX = 0.2
"""Least shift of the floor's marks, beyond 3 standard deviations, that counts as movement [px]."""


def split_stands(views: Sequence[FloorView], *, jump_px: float = JUMP_PX) -> tuple[int, ...]:
    """Number the stands: stretches of photographs between which the camera moved.

    A rotation by 0.05 degrees moves the floor by 1 px in a usual picture and the path by 2 mm. So
    the median shift of the marks from their mean in the stand so far is compared with their noise.

    Args:
        views: Pixels of the floor's marks in each photograph, in order of time.
        jump_px: Least shift, beyond 3 standard deviations, that counts as movement [px].

    Returns:
        For every photograph the number of its stand, from 0. A photograph without marks, or
        without a mark in common with the stand before it, belongs to that stand.
    """
    stands: list[int] = []
    current: list[FloorView] = []
    number = 0
    for view in views:
        if current and _has_moved(current, view, jump_px):
            number += 1
            current = []
        if view.pixels:
            current.append(view)
        stands.append(number)
    return tuple(stands)


def _has_moved(stand: Sequence[FloorView], view: FloorView, jump_px: float) -> bool:
    shifts, noises = [], []
    for key, pixels in view.pixels.items():
        before = [np.asarray(other.pixels[key]) for other in stand if key in other.pixels]
        if before:
            shifts.append((pixels - np.mean(before, axis=0)).ravel())
            noises.append(np.diag(view.covariances[key]) * (1 + 1 / len(before)))
    if not shifts:
        return False
    return _typical(np.concatenate(shifts)) > jump_px + 3 * float(
        np.sqrt(np.median(np.concatenate(noises)))
    )


def _typical(shift: Array) -> float:
    # The median over points: a mark that is half hidden by a leg must not count as a movement.
    return float(np.median(np.linalg.norm(shift.reshape(-1, 2), axis=1)))
