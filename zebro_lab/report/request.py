# SPDX-License-Identifier: MIT
"""Options of a report."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from typer import Argument, Option


@dataclass(frozen=True)
class ReportRequest:
    """Options of `zebro-lab report`."""

    data: Annotated[
        Path,
        Argument(
            metavar="RUN",
            help="Run folder, folder with track, prediction, validation, or folder of runs.",
        ),
    ]
    calibration: Annotated[Path, Option(help="Calibration folder.")] = Path("calibration")
    out: Annotated[Path, Option(help="Page to write.")] = Path("report.html")
    title: Annotated[str | None, Option(help="Title; default: the folder's name.")] = None
