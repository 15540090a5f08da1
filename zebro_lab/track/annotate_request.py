# SPDX-License-Identifier: MIT
"""Options of a person's annotations of photographs."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from typer import Argument, Option


@dataclass(frozen=True)
class AnnotateRequest:
    """Options of `zebro-lab annotate`: the annotations to write."""

    photos: Annotated[
        Path, Argument(metavar="PHOTOS", help="Folder, video or picture, as given to track.")
    ]
    out: Annotated[Path, Option(metavar="FILE", help="File to create or to add to.")] = Path(
        "annotations.toml"
    )
    photo: Annotated[
        str | None, Option(metavar="NAME", help="Photograph for --corners or --grid.")
    ] = None
    corners: Annotated[
        str | None,
        Option(
            metavar="U,V U,V U,V U,V",
            help="Corners of the robot's top: front left, front right, rear right, rear left [px].",
        ),
    ] = None
    plate: Annotated[
        str | None,
        Option(metavar="LENGTHxWIDTH@HEIGHT",
               help="Robot's top, its height above the body's centre; default: the body's size."),
    ] = None  # fmt: skip
    margin: Annotated[
        str, Option(metavar="LENGTH", help="Width around the top that is also compared.")
    ] = "20mm"
    robot: Annotated[
        Path | None, Option(metavar="FILE", help="robot.toml; default: the thesis's robot.")
    ] = None
    clicks: Annotated[
        tuple[str, ...],
        Option("--click", metavar="PHOTO:NAME=U,V", help="Pixel of floor point NAME; repeatable."),
    ] = ()
    moves: Annotated[
        tuple[str, ...],
        Option("--move", metavar="PHOTO:X,Y,YAW", help="Set a pose [m, m, deg]; repeatable."),
    ] = ()
    flips: Annotated[
        tuple[str, ...],
        Option("--flip", metavar="PHOTO", help="Exchange head and tail of a pose; repeatable."),
    ] = ()
    deletes: Annotated[
        tuple[str, ...],
        Option("--delete", metavar="PHOTO", help="Delete the pose in a photograph; repeatable."),
    ] = ()
    added: Annotated[
        Path | None, Option("--from", metavar="TOML", help="Another annotations.toml to add.")
    ] = None

    @property
    def is_empty(self) -> bool:
        """Whether no annotation is given."""
        return not any((self.corners, self.clicks, self.moves, self.flips, self.deletes,
                        self.added))  # fmt: skip
