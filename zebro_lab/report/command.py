# SPDX-License-Identifier: MIT
"""`zebro-lab report RUN`: write an HTML report of a run."""

from zebro_lab.report.request import ReportRequest
from zebro_lab.terminal.messages import say
from zebro_lab.terminal.request_command import request_command

EPILOG = """
Examples:

zebro-lab report data/20260101T120000Z_walk_tiles --calibration calibration

zebro-lab report data --out season.html --title "Tiles, spring"

The page needs no network and no other file: send it, print it. What has not been made yet is named
with the command that makes it.
"""


@request_command()
def report(request: ReportRequest) -> None:
    """Write an HTML report with slip curve, track, prediction and validation: report.html."""
    from datetime import UTC, datetime

    from zebro_lab.report import stage

    sources = stage.report(request, made=datetime.now(UTC))
    for part in sources.parts:
        if part.missing:
            say(f"missing: {part.name}; {part.maker} makes it")
    say(f"wrote {request.out} ({request.out.stat().st_size / 1e6:.1f} MB)")
