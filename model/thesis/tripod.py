# SPDX-License-Identifier: MIT
"""Contact automaton of the tripod gait: the standing tripod, from hip heights."""

from typing import Literal

import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from model.arrays import Array
from model.robot import N_LEGS

Rule = Literal["listing", "text"]
RULES: tuple[Rule, ...] = ("listing", "text")
"""What the thesis's dynamics follows where its listing and its text differ."""

TIE = 1e-12  # hip heights closer than rounding are equal [m]


def switch_by_table(heights: Array, contact: NDArray[np.bool_]) -> bool:
    r"""Change each side's stance legs by Table 3-1: to those with the higher mean hip height.

    .. math::
        \mathcal C^i = \{1, 5\} \to \{3\} \text{ when } z_{h,3} > \tfrac12 (z_{h,1} + z_{h,5}),
        \text{ and back when it is lower}

    The same holds for {2, 6} and {4}; heights within 1e-12 m are equal and change nothing. Table
    3-1 prints all four inequalities the other way round; taken so, a side would stand on the legs
    that do not reach the ground. The listing has them right.

    Args:
        heights: Hip heights above each leg's lowest point, shape (6,) [m].
        contact: Whether a leg is on the ground; changed in place, shape (6,).

    Returns:
        Whether any leg changed.
    """
    changed = False
    for side in range(2):
        front, middle, rear = side, side + 2, side + 4
        ahead = heights[middle] - 0.5 * (heights[front] + heights[rear])
        on_middle = contact[middle]
        if (ahead > TIE and not on_middle) or (ahead < -TIE and on_middle):
            contact[front] = contact[rear] = on_middle
            contact[middle] = not on_middle
            changed = True
    return changed


def switch_by_listing(heights: Array, contact: NDArray[np.bool_], inner: int) -> bool:
    """Change the standing tripod by Listing A.32, once an inner leg in flight has a higher hip.

    The inner legs in flight take over as soon as any of their hips is higher than any of the
    standing inner legs' hips; the outer side follows, so that always one whole tripod stands. In
    the listing a tie switches to the legs in flight. At the start of a matched gait, where heights
    are equal but for rounding, the rounding then decides. Here a tie, to 1e-12 m, changes nothing.

    Args:
        heights: Hip heights above each leg's lowest point, shape (6,) [m].
        contact: Whether a leg is on the ground; changed in place, shape (6,).
        inner: 0 when the left legs are the inner ones, 1 when the right ones are.

    Returns:
        Whether the tripod changed.
    """
    front, middle, rear = inner, inner + 2, inner + 4
    ahead_of_front = heights[middle] - heights[front]
    ahead_of_rear = heights[middle] - heights[rear]
    on_middle = contact[middle]
    if on_middle:
        changed = ahead_of_front < -TIE or ahead_of_rear < -TIE
    else:
        changed = ahead_of_front > TIE or ahead_of_rear > TIE
    if changed:
        for leg in range(N_LEGS):
            contact[leg] = not contact[leg]
    return changed


for _function in (switch_by_table, switch_by_listing):
    register_jitable(_function)
