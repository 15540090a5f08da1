# SPDX-License-Identifier: MIT
"""What is found of a robot in a composite picture."""

from dataclasses import dataclass

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
