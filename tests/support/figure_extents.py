# SPDX-License-Identifier: MIT
"""How far what is drawn in a figure goes beyond the figure's edges."""

from matplotlib.figure import Figure


def overhang(figure: Figure) -> float:
    """Compute how far the drawn artists reach over the nearest edge of the figure [inch].

    It is negative if everything lies inside.
    """
    figure.draw_without_rendering()
    drawn = figure.get_tightbbox(figure.canvas.get_renderer())
    width, height = figure.get_size_inches()
    return max(-drawn.x0, -drawn.y0, drawn.x1 - width, drawn.y1 - height)
