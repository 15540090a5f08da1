# SPDX-License-Identifier: MIT
"""How much traction across a leg's rolling direction may differ from that along it, unmeasured."""

import math
from typing import Final

from model.errors import DomainError

ANISOTROPY: Final = 1.3
"""Factor by which lateral grip and stiffness differ from longitudinal ones where not stated [-]."""


def log_spread(anisotropy: float) -> float:
    """Return the standard deviation of the logarithm of a factor that is 1 ×/÷ `anisotropy`.

    Args:
        anisotropy: The factor, one standard deviation; 1 for none [-].

    Raises:
        DomainError: It is below 1 or not finite.

    >>> round(log_spread(1.3), 3)
    0.262
    """
    if not (anisotropy >= 1 and math.isfinite(anisotropy)):
        raise DomainError(f"the anisotropy is {anisotropy:g}; expected a finite factor, 1 or more")
    return math.log(anisotropy)
