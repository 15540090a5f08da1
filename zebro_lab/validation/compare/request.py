# SPDX-License-Identifier: MIT
"""Options of a comparison."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer


@dataclass(frozen=True)
class CompareRequest:
    """Options of `zebro-lab compare`."""

    first: Annotated[Path, typer.Argument(metavar="A", help="Calibration folder or run folder.")]
    second: Annotated[Path, typer.Argument(metavar="B", help="Another of the same kind.")]
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("comparison")
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 1
