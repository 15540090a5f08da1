# SPDX-License-Identifier: MIT
"""Options of a camera calibration."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from typer import Argument, Option

LensModel: TypeAlias = Literal["auto", "none", "k1", "k1-k2", "full"]


@dataclass(frozen=True)
class CameraRequest:
    """Options of `zebro-lab camera calibrate`."""

    photos: Annotated[Path, Argument(metavar="DIR", help="Folder of photographs of the board.")]
    board: Annotated[
        str,
        Option(
            metavar="BOARD",
            help="kit, checkerboard:COLUMNSxROWS:SQUARE (inner corners) or "
            "charuco:COLUMNSxROWS:SQUARE:MARKER:DICTIONARY (squares).",
        ),
    ] = "kit"
    out: Annotated[Path, Option(metavar="FILE", help="File to write.")] = Path("camera.toml")
    lens: Annotated[
        LensModel,
        Option(
            help="Lens distortion to fit; auto: the simplest model that the photographs support. "
            "Terms that a named model leaves out are taken to be zero."
        ),
    ] = "auto"
