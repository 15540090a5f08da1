# SPDX-License-Identifier: MIT
"""Draw the tracking kit as PDF, at true scale."""

from collections.abc import Sequence
from os import PathLike
from typing import IO

from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle as Patch

from zebro_lab.plots.sheet import styled
from zebro_lab.track.camera.kit import KitPage

_INCH = 25.4  # mm


@styled
def save_pages(pages: Sequence[KitPage], path: str | PathLike[str] | IO[bytes]) -> None:
    """Write pages as PDF at true scale: 1 mm of a page is 1 mm on paper.

    The bytes depend on the pages alone: no time stamp is written.

    Args:
        pages: The pages.
        path: File to write, in an existing folder, or a file open in binary mode.
    """
    metadata = {"Creator": "zebro-lab", "Title": "Tracking kit", "CreationDate": None}
    with PdfPages(path, metadata=metadata) as file:
        for page in pages:
            file.savefig(draw_page(page))


@styled
def draw_page(page: KitPage) -> Figure:
    """Draw rectangles and texts of a page on a figure of the paper's size; return the figure."""
    figure = Figure(figsize=(page.width / _INCH, page.height / _INCH), facecolor="white")
    # Axes that fill the paper, in millimetres: nothing is rescaled.
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0, page.width), ylim=(0, page.height))
    axes.set_axis_off()
    for black in page.rectangles:
        axes.add_patch(
            Patch((black.x, black.y), black.width, black.height, color="black", lw=0, snap=False)
        )
    for text in page.texts:
        # Of one width for each letter where several blanks align a line, as in a sketch.
        axes.text(
            text.x, text.y, text.text, fontsize=text.size, family="DejaVu Sans Mono"
            if "   " in text.text else "DejaVu Sans", ha="center" if text.centred else "left",
            va="baseline", parse_math=False,
        )  # fmt: skip
    return figure
