# SPDX-License-Identifier: MIT
"""Whether what is drawn in a figure lies inside its edges, and texts beside each other."""

from matplotlib.figure import Figure
from matplotlib.text import Text


def overhang(figure: Figure) -> float:
    """Compute how far the drawn artists reach over the nearest edge of the figure [inch].

    It is negative if everything lies inside.
    """
    figure.draw_without_rendering()
    drawn = figure.get_tightbbox(figure.canvas.get_renderer())
    width, height = figure.get_size_inches()
    return max(-drawn.x0, -drawn.y0, drawn.x1 - width, drawn.y1 - height)


def overlapping_texts(figure: Figure) -> list[tuple[str, str]]:
    """Find pairs of texts of flat panels that overlap; slanted texts do not count."""
    figure.draw_without_rendering()
    panels = [each for each in figure.axes if not hasattr(each, "get_zlabel")]
    unseen = {
        tick.label1
        for axis in (axis for each in panels for axis in (each.xaxis, each.yaxis))
        for tick in axis.get_major_ticks()
        if not min(axis.get_view_interval()) <= tick.get_loc() <= max(axis.get_view_interval())
    }
    texts = [each for part in (*panels, *figure.legends) for each in part.findobj(Text)]
    boxes = [
        (each.get_text(), each.get_window_extent())
        for each in texts
        if each.get_visible() and each.get_text() and each.get_rotation() % 90 == 0
        if each not in unseen
    ]
    return [
        (name, other)
        for i, (name, box) in enumerate(boxes)
        for other, second in boxes[:i]
        if min(box.x1, second.x1) - max(box.x0, second.x0) > 1
        and min(box.y1, second.y1) - max(box.y0, second.y0) > 1
    ]
