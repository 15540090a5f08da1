# SPDX-License-Identifier: MIT
"""Options of a person's annotations of photographs."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer


@dataclass(frozen=True)
class AnnotateRequest:
    """Options of `zebro-lab annotate`: the annotations to write."""

    photos: Annotated[Path, typer.Argument(help="What track is given.")]
    out: Annotated[Path, typer.Option(help="File to write or to add to.")] = Path(
        "annotations.toml"
    )
    photo: Annotated[
        str | None, typer.Option(metavar="NAME", help="Photograph, for the others.")
    ] = None
    corners: Annotated[
        str | None,
        typer.Option(
            metavar="U,V U,V U,V U,V",
            help="Robot's top: front left, front right, rear right, rear left [px].",
        ),
    ] = None
    plate: Annotated[
        str | None,
        typer.Option(metavar="LENGTHxWIDTH@HEIGHT", help="The top; the robot's body without it."),
    ] = None
    margin: Annotated[
        str, typer.Option(metavar="LENGTH", help="How much around it belongs to its picture.")
    ] = "20mm"
    robot: Annotated[
        Path | None, typer.Option("--robot", help="robot.toml; the thesis's robot without it.")
    ] = None
    clicks: Annotated[
        tuple[str, ...],
        typer.Option("--click", metavar="PHOTO:NAME=U,V", help="A point of floor.toml [px]."),
    ] = ()
    moves: Annotated[
        tuple[str, ...],
        typer.Option("--move", metavar="PHOTO:X,Y,YAW", help="Where the robot is [m, m, deg]."),
    ] = ()
    flips: Annotated[
        tuple[str, ...],
        typer.Option("--flip", metavar="PHOTO", help="Head and tail are exchanged."),
    ] = ()
    deletes: Annotated[
        tuple[str, ...],
        typer.Option("--delete", metavar="PHOTO", help="That is not the robot."),
    ] = ()
    order: Annotated[
        str | None,
        typer.Option("--order", metavar="PHOTO,PHOTO,…", help="Taken in this order."),
    ] = None
    added: Annotated[
        Path | None, typer.Option("--from", metavar="TOML", help="Add what this file says.")
    ] = None

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to write."""
        return not any((self.corners, self.clicks, self.moves, self.flips, self.deletes,
                        self.order, self.added))  # fmt: skip
