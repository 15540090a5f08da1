# SPDX-License-Identifier: MIT
"""Plot the walking robot in 3-D at some times."""

from collections.abc import Sequence
from typing import cast

import numpy as np
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox, TransformedBbox
from mpl_toolkits.mplot3d import Axes3D

from model.robot import Robot
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import new_figure, styled, time_texts
from zebro_lab.plots.walk_path import snapshot_times
from zebro_lab.plots.walk_scene import Scene

_COLUMNS = 3
_WIDTH, _HEIGHT = 3.6, 2.3  # inches of a panel
_MARGINS, _BELOW = 0.8, 0.3  # inches above and below the panels, for title and sinking legs
_WIDER = (-0.16, -0.32, 1.32, 1.75)  # of a panel: 3-D axes leave much of their square empty


@styled
def snapshots(
    path: WalkPath,
    robot: Robot,
    *,
    title: str,
    at: Sequence[float] = (),
    ground: Ground = FLAT,
) -> Figure:
    """Draw the robot in 3-D at some times (Fig. 2-1 above, 5-20 to 5-22, 5-24 and 5-25).

    Args:
        path: The walk.
        robot: The robot, for the size of body and legs.
        title: Title of the figure, which names the model; "(simulated)" is appended.
        at: Times [s]; empty for six, evenly spaced from start to end.
        ground: The ground.

    Returns:
        The figure: a panel for each time, with the legs in contact named in its title and drawn in
        orange, those in the air grey; the head's edge is orange, too, and the path blue.
    """
    wanted = snapshot_times(path.t, at)
    rows = -(-len(wanted) // _COLUMNS)
    columns = min(len(wanted), _COLUMNS)
    figure = new_figure(
        title, True, width=max(_WIDTH * columns, 5.0), height=_MARGINS + _HEIGHT * rows
    )
    figure.set_layout_engine("none")
    free = _HEIGHT * rows / figure.get_figheight()
    below = _BELOW / figure.get_figheight()
    for number, (t, when) in enumerate(zip(wanted, time_texts(wanted), strict=True)):
        row, column = divmod(number, columns)
        width, height = 1.0 / columns, free / rows
        left, bottom = column * width, below + free - (row + 1) * height
        box = (left + _WIDER[0] * width, bottom + _WIDER[1] * height,
               _WIDER[2] * width, _WIDER[3] * height)  # fmt: skip
        axes = cast("Axes3D", figure.add_axes(box, projection="3d", computed_zorder=False))
        axes.patch.set_visible(False)
        sample = int(np.abs(path.t - t).argmin())
        scene = Scene(axes, path, robot, ground=ground)
        panel = Bbox.from_bounds(left, bottom, width, height)
        scene.clip_ground(TransformedBbox(panel, figure.transFigure))
        scene.show(sample)
        legs = ", ".join(str(leg + 1) for leg in np.flatnonzero(path.contact[sample]))
        figure.text(
            left + 0.03 * width, bottom + 0.9 * height, f"t = {when} s   {{{legs}}}", va="center",
            bbox={"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 1.0},
        )  # fmt: skip
    return figure
