# SPDX-License-Identifier: MIT
"""Options of a report."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer


@dataclass(frozen=True)
class ReportRequest:
    """Options of `zebro-lab report`."""

    data: Annotated[
        Path,
        typer.Argument(
            metavar="RUN",
            help="Run folder, folder with track, prediction, validation, or folder of runs.",
        ),
    ]
    calibration: Annotated[Path, typer.Option(help="Calibration folder.")] = Path("calibration")
    out: Annotated[Path, typer.Option(help="Page to write.")] = Path("report.html")
    title: Annotated[str | None, typer.Option(help="Title; the folder's name without it.")] = None
