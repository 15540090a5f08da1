# SPDX-License-Identifier: MIT
"""Plot the walking robot in 3-D at some times."""

from collections.abc import Sequence
from typing import cast

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D

from model.robot import Robot
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import new_figure, styled, time_texts
from zebro_lab.plots.walk_path import snapshot_times
from zebro_lab.plots.walk_scene import WalkScene

_COLUMNS = 3
_WIDTH, _HEIGHT = 3.6, 2.6  # inches of a panel


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
    rows, columns = -(-len(wanted) // _COLUMNS), min(len(wanted), _COLUMNS)
    figure = new_figure(title, True, width=max(_WIDTH * columns, 5.0), height=0.5 + _HEIGHT * rows)
    figure.set_layout_engine("none")
    top = 1 - 0.6 / figure.get_figheight()
    grid = figure.add_gridspec(
        rows, columns, left=0.0, right=1.0, bottom=0.02, top=top, wspace=0.0, hspace=0.05
    )
    for number, (t, when) in enumerate(zip(wanted, time_texts(wanted), strict=True)):
        place = grid[divmod(number, columns)]
        axes = cast("Axes3D", figure.add_subplot(place, projection="3d", computed_zorder=False))
        sample = int(np.abs(path.t - t).argmin())
        WalkScene(axes, path, robot, ground=ground).show(sample)
        legs = ", ".join(str(leg + 1) for leg in np.flatnonzero(path.contact[sample]))
        axes.set_title(f"t = {when} s   {{{legs}}}", y=0.95)
    return figure
