# SPDX-License-Identifier: MIT
"""Shared style of all figures: colours, size, title, legend, labels, and writing the files.

Colours are Okabe and Ito's and viridis: colour-blind readers and grey prints can distinguish them.
"""

import math
import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from model.arrays import Array
from model.poses import Poses
from model.slip.law import Parameter
from zebro_lab.files.picture_format import PictureFormat, format_of
from zebro_lab.files.single_file import picture_metadata
from zebro_lab.files.units import unit_symbol

BLUE, RED, GREEN, PALE_BLUE = "#0072B2", "#D55E00", "#009E73", "#56B4E9"
BAND = BLUE  # of bands of uncertainty: paths, slip curves
CYCLE = (BLUE, "#E69F00", GREEN, RED, "#CC79A7", PALE_BLUE, "#000000", "#999999")
_SHOWN_DRAWS = 60
_TIME_MARGIN = 0.01  # of the time shown
_TITLE = 12.0  # letters of a title in each inch of a figure's width
_HANDLE, _LETTER = 0.55, 0.07  # inches of a legend's entry: its symbol, and each letter
_NARROW_PAGE = 5.0  # inches, below which panels and labels have less room
NARROW = 0.15  # a peak in the first 15 % of the tested slip is drawn in an additional panel

# A decorator. The user's matplotlibrc neither affects the figures nor is changed by them.
styled = style.context(
    [
        "default",
        {
            "font.size": 8.0,
            "axes.titlesize": 8.0,
            "figure.titlesize": 9.0,
            "figure.labelsize": 8.0,
            "legend.title_fontsize": 7.0,  # small print
            "legend.frameon": False,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "pdf.fonttype": 42,  # TrueType, embedded; publishers refuse matplotlib's default
            "svg.fonttype": "path",  # letters as outlines: they look alike without the font
            "svg.hashsalt": "zebro-lab",  # the same figure gives the same bytes
        },
    ]
)


@dataclass(frozen=True)
class Page:
    """What the figures of a calibration are drawn for.

    Attributes:
        simulated: Whether their data are simulated.
        width: Their width in print; None for that on a screen [inch].
    """

    simulated: bool
    width: float | None = None

    @property
    def narrow(self) -> bool:
        """Whether there is less room for panels and labels than on a screen."""
        return self.width is not None and self.width < _NARROW_PAGE


def parameter_labels(parameters: Sequence[Parameter]) -> tuple[str, ...]:
    r"""Format an axis label of two lines for each parameter: name, then symbol and unit.

    >>> from model.slip import MagicFormula
    >>> parameter_labels(MagicFormula().parameters)[3]
    'peak slip per load\n$x_m/F_n$ [1/N]'
    """
    return tuple(
        f"{each.name.replace('_', ' ')}\n${_mathtext(each.symbol)}$ [{unit_symbol(each.unit)}]"
        for each in parameters
    )


def new_figure(title: str, simulated: bool, *, width: float, height: float) -> Figure:
    """Create an empty figure with a title and a white background, at 150 dpi.

    Args:
        title: Title of the figure.
        simulated: Whether to append "(simulated)" to the title.
        width: Width of the figure [inch].
        height: Height of the figure [inch].
    """
    figure = Figure(figsize=(width, height), dpi=150, layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    text = f"{title} (simulated)" if simulated else title
    figure.suptitle(textwrap.fill(text, int(_TITLE * width)), parse_math=False)
    return figure


@styled
def finish(figure: Figure, note: str, *, titled: bool) -> None:
    """Write a note in small print below the axes of a figure, above its legend if it has one.

    Args:
        figure: A figure of `new_figure`.
        note: The note.
        titled: Whether the figure keeps its title.
    """
    if not figure.legends:
        figure.legend([], [], loc="outside lower center", borderpad=0)
    figure.legends[0].set_title(note)
    if not titled:
        figure.suptitle("")


@styled
def save(
    figure: Figure,
    path: Path | IO[bytes],
    *,
    command: str | None = None,
    form: PictureFormat | None = None,
    dpi: float | None = None,
) -> None:
    """Write a figure as PNG, at its own resolution, or as SVG or PDF with its fonts inside.

    The file is reproducible: it has no time stamp and no library version.

    Args:
        figure: Figure to write.
        path: File to write, in an existing folder, or an open file.
        command: Command that draws the picture, stored as metadata, by which the command recognises
            a picture of its own; None for a picture in a result folder.
        form: Format of the file; None for that of the path's suffix, PNG for an open file.
        dpi: Resolution of PNG; None for the figure's own [1/inch].
    """
    form = form or (format_of(path) if isinstance(path, Path) else "png")
    metadata = picture_metadata(form, command)
    figure.savefig(path, format=form, dpi=dpi or "figure", metadata=metadata)


def legend_below(figure: Figure, *, columns: int) -> None:
    """Add one legend below all panels, with each label of any panel once.

    Args:
        figure: Figure to add the legend to.
        columns: Largest number of columns of the legend; fewer are used in a narrow figure.
    """
    entries = {
        label: handle
        for axes in figure.axes
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if not entries:
        return
    width = figure.get_figwidth()
    letters = max(10, int((width - 2 * _HANDLE) / _LETTER))  # a longer label is wrapped
    widest = min(max(len(line) for each in entries for line in each.splitlines()), letters)
    fitting = int(width / (_HANDLE + _LETTER * widest))
    figure.legend(
        entries.values(),
        ["\n".join(textwrap.fill(line, letters) for line in each.splitlines()) for each in entries],
        loc="outside lower center", ncols=max(1, min(columns, fitting)),
    )  # fmt: skip


def few_ticks(most: int) -> MaxNLocator:
    """Return a tick locator: up to `most` intervals of 1, 2, 2.5 or 5 times a power of ten."""
    return MaxNLocator(most, steps=(1, 2, 2.5, 5, 10))


def time_axis(axes: Axes, t: Array) -> None:
    """Set label, ticks and limits of a time axis: a hundredth more than `t`, for ticks at its ends.

    Args:
        axes: Axes whose horizontal axis is time.
        t: Times, shape (n,) [s].
    """
    begin, end = float(t[0]), float(t[-1])
    margin = _TIME_MARGIN * (end - begin or 1.0)
    axes.set(xlabel="time [s]", xlim=(begin - margin, end + margin))
    axes.xaxis.set_major_locator(few_ticks(6))


def map_axes(axes: Axes) -> None:
    """Set labels, grid and equal scale of axes for a map: x to the right, y up [m]."""
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.set_adjustable("datalim")
    axes.grid(color="0.92", lw=0.6)


def map_and_panels(
    title: str, *, simulated: bool, height: float, names: Sequence[str]
) -> tuple[Figure, Axes, list[Axes]]:
    """Create a figure with a map on the left and panels over time on the right.

    Args:
        title: Title of the figure.
        simulated: Whether to append "(simulated)" to the title.
        height: Height of the figure [inch].
        names: Label of each panel's vertical axis, from top to bottom.

    Returns:
        The figure, the axes of the map, and those of the panels from top to bottom.
    """
    figure = new_figure(title, simulated, width=9.0, height=height)
    grid = figure.add_gridspec(len(names), 2, width_ratios=(1.2, 1.0))
    map_axes(figure.add_subplot(grid[:, 0]))
    for i, name in enumerate(names):
        axes = figure.add_subplot(grid[i, 1])
        axes.set_ylabel(name)
        axes.grid(color="0.92", lw=0.6)
    figure.axes[-1].set_xlabel("time [s]")
    figure.align_ylabels(figure.axes[1:])
    return figure, figure.axes[0], figure.axes[1:]


def photograph_axes(
    title: str,
    photograph: NDArray[np.uint8],
    extent: tuple[float, float, float, float],
    *,
    simulated: bool,
    note: str,
) -> tuple[Figure, Axes]:
    """Create a figure with a photograph from straight above, pale, x to the right and y up.

    Args:
        title: Title of the figure.
        photograph: The floor, BGR, shape (height, width, 3).
        extent: Lowest x, highest x, lowest y, highest y of the picture on the floor [m].
        simulated: Whether to append "(simulated)" to the title.
        note: Note above the photograph.

    Returns:
        The figure, and its axes, both to one scale.
    """
    width, height = extent[1] - extent[0], extent[3] - extent[2]
    scale = min(9.0 / width, 8.0 / height)
    figure = new_figure(
        title, simulated, width=max(scale * width, 5.0) + 0.8, height=scale * height + 1.2
    )
    axes = figure.add_subplot()
    # Pale, so that what is drawn over it stands out.
    axes.imshow(photograph[:, :, ::-1], extent=extent, interpolation="antialiased", alpha=0.6)
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=extent[:2], ylim=extent[2:], aspect="equal")
    axes.set_title(note, loc="left")
    return figure, axes


def tint(share: float) -> str:
    """Return the colour of bands mixed with white, as hex; opaque, so that legends show the same.

    The share of the colour, not of the white, is from 0 to 1.

    >>> tint(0.0), tint(1.0) == BAND.lower()
    ('#ffffff', True)
    """
    red, green, blue = (1 - share * (1 - each) for each in to_rgb(BAND))
    return to_hex((red, green, blue))


def draw_band(axes: Axes, band: Poses | None, *, label: str | None = None, **style: Any) -> None:
    """Draw the first 60 draws of a path as lines on a map; nothing if there are no draws.

    Args:
        axes: Axes of the map.
        band: Draws of the path; None without draws.
        label: Label of all lines together in a legend; None for no label.
        style: Line style, as keyword arguments of `Axes.plot`, but the colour.
    """
    for i, position in enumerate(() if band is None else band.position[:_SHOWN_DRAWS]):
        axes.plot(*position.T, label=None if i else label, color=BAND, **style)


TRACTION_LABEL = "traction force [N]"


def slip_label(definition: str, width: float = np.inf) -> str:
    """Return the label of an axis of slip ratios, with the name of the slip definition.

    Args:
        definition: The slip definition.
        width: Width of the axis; a longer label is broken into two lines [inch].
    """
    label = f"slip ratio, {definition} definition [-]"
    return label if _LETTER * len(label) < width else label.replace(", ", ",\n")


def point_alpha(count: int) -> float:
    """Compute the opacity of n scatter points, 12 / sqrt(n) limited to 0.15 to 0.8 [-]."""
    return float(np.clip(12 / math.sqrt(max(count, 1)), 0.15, 0.8))


def plain(value: float) -> str:
    """Format a number with at most three significant digits; no exponent from 0.0001 to 999000.

    >>> plain(1148.3), plain(-0.01442)
    ('1150', '−0.0144')
    """
    return with_minus(f"{float(f'{value:.3g}'):g}")


def with_minus(number: str) -> str:
    """Return a formatted number with the minus sign that the ticks of axes have, U+2212.

    >>> with_minus("-0.5")
    '−0.5'
    """
    return number.replace("-", "−")


def slip_grid(slip: Array, count: int) -> Array:
    """Compute a grid of slip ratios over the tested range, denser around zero.

    Slip curves have narrow peaks near zero slip, where the grid gets additional points: within 15 %
    of the largest absolute tested slip.

    Args:
        slip: Tested slip ratios, any shape [-].
        count: Number of points over the full range; up to as many are added around zero.

    Returns:
        Increasing slip ratios, shape (m,), m up to twice `count` [-].
    """
    low, high = float(slip.min()), float(slip.max())
    reach = NARROW * max(-low, high)
    narrow = np.linspace(max(low, -reach), min(high, reach), count)
    inside = narrow[(low <= narrow) & (narrow <= high)]
    return np.unique(np.concatenate([np.linspace(low, high, count), inside]))


def _mathtext(symbol: str) -> str:
    """Format a symbol as mathtext: `mu` as the Greek letter, an n after a capital as subscript."""
    return re.sub(r"\b([A-Z])n\b", r"\1_n", re.sub(r"(?<![a-z])mu\b", r"{\\mu}", symbol))
