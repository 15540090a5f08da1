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
            help="Run folder, or folder with track, prediction or validation, or folder of these.",
        ),
    ]
    calibration: Annotated[Path, Option(metavar="DIR", help="Calibration folder.")] = Path(
        "calibration"
    )
    out: Annotated[Path, Option(metavar="FILE", help="HTML file to write.")] = Path("report.html")
    title: Annotated[str | None, Option(help="Title; default: Report on RUN.")] = None
