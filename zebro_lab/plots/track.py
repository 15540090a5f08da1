# SPDX-License-Identifier: MIT
"""Plot a track over photographs and the floor, its residuals over time, and a grid of pixels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.plots import sheet

_GRID_WIDTH = 11.0  # inches


@sheet.styled
def pixel_grid(
    pixels: NDArray[np.uint8], *, title: str, around: tuple[float, float] | None = None,
    reach: int = 100,
) -> Figure:  # fmt: skip
    """Draw a photograph with a pixel grid; the centre of the top left pixel is (0, 0).

    Args:
        pixels: The photograph, BGR, shape (height, width, 3).
        title: Title of the figure.
        around: Column u and row v of the centre of an enlarged region [px]; None for the whole
            photograph.
        reach: Half the side of the enlarged region [px]; it is cut at the photograph's edges.

    Returns:
        The figure.
    """
    rows, columns = pixels.shape[:2]
    low, high = np.array([-0.5, -0.5]), np.array([columns, rows]) - 0.5
    if around is not None:
        low = np.maximum(low, np.subtract(around, reach))
        high = np.minimum(high, np.add(around, reach))
    width, height = high - low
    figure = sheet.new_figure(
        title, simulated=False, width=_GRID_WIDTH, height=_GRID_WIDTH * height / width + 0.4
    )
    axes = figure.add_subplot()
    axes.imshow(pixels[:, :, ::-1], interpolation="nearest")
    axes.set(xlim=(low[0], high[0]), ylim=(high[1], low[1]), xlabel="u [px]", ylabel="v [px]")
    for axis, length in ((axes.xaxis, width), (axes.yaxis, height)):
        axis.set_major_locator(MaxNLocator(round(24 * length / max(width, height)) + 2,
                                           integer=True, steps=[1, 2, 5, 10]))  # fmt: skip
    axes.tick_params(labelsize=7, right=True, top=True, labelright=True, labeltop=True)
    axes.tick_params(axis="x", rotation=90)
    axes.grid(color="yellow", lw=0.5, alpha=0.6)  # rare on floors and robots
    return figure


_WIDTH = 9.0  # inches
_GREEN = sheet.CYCLE[2]
_MOST_ARROWS = 24
_MOST_LABELS = 12
_ORIGIN, _HEADING = "body's origin", "heading"
_UNSEEN = "0.35"  # black, as pale as the photograph is drawn


@dataclass(frozen=True)
class SeenMarks:
    """Outlines to draw in a photograph, of one colour.

    Attributes:
        outlines_px: Corners u, v of each outline, shape (m, 2) [px]; the last is joined to the
            first when drawn.
        labels: Label of each outline, as many as outlines; "" writes none.
        name: Name of the group, for the key.
        colour: Colour of outlines and labels, as matplotlib takes it.
    """

    outlines_px: Sequence[Array]
    labels: Sequence[str]
    name: str
    colour: str


@sheet.styled
def over_photo(
    pixels: NDArray[np.uint8], *, title: str, simulated: bool, path_px: Array | None = None,
    headings_px: Array | None = None, marks: Sequence[SeenMarks] = (),
) -> Figure:  # fmt: skip
    """Draw path, headings and detected markers over a photograph.

    Args:
        pixels: The photograph, BGR, shape (height, width, 3).
        title: Title of the figure.
        simulated: Whether to append "(simulated)" to the title.
        path_px: Tracked origin of the body over time, shape (n, 2) [px]; NaN interrupts the line.
        headings_px: Point ahead of the body at each origin, the tip of an arrow, shape (n, 2) [px].
            The path is drawn only if both are given.
        marks: Groups of outlines; the first corner of each gets a dot.

    Returns:
        The figure.
    """
    rows, columns = pixels.shape[:2]
    figure = sheet.new_figure(title, simulated, width=_WIDTH, height=_WIDTH * rows / columns + 0.5)
    axes = figure.add_subplot()
    axes.imshow(pixels[:, :, ::-1], interpolation="antialiased")
    for group in marks:
        _outline(axes, group)
    if path_px is not None and headings_px is not None:
        _path(axes, path_px, headings_px)
    axes.set(xlim=(-0.5, columns - 0.5), ylim=(rows - 0.5, -0.5))
    axes.set_axis_off()
    sheet.legend_below(figure, columns=3)
    return figure


def _outline(axes: Axes, group: SeenMarks) -> None:
    """Draw closed outlines, with a dot at the first corner and the label to the right."""
    for outline, label in zip(group.outlines_px, group.labels, strict=True):
        closed = np.vstack((outline, outline[:1]))
        axes.plot(
            *closed.T, color=group.colour, lw=1.0, marker="o", ms=3, markevery=[0],
            label=f"{group.name}, dot at its first corner",
        )  # fmt: skip
        if label:
            # Beside the mark: a label on a marker would hide it.
            axes.annotate(
                label, (float(outline[:, 0].max()), float(outline[:, 1].mean())), xytext=(5, 0),
                textcoords="offset points", va="center", color=group.colour, fontsize=8,
                fontweight="bold", bbox={"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 1},
            )  # fmt: skip


def _path(axes: Axes, path: Array, ahead: Array) -> None:
    """Draw the path, and arrows from its points to the points ahead, shape (n, 2) each [px]."""
    axes.plot(*path.T, color=sheet.RED, lw=1.2, marker="o", ms=2.5, label=_ORIGIN)
    _arrows(axes, path, ahead - path)


def _arrows(axes: Axes, start: Array, step: Array) -> None:
    """Draw at most `_MOST_ARROWS` headings over the path, white-edged since they lie along it."""
    known = np.flatnonzero(np.isfinite(start[:, 0]))
    chosen = known[:: -(-len(known) // _MOST_ARROWS) or 1]
    axes.quiver(
        *start[chosen].T, *step[chosen].T, angles="xy", scale_units="xy", scale=1, color=_GREEN,
        width=0.004, headwidth=3.5, headlength=4, headaxislength=3.5, edgecolor="white", lw=0.6,
        zorder=4, label=_HEADING,
    )  # fmt: skip


@sheet.styled
def over_floor(
    floor: NDArray[np.uint8], *, extent: tuple[float, float, float, float], poses: Array,
    ellipses: Sequence[Array], labels: Sequence[str], title: str, note: str, simulated: bool,
) -> Figure:  # fmt: skip
    """Draw a track over the floor as seen from straight above.

    Args:
        floor: The rectified floor, BGR, shape (height, width, 3).
        extent: Lowest x, highest x, lowest y, highest y of the picture on the floor [m].
        poses: x, y [m] and yaw [rad], shape (n, 3); NaN interrupts the path.
        ellipses: Outline x, y of the confidence region around each pose, shape (m, 2) [m].
        labels: Label of each pose, "" for none; at most twelve are written.
        title: Title of the figure.
        note: Note on the photograph, above it.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure, x to the right and y up, both to one scale.
    """
    figure, axes = sheet.photograph_axes(title, floor, extent, simulated=simulated, note=note)
    axes.plot(*poses[:, :2].T, color=sheet.RED, lw=1.3, marker="o", ms=2.5, label=_ORIGIN)
    for ellipse in ellipses:
        axes.plot(*ellipse.T, color=sheet.BLUE, lw=0.9, zorder=5, label="90 % region of the origin")
    reach = 0.03 * max(extent[1] - extent[0], extent[3] - extent[2])
    _arrows(axes, poses[:, :2],
            reach * np.column_stack((np.cos(poses[:, 2]), np.sin(poses[:, 2]))))  # fmt: skip
    if np.any(np.all(floor == 0, axis=2)):
        axes.fill_between([], [], color=_UNSEEN, lw=0, label="outside the photograph")
    sheet.legend_below(figure, columns=4)
    labelled = [k for k, label in enumerate(labels) if label]
    for k in labelled[:: -(-len(labelled) // _MOST_LABELS) or 1]:
        axes.annotate(
            labels[k],
            (poses[k, 0], poses[k, 1]),
            xytext=(6, -3),
            textcoords="offset points",
            va="top",
        )
    return figure


@sheet.styled
def residual_page(
    t: Array, residuals: Array, *, sd: Array, score: Array, height: Array, source: Sequence[str],
    title: str, simulated: bool,
) -> Figure:  # fmt: skip
    """Draw the residuals of observed poses against the smoothed path, body height and score.

    Args:
        t: Times, shape (n,) [s].
        residuals: Observed minus smoothed x, y [m] and yaw [rad], shape (n, 3).
        sd: Standard deviation of each observation of x, y [m] and yaw [rad], shape (n, 3).
        score: Similarity score of each detection, shape (n,) [-].
        height: Height of the body's origin above the floor, shape (n,) [m].
        source: How each pose was found, n of them: "marker", "body" or "hand"; any other source is
            drawn as crosses.
        title: Title of the figure.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure: residuals of x, y and yaw with the 90 % bands of the observation noise, then
        height and score.
    """
    figure = sheet.new_figure(title, simulated, width=8.5, height=8.5)
    panels = figure.subplots(5, 1, sharex=True)
    names = ("x [mm]", "y [mm]", "yaw [deg]")
    units = (1e3, 1e3, np.degrees(1.0))
    for axes, name, unit, left, spread in zip(
        panels, names, units, residuals.T, sd.T, strict=False
    ):
        band = 1.645 * unit * spread
        axes.fill_between(t, -band, band, color="0.88", lw=0, label="90 % of observation errors")
        axes.axhline(0, color="0.5", lw=0.6)
        _by_source(axes, t, unit * left, source)
        axes.set_ylabel(f"observed − path\n{name}")
    _by_source(panels[3], t, 1e3 * height, source)
    panels[3].set_ylabel("body height\n[mm]")
    _by_source(panels[4], t, score, source)
    panels[4].set(ylabel="score [-]", xlabel="time [s]")
    for axes in panels:
        axes.yaxis.set_major_locator(sheet.few_ticks(5))
        axes.grid(color="0.93", lw=0.6)
        axes.set_axisbelow(True)
    figure.align_ylabels(panels)
    sheet.legend_below(figure, columns=4)
    return figure


def _by_source(axes: Axes, t: Array, values: Array, source: Sequence[str]) -> None:
    """Draw values over time as dots of a shape and colour for each source of poses."""
    shapes = {"marker": ("o", sheet.BLUE), "body": ("s", _GREEN), "hand": ("D", sheet.RED)}
    for name in dict.fromkeys(source):
        chosen = np.array([each == name for each in source])
        shape, colour = shapes.get(name, ("x", "black"))
        axes.plot(t[chosen], values[chosen], ls="none", marker=shape, ms=3.5, color=colour,
                  label=f"by {name}")  # fmt: skip
