# SPDX-License-Identifier: MIT
"""What a robot walks on: the ground's heights, and areas of it with slip laws of their own."""

from dataclasses import dataclass

from model.arrays import Array
from model.walk.areas import Area, require_polygon
from model.walk.ground import FLAT, Ground, is_level
from model.walk.slip import Slip
from model.walk.traction import ToeLaw


@dataclass(frozen=True)
class SlipArea:
    """An area of the ground with a slip law of its own.

    Attributes:
        polygon: Corners in order, without crossing edges, shape (v, 2) [m].
        slip: The slip law.
        name: Name for figures.

    Raises:
        DomainError: The corners enclose no area, see `require_polygon`.
    """

    polygon: Array
    slip: Slip
    name: str = ""

    def __post_init__(self) -> None:
        """Check the polygon."""
        require_polygon(self.polygon)


@dataclass(frozen=True)
class Terrain:
    """The ground's heights and its areas, in the frame in which a walk begins at x, y, yaw zero.

    Attributes:
        ground: The heights.
        areas: The areas; where some overlap the last one counts.
    """

    ground: Ground = FLAT
    areas: tuple[SlipArea, ...] = ()

    @property
    def is_alike_everywhere(self) -> bool:
        """Whether it is a level plane with one slip law."""
        return is_level(self.ground) and not self.areas

    def tabulated(self, *, weight: float, toe: ToeLaw) -> tuple[Area, ...]:
        """Tabulate the areas' slip laws at their posterior means, for `with_areas`.

        Args:
            weight: Weight of the robot [N].
            toe: Traction of a leg on its toe, see `law_table`.

        Raises:
            DomainError: A law loses its shape at these loads, or `toe` is unknown.
        """
        return tuple(
            Area(each.polygon, each.slip.traction_table(weight=weight, toe=toe))
            for each in self.areas
        )


LEVEL = Terrain()
