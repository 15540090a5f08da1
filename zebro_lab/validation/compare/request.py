# SPDX-License-Identifier: MIT
"""Options of a comparison."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from zebro_lab.terminal.picture_options import FormatOption


@dataclass(frozen=True)
class CompareRequest:
    """Options of `zebro-lab compare`."""

    first: Annotated[
        Path,
        Argument(
            metavar="A",
            help="Calibration folder, run folder, or a curve: thesis, coulomb:MU, magic:B,C,D,E or "
            "a table.",
        ),
    ]
    second: Annotated[
        Path, Argument(metavar="B", help="Second of the same kind; a curve beside a calibration.")
    ]
    out: Annotated[Path, Option(metavar="DIR", help="Folder to write.")] = Path("comparison")
    seed: Annotated[int, Option(min=0, help="Seed of all random numbers.")] = 1
    form: FormatOption = "png"
