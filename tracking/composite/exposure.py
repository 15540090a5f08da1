# SPDX-License-Identifier: MIT
"""One exposure of the robot in a composite picture."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracking.body import Alignment


@dataclass(frozen=True)
class Exposure:
    """One exposure of the robot in a composite picture.

    Attributes:
        alignment: Where it is.
        visible: Share of its top that no other hides [-].
    """

    alignment: Alignment
    visible: float

    @property
    def is_rough(self) -> bool:
        """Whether it could not be aligned and is where a raster showed it."""
        return self.alignment.score == 0.0


def is_new(exposure: Exposure, known: Sequence[Exposure], same: float) -> bool:
    """Return whether an exposure is farther than a limit from all that are known.

    Args:
        exposure: The exposure.
        known: Known exposures.
        same: Limit of the distance [m].
    """
    here = exposure.alignment.pose.planar
    return all(np.hypot(*(here - each.alignment.pose.planar)[:2]) > same for each in known)
