# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab report`: find result folders and write the page."""

from datetime import datetime

from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.single_file import SingleFile, require_overwritable
from zebro_lab.report.page import render_report
from zebro_lab.report.request import ReportRequest
from zebro_lab.report.sources import Sources, find_sources

REPORT = SingleFile("report", {b"<!DOCTYPE html>": b'<meta name="generator" content="zebro-lab '})


def report(request: ReportRequest, *, made: datetime) -> Sources:
    """Find the results of runs and write them as one HTML page, atomically.

    Args:
        request: Folders to report on, and the page to write.
        made: Date and time shown on the page.

    Returns:
        The results shown on the page.

    Raises:
        ZebroLabError: There is nothing to report on; a file of a result is missing or damaged; or
            `out` is a folder, a file that is no report or part of a result, or in no folder.
        OSError: The page cannot be written.
    """
    out = require_overwritable(request.out, REPORT, inputs=(request.data, request.calibration))
    sources = find_sources(request.data, calibration=request.calibration)
    title = request.title or f"Report on {request.data.absolute().name}"
    atomic_write_text(out, render_report(sources, title=title, made=made))
    return sources
