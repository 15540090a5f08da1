# SPDX-License-Identifier: MIT
"""Finished folders in, one page out."""

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from zebro_lab.atomic import atomic_write_text
from zebro_lab.errors import AlreadyExists, NotFound
from zebro_lab.report_page import render_report
from zebro_lab.report_sources import Sources, find_sources


@dataclass(frozen=True)
class ReportRequest:
    """What is asked of a report.

    Attributes:
        data: A run folder, or a folder of them.
        calibration: The calibration folder; it need not exist.
        out: File to write.
        title: Title of the page; the folder's name when None.
    """

    data: Path
    calibration: Path
    out: Path
    title: str | None = None


def report(request: ReportRequest, *, made: datetime) -> Sources:
    """Write the page, whole or not at all, and return what it shows.

    Raises:
        ZebroLabError: There is nothing to report on, a manifest is damaged, or `out` is a folder.
    """
    if request.out.is_dir():
        raise AlreadyExists(f"{request.out} is a folder; name a file, such as report.html")
    if not request.out.absolute().parent.is_dir():
        raise NotFound(f"{request.out.parent}: no such folder; make it, or name another --out")
    sources = find_sources(request.data, calibration=request.calibration)
    title = request.title or f"Report on {request.data.absolute().name}"
    atomic_write_text(request.out, render_report(sources, title=title, made=made))
    return sources
