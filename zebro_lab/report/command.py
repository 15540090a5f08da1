# SPDX-License-Identifier: MIT
"""`zebro-lab report RUN`: write an HTML report of a run."""

from datetime import UTC, datetime

from zebro_lab.report.request import ReportRequest
from zebro_lab.terminal.output import TEXT, Output
from zebro_lab.terminal.request_command import request_command

EPILOG = """
Examples:

zebro-lab report data/20260101T120000Z_walk_tiles --calibration calibration

zebro-lab report data --out season.html --title "Tiles, spring"

The page contains all pictures and needs no network. For results that do not exist yet, page and
command line name the command that creates them. Results that were not made from one another are
named, and a calibration that no prediction used is no headline.
"""


@request_command()
def report(request: ReportRequest, output: Output = TEXT) -> None:
    """Write an HTML report with slip curve, track, prediction and validation: report.html."""
    from zebro_lab.report import belonging, stage

    sources = stage.report(request, made=datetime.now(UTC))
    notices = list(belonging.belonging(sources).notices)
    for notice in notices:
        output.say(f"does not belong together: {notice}")
    for part in sources.missing:
        output.say(f"missing: {part.name}; create it with: {part.maker}")
    output.say(f"wrote {request.out} ({request.out.stat().st_size / 1e6:.1f} MB)")
    missing = {part.name: part.maker for part in sources.missing}
    content = {"written": [request.out], "missing": missing, "not_belonging": notices}
    output.document("report", content)
