# SPDX-License-Identifier: MIT
"""Strides of a constant gait on level ground: once they are alike, the rest are copies.

On level ground the motion depends on no place and no heading. A stride that is like the one before
therefore moves the body by the same element of SE(2), and the path is its repeated composition.
"""

from collections.abc import Iterable

import numpy as np

from model.arrays import Array
from model.poses import compose, relative

ALIKE = 1e-4  # change of a stride's move from one to the next, over its length [-]
ALIKE_TURN = 1e-5  # change of its turn [rad]; n strides on, n/2 of it in the path's direction
MOST_STRIDES = 12  # after which the last is taken as settled; a tetrapod rocks for a few strides


def strides_until_alike(strides: Iterable[Array], *, least_length: float) -> list[Array]:
    """Take strides until one moves the body like the stride before, `MOST_STRIDES` at most.

    Forward and left, the move of a stride like another differs from it by less than `ALIKE` of its
    length, and its turn by less than `ALIKE_TURN`.

    Args:
        strides: Strides one after the other: x, y, yaw, roll and pitch at the stride's start and
            after each of its n steps, shape (n + 1, 5) each [m, rad].
        least_length: Length to compare with instead if a stride is shorter, as one that turns on
            the spot [m].
    """
    walked: list[Array] = []
    last = np.full(3, np.inf)
    for stride in strides:
        walked.append(stride)
        move = relative(stride[-1, :3], stride[0, :3])
        change = np.abs(move - last)
        length = max(float(np.hypot(*move[:2])), least_length)
        alike = change[:2].max() < ALIKE * length and change[2] < ALIKE_TURN
        if alike or len(walked) == MOST_STRIDES:
            break
        last = move
    return walked


def repeated_strides(walked: list[Array], steps: int) -> Array:
    """Join strides to one walk, in which the last stride is repeated from where it ends.

    Args:
        walked: Strides one after the other, as for `strides_until_alike`.
        steps: Number of steps of the walk.

    Returns:
        x, y, yaw, roll and pitch at the start and after each step, shape (steps + 1, 5) [m, rad].
    """
    parts = [walked[0][:1], *(stride[1:] for stride in walked)]
    move, tilt = relative(walked[-1][1:, :3], walked[-1][0, :3]), walked[-1][1:, 3:]
    for _ in range(len(walked), -(-steps // len(move))):
        parts.append(np.column_stack([compose(parts[-1][-1, :3], move), tilt]))
    return np.concatenate(parts)[: steps + 1]
