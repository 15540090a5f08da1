# SPDX-License-Identifier: MIT
"""The tracking kit as PDF, at true scale."""

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
    """Write pages as PDF; a millimetre of a page is a millimetre on paper.

    The bytes depend on the pages alone: no time stamp goes in.

    Args:
        pages: The pages.
        path: Where to; its folder exists. Or a file that is open.
    """
    metadata = {"Creator": "zebro-lab", "Title": "Tracking kit", "CreationDate": None}
    with PdfPages(path, metadata=metadata) as file:
        for page in pages:
            file.savefig(draw_page(page))


@styled
def draw_page(page: KitPage) -> Figure:
    """Draw a page on a figure of the paper's size."""
    figure = Figure(figsize=(page.width / _INCH, page.height / _INCH), facecolor="white")
    # Axes that fill the paper and count in millimetres: nothing is fitted or shrunk.
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0, page.width), ylim=(0, page.height))
    axes.set_axis_off()
    for black in page.rectangles:
        axes.add_patch(
            Patch((black.x, black.y), black.width, black.height, color="black", lw=0, snap=False)
        )
    for text in page.texts:
        axes.text(
            text.x, text.y, text.text, fontsize=text.size, family="DejaVu Sans Mono"
            if "   " in text.text else "DejaVu Sans", ha="center" if text.centred else "left",
            va="baseline", parse_math=False,
        )  # fmt: skip
    return figure
