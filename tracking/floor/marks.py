# SPDX-License-Identifier: MIT
"""Marks on the floor at positions measured with a tape measure: markers and clicked points."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from tracking.errors import FloorError
from tracking.markers import marker_corners


@dataclass(frozen=True)
class FloorMarker:
    """A marker that lies on the floor.

    Attributes:
        marker_id: Number of the marker in the dictionary of the floor map.
        side: Side of the black square [m].
        x: x of the marker's centre [m].
        y: y of the marker's centre; y is to the left of x seen from above [m].
        yaw: Turn of the print's left-to-right direction from x, counter-clockwise [rad].
        z: Height of the print over the floor [m].
        position_sd: Standard deviation of x and of y as measured with a tape measure [m]; z is
            taken as exact.
        yaw_sd: Standard deviation of `yaw` [rad].
        side_sd: Standard deviation of `side`: printers scale by a few tenths of a percent [m].
    """

    marker_id: int
    side: float
    x: float
    y: float
    yaw: float = 0.0
    z: float = 0.0
    position_sd: float = 1e-3
    yaw_sd: float = 0.01
    side_sd: float = 2e-4

    @property
    def points(self) -> Array:
        """Corners of the marker in the floor frame, OpenCV's order, shape (4, 3) [m]."""
        return marker_corners(self.side, (self.x, self.y, self.z), self.yaw)

    @property
    def derivative(self) -> Array:
        """Derivative of `points` by x, y, yaw, side, shape (4, 3, 4) [-, -, m/rad, -]."""
        arm = self.points - (self.x, self.y, self.z)
        along = [np.tile(axis, (4, 1)) for axis in np.eye(3)[:2]]
        turn = np.column_stack((-arm[:, 1], arm[:, 0], np.zeros(4)))
        return np.stack((*along, turn, arm / self.side), axis=2)

    @property
    def prior_sd(self) -> Array:
        """Standard deviations of x, y, yaw and side, shape (4,) [m, m, rad, m]."""
        return np.array([self.position_sd, self.position_sd, self.yaw_sd, self.side_sd])

    def moved(self, step: Array) -> "FloorMarker":
        """Return the marker with a step added to x, y, yaw, side, shape (4,) [m, m, rad, m]."""
        x, y, yaw, side = (float(part) for part in step)
        return replace(self, x=self.x + x, y=self.y + y, yaw=self.yaw + yaw, side=self.side + side)

    def mirrored(self) -> "FloorMarker":
        """Return the marker with y and yaw negated, as of a map drawn with y to the right."""
        return replace(self, y=-self.y, yaw=-self.yaw)


@dataclass(frozen=True)
class FloorPoint:
    """A point of the floor that can be clicked on in a photograph.

    Attributes:
        name: Name of the point, the key of its clicks.
        x: x of the point [m].
        y: y of the point; y is to the left of x seen from above [m].
        z: Height of the point over the floor [m].
        position_sd: Standard deviation of x and of y as measured with a tape measure [m]; z is
            taken as exact.
    """

    name: str
    x: float
    y: float
    z: float = 0.0
    position_sd: float = 1e-3

    @property
    def points(self) -> Array:
        """x, y, z of the point in the floor frame, shape (1, 3) [m]."""
        return np.array([[self.x, self.y, self.z]])

    @property
    def derivative(self) -> Array:
        """Derivative of `points` with respect to x and y, shape (1, 3, 2) [-]."""
        return np.array([[[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]])

    @property
    def prior_sd(self) -> Array:
        """Standard deviations of x and y, shape (2,) [m]."""
        return np.array([self.position_sd, self.position_sd])

    def moved(self, step: Array) -> "FloorPoint":
        """Return the point with a step added to x and y, shape (2,) [m]."""
        return replace(self, x=self.x + float(step[0]), y=self.y + float(step[1]))

    def mirrored(self) -> "FloorPoint":
        """Return the point with y negated, as of a map drawn with y to the right."""
        return replace(self, y=-self.y)


Mark = FloorMarker | FloorPoint


@dataclass(frozen=True)
class FloorMap:
    """The floor's marks: markers and clicked points with their measured positions.

    Raises FloorError where two markers have one number or two points one name.

    Attributes:
        dictionary: Name of the dictionary of all markers.
        markers: The markers that lie on the floor.
        points: Points of the floor to be clicked on in photographs.
    """

    dictionary: str
    markers: tuple[FloorMarker, ...] = ()
    points: tuple[FloorPoint, ...] = ()

    def __post_init__(self) -> None:
        _refuse_doubles([f"marker {marker.marker_id}" for marker in self.markers])
        _refuse_doubles([f"point '{point.name}'" for point in self.points])

    @property
    def marks(self) -> dict[int | str, Mark]:
        """All marks: markers by number, then points by name."""
        by_number: dict[int | str, Mark] = {marker.marker_id: marker for marker in self.markers}
        return by_number | {point.name: point for point in self.points}

    @property
    def marker_ids(self) -> tuple[int, ...]:
        """Numbers of the markers, in the map's order."""
        return tuple(marker.marker_id for marker in self.markers)

    def mirrored(self) -> "FloorMap":
        """Return the map with y and yaw of all marks negated, to detect a mirrored map."""
        return self.with_marks({key: mark.mirrored() for key, mark in self.marks.items()})

    def with_marks(self, marks: dict[int | str, Mark]) -> "FloorMap":
        """Return the map with each mark replaced by `marks[key]` where `marks` has its key.

        Keys that the map does not have are ignored.
        """
        found = [marks.get(key, mark) for key, mark in self.marks.items()]
        markers = tuple(mark for mark in found if isinstance(mark, FloorMarker))
        points = tuple(mark for mark in found if isinstance(mark, FloorPoint))
        return FloorMap(self.dictionary, markers, points)


def _refuse_doubles(names: Sequence[str]) -> None:
    """Raise `FloorError` if a name occurs more than once."""
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise FloorError(f"the floor has {twice[0]} more than once; each may lie in one place only")
