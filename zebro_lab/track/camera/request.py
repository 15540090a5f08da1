# SPDX-License-Identifier: MIT
"""Options of a camera calibration."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import typer

LensModel: TypeAlias = Literal["auto", "none", "k1", "k1-k2", "full"]


@dataclass(frozen=True)
class CameraRequest:
    """Options of `zebro-lab camera calibrate`."""

    photos: Annotated[Path, typer.Argument(help="Folder of photographs of the board.")]
    board: Annotated[
        str,
        typer.Option(
            metavar="BOARD",
            help="kit, checkerboard:COLUMNSxROWS:SQUARE (inner corners) or "
            "charuco:COLUMNSxROWS:SQUARE:MARKER:DICTIONARY (squares).",
        ),
    ] = "kit"
    out: Annotated[Path, typer.Option(help="File to write.")] = Path("camera.toml")
    lens: Annotated[
        LensModel, typer.Option(help="Distortion to fit; auto: no more than the photographs show.")
    ] = "auto"
    workers: Annotated[int, typer.Option(min=1, help="Processes to use.")] = 2
