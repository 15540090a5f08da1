# SPDX-License-Identifier: MIT
"""Inner and outer legs in a turn."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from model.errors import DomainError
from model.robot import LEFT, N_LEGS, RIGHT

Direction = Literal["left", "right"]


def inner_legs(direction: Direction) -> tuple[int, ...]:
    """Return the indices of the legs on the side that the robot turns to.

    Raises:
        DomainError: The direction is neither left nor right.

    >>> inner_legs("left")
    (0, 2, 4)
    """
    sides = {"left": LEFT, "right": RIGHT}
    if direction not in sides:
        raise DomainError(f"direction is {direction!r}; expected 'left' or 'right'")
    return sides[direction]


def is_inner(direction: Direction) -> NDArray[np.bool_]:
    """Return whether each leg is on the side that the robot turns to, shape (6,).

    Raises:
        DomainError: The direction is neither left nor right.
    """
    return np.isin(np.arange(N_LEGS), inner_legs(direction))
