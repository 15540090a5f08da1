# SPDX-License-Identifier: MIT
"""`zebro-lab report RUN`: write an HTML report of a run."""

from pathlib import Path
from typing import Annotated

import typer

from zebro_lab.terminal.messages import say

EPILOG = """
Examples:

zebro-lab report data/20260101T120000Z_walk_tiles --calibration calibration

zebro-lab report data --out season.html --title "Tiles, spring"

The page needs no network and no other file: send it, print it. What has not been made yet is named
with the command that makes it.
"""


def report(
    data: Annotated[
        Path,
        typer.Argument(
            metavar="RUN",
            help="Run folder, folder with track, prediction, validation, or folder of runs.",
        ),
    ],
    calibration: Annotated[Path, typer.Option(help="Calibration folder.")] = Path("calibration"),
    out: Annotated[Path, typer.Option(help="Page to write.")] = Path("report.html"),
    title: Annotated[str | None, typer.Option(help="Title; the folder's name without it.")] = None,
) -> None:
    """Write an HTML report with slip curve, track, prediction and validation: report.html."""
    from datetime import UTC, datetime

    from zebro_lab.report.stage import ReportRequest
    from zebro_lab.report.stage import report as run

    sources = run(ReportRequest(data, calibration, out, title), made=datetime.now(UTC))
    for part in sources.parts:
        if part.missing:
            say(f"missing: {part.name}; {part.maker} makes it")
    say(f"wrote {out} ({out.stat().st_size / 1e6:.1f} MB)")
