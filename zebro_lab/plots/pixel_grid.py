# SPDX-License-Identifier: MIT
"""Draw a photograph with a pixel grid, to read pixel coordinates without a mouse."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from zebro_lab.plots.sheet import new_figure, styled

_WIDTH = 11.0  # inches


@styled
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
    figure = new_figure(title, simulated=False, width=_WIDTH, height=_WIDTH * height / width + 0.4)
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
