# SPDX-License-Identifier: MIT
"""The walking robot in 3-D over a grid on the ground, and a picture of it at some times."""

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3D, Line3DCollection, Poly3DCollection
from numpy.typing import NDArray

from model.arrays import Array
from model.robot import N_LEGS, Robot
from model.walk.ground import FLAT, Ground, height_and_slopes, is_level
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import BLUE, RED, new_figure, styled
from zebro_lab.plots.walk_path import snapshot_times
from zebro_lab.plots.walk_robot import FACES, body_corners, leg_arcs, to_world

_GRID = 0.05  # distance of the lines on the ground [m]
_FINE = 0.01  # distance of points of a line on ground that is not level [m]


def heights_along(ground: Ground, position: Array) -> Array:
    """Return places with the height of the ground there, shape (n, 3) [m].

    Args:
        ground: The ground.
        position: x and y of the places, shape (n, 2) [m].
    """
    if is_level(ground):
        height = np.full(len(position), ground.height[0, 0])
    else:
        height = np.array([height_and_slopes(ground, x, y)[0] for x, y in position])
    return np.column_stack([position, height])


def ground_lines(ground: Ground, low: Array, high: Array) -> list[Array]:
    """Return lines along x and y at each `_GRID` that lie on the ground, shape (m, 3) each [m].

    Args:
        ground: The ground.
        low: Smallest x and y, shape (2,) [m].
        high: Largest x and y, shape (2,) [m].
    """
    lines = []
    for axis in (0, 1):
        along = np.array([low[1 - axis], high[1 - axis]])
        if not is_level(ground):
            along = np.linspace(along[0], along[1], round(float(np.ptp(along)) / _FINE) + 1)
        for at in np.arange(np.ceil(low[axis] / _GRID), high[axis] / _GRID) * _GRID:
            place = np.empty((len(along), 2))
            place[:, axis], place[:, 1 - axis] = at, along
            lines.append(heights_along(ground, place))
    return lines


_VIEW = 0.55  # side of the ground that is seen [m]
_ABOVE = 0.25  # of the view: height of the box that is drawn
_IN_AIR = "0.35"


class WalkScene:
    """Artists of the robot over a grid on the ground, created once and updated for every sample.

    In contact a leg is orange, in the air grey.
    """

    def __init__(
        self, axes: Axes3D, path: WalkPath, robot: Robot, *, ground: Ground = FLAT
    ) -> None:
        """Create the artists in 3-D axes, which must not compute the order of drawing themselves.

        Args:
            axes: Axes to draw in.
            path: The walk.
            robot: The robot, for the size of body and legs.
            ground: The ground, on which the grid lies.
        """
        self._path, self._robot, self._ground = path, robot, ground
        self._walked = heights_along(ground, path.position[:, :2])
        self._axes = axes
        self._axes.set_axis_off()
        self._axes.view_init(elev=22, azim=-60)
        # matplotlib's default makes checkers think zoom an int
        self._axes.set_box_aspect((1, 1, _ABOVE), zoom=1.45)  # pyright: ignore[reportArgumentType]
        no_lines = np.zeros((1, 2, 3))
        self._grid = Line3DCollection(no_lines, colors="0.85", lw=0.7, zorder=0)
        self._trace = self._line(color=BLUE, lw=1.2, zorder=1)
        self._body = Poly3DCollection(
            np.zeros((len(FACES), 4, 3)), facecolors=(0.75, 0.8, 0.85, 0.55), edgecolors="0.2",
            lw=0.8, zorder=3,
        )  # fmt: skip
        # Legs on the far side of the body are drawn before it.
        self._far, self._near = (
            Line3DCollection(no_lines, lw=3.2, capstyle="round", zorder=z) for z in (2, 4)
        )
        for collection in (self._grid, self._far, self._body, self._near):
            self._axes.add_collection3d(collection, autolim=False)
        self._head = self._line(color=RED, lw=2.5, zorder=5)

    def show(self, sample: int) -> None:
        """Update body, head, legs, trace and ground to the path's sample of this index.

        The trace is the path up to this sample, as far as it lies within the view.
        """
        path = self._path
        position, orientation = path.position[sample], path.orientation[sample]
        corners = to_world(body_corners(self._robot), position, orientation)
        self._body.set_verts([corners[list(face)] for face in FACES])
        self._head.set_data_3d(*corners[[5, 7]].T)
        arcs = to_world(leg_arcs(self._robot, path.theta[sample]), position, orientation)
        self._show_legs(arcs, path.contact[sample], float(orientation[2]))
        walked = self._walked[: sample + 1]
        near = np.abs(walked[:, :2] - position[:2]).max(axis=1) < _VIEW / 2
        self._trace.set_data_3d(*np.where(near[:, None], walked, np.nan).T)
        self._show_ground(position)

    def _line(self, **style: Any) -> Line3D:
        """Add an empty line to the axes and return it; `show` sets its points."""
        return cast("Line3D", self._axes.plot([], [], [], **style)[0])

    def _show_legs(self, arcs: Array, contact: NDArray[np.bool_], yaw: float) -> None:
        """Draw legs on the camera's side over the body, the others behind it, by contact's colour.

        Args:
            arcs: Points along each leg in the inertial frame, shape (6, 25, 3) [m].
            contact: Whether each leg is on the ground, shape (6,).
            yaw: Yaw of the body [rad].
        """
        colours = np.where(contact, RED, _IN_AIR)
        towards = np.radians(self._axes.azim) - yaw  # the camera, seen from the body
        sides = np.where(self._robot.hips[:, 1] > 0, 1.0, -1.0)
        in_front = sides * np.sin(towards) > 0
        for collection, chosen in ((self._far, ~in_front), (self._near, in_front)):
            legs = [leg for leg in range(N_LEGS) if chosen[leg]]
            collection.set_segments([arcs[leg] for leg in legs])
            collection.set_color([str(colours[leg]) for leg in legs])

    def _show_ground(self, position: Array) -> None:
        """Draw the grid around the body, at `position` [m], and centre the view on it."""
        low, high = position[:2] - _VIEW / 2, position[:2] + _VIEW / 2
        self._grid.set_segments(ground_lines(self._ground, low, high))
        base = float(heights_along(self._ground, position[None, :2])[0, 2])
        self._axes.set(
            xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(base, base + _ABOVE * _VIEW)
        )  # fmt: skip


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
    for number, t in enumerate(wanted):
        place = grid[divmod(number, columns)]
        axes = cast("Axes3D", figure.add_subplot(place, projection="3d", computed_zorder=False))
        sample = int(np.abs(path.t - t).argmin())
        WalkScene(axes, path, robot, ground=ground).show(sample)
        legs = ", ".join(str(leg + 1) for leg in np.flatnonzero(path.contact[sample]))
        axes.set_title(f"t = {round(t, 2):g} s   {{{legs}}}", y=0.95)
    return figure
