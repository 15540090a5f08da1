# SPDX-License-Identifier: MIT
"""Options that say how the trajectory of another program is read."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, TypeVar

from typer import Option


class Layout(StrEnum):
    """Layout of a trajectory: order of the numbers in a line, a table, or a ROS log."""

    TUM = "tum"
    KITTI = "kitti"
    EUROC = "euroc"
    TABLE = "table"
    ROS = "ros"


class Plane(StrEnum):
    """Two axes of a trajectory's frame: the first and the one to its left, seen from above."""

    XY = "xy"
    YX = "yx"
    XZ = "xz"
    ZX = "zx"
    YZ = "yz"
    ZY = "zy"


class Axis(StrEnum):
    """Axis of a body's frame."""

    X = "x"
    Y = "y"
    Z = "z"


@dataclass(frozen=True)
class TrajectoryRequest:
    """Options of every command that reads trajectories of other programs."""

    layout: Annotated[
        tuple[Layout, ...],
        Option(
            metavar="LAYOUT",
            help="Layout of the trajectory, where its content leaves it open: tum (time, position, "
            "quaternion with w last), euroc (the same with w first), kitti (matrices), table, "
            "ros (a ROS log, told by its name); given twice, of the first and of the second file.",
        ),
    ] = ()
    plane: Annotated[
        Plane | None,
        Option(
            metavar="PLANE",
            help="Axes of the trajectory that span the floor, such as xy or zx, the second to the "
            "left of the first seen from above; default: xz for kitti (camera: x right, y down, z "
            "forward), else xy.",
        ),
    ] = None
    forward: Annotated[
        Axis | None,
        Option(
            metavar="AXIS",
            help="Axis of the body, or camera, that points ahead; default: z where the plane "
            "contains z, else x.",
        ),
    ] = None
    times: Annotated[
        Path | None,
        Option(metavar="FILE", help="Times of a trajectory without times, one a line [s]."),
    ] = None


T = TypeVar("T")


def of_file(given: Sequence[T], which: int) -> T | None:
    """Return the value of a repeatable option for a file; the last holds for those after it.

    None if the option was not given.

    Args:
        given: The values given.
        which: 0 for the first file of a command, 1 for the second.
    """
    return given[min(which, len(given) - 1)] if given else None
