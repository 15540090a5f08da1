# SPDX-License-Identifier: MIT
"""3-D animation of the walking robot: mp4 if ffmpeg is installed, else gif."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Line3D, Line3DCollection, Poly3DCollection
from numpy.typing import NDArray

from model.robot import N_LEGS, Robot
from model.slip.law import Array
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import BLUE, RED, new_figure, styled
from zebro_lab.plots.walk_robot import FACES, body_corners, leg_arcs, to_world

FRAME_RATE = 20  # frames a second
_MOST_FRAMES = 400  # a longer walk is shown faster
_VIEW = 0.55  # side of the ground that is seen [m]
_GRID = 0.05  # distance of the lines on the ground [m]
_ABOVE = 0.25  # of the view: height of the box that is drawn
_IN_AIR = "0.35"


@styled
def animate(
    path: WalkPath,
    robot: Robot,
    folder: Path,
    *,
    title: str,
    progress: Callable[[float], None] = lambda _: None,
) -> Path:
    """Write an animation of the walking robot; the camera follows the body over a fixed grid.

    Args:
        path: The walk: poses, leg angles and contacts over time.
        robot: The robot, for the size of body and legs.
        folder: Folder to write `animation.mp4` (with ffmpeg on the search path) or
            `animation.gif` into.
        title: Title of the animation, which names the model; "(simulated)" is appended.
        progress: Called with the fraction drawn, 0 to 1 [-].

    Returns:
        The file written. In contact a leg is orange, in the air grey. A walk longer than 20 s, 400
        frames, is shown faster, with the factor written in the picture.
    """
    frames, speed_up = frame_times(path.t)
    index = np.searchsorted(path.t, frames).clip(0, len(path.t) - 1)
    writer, name = _writer()
    figure = new_figure(title, True, width=6.4, height=4.0)
    figure.set_dpi(100)
    scene = _Scene(figure, path, robot, speed_up)
    with writer.saving(figure, str(folder / name), dpi=100):
        for number, sample in enumerate(index, start=1):
            scene.show(int(sample))
            writer.grab_frame()
            progress(number / len(index))
    return folder / name


def frame_times(t: Array) -> tuple[Array, float]:
    """Compute the times of the frames, 20 per second of the animation, 1 to 400 in number.

    Args:
        t: Times of the walk, shape (n,) [s].

    Returns:
        Times of the frames, evenly spaced [s], and walk time over animation time, 1 or more [-].

    >>> frames, speed_up = frame_times(np.linspace(0, 40, 1000))
    >>> len(frames), speed_up
    (400, 2.0)
    """
    duration = float(t[-1] - t[0])
    count = int(np.clip(round(duration * FRAME_RATE), 1, _MOST_FRAMES))
    speed_up = max(1.0, duration * FRAME_RATE / _MOST_FRAMES)
    return t[0] + np.arange(count) * speed_up / FRAME_RATE, speed_up


def _writer() -> tuple[AbstractMovieWriter, str]:
    if FFMpegWriter.isAvailable():
        return FFMpegWriter(fps=FRAME_RATE, codec="h264", bitrate=-1,
                            extra_args=["-pix_fmt", "yuv420p"]), "animation.mp4"  # fmt: skip
    return PillowWriter(fps=FRAME_RATE), "animation.gif"


class _Scene:
    """Artists of the animation, created once and updated for every frame."""

    def __init__(self, figure: Figure, path: WalkPath, robot: Robot, speed_up: float) -> None:
        self._path, self._robot = path, robot
        self._pace = "" if speed_up == 1 else f"   {speed_up:.2g}× real time"
        figure.set_layout_engine("none")
        figure.texts[0].set_y(0.96)
        beyond = (0.0, -0.2, 1.0, 1.35)  # 3-D axes leave much of their square empty
        self._axes = cast("Axes3D", figure.add_axes(beyond, projection="3d", computed_zorder=False))
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
            collection.set_clip_on(False)
            self._axes.add_collection3d(collection, autolim=False)
        self._head = self._line(color=RED, lw=2.5, zorder=5)
        self._clock = figure.text(0.03, 0.04, "")

    def show(self, sample: int) -> None:
        """Update body, head, legs, trace, ground and clock to the path's sample of this index.

        The trace is the path up to this sample, as far as it lies within the view.
        """
        path = self._path
        position, orientation = path.position[sample], path.orientation[sample]
        corners = to_world(body_corners(self._robot), position, orientation)
        self._body.set_verts([corners[list(face)] for face in FACES])
        self._head.set_data_3d(*corners[[5, 7]].T)
        arcs = to_world(leg_arcs(self._robot, path.theta[sample]), position, orientation)
        self._show_legs(arcs, path.contact[sample], float(orientation[2]))
        walked = path.position[: sample + 1] * [1.0, 1.0, 0.0]
        near = np.abs(walked[:, :2] - position[:2]).max(axis=1) < _VIEW / 2
        self._trace.set_data_3d(*np.where(near[:, None], walked, np.nan).T)
        self._show_ground(position)
        self._clock.set_text(f"t = {path.t[sample]:.2f} s{self._pace}")

    def _line(self, **style: Any) -> Line3D:
        return cast("Line3D", self._axes.plot([], [], [], **style)[0])

    def _show_legs(self, arcs: Array, contact: NDArray[np.bool_], yaw: float) -> None:
        colours = np.where(contact, RED, _IN_AIR)
        towards = np.radians(self._axes.azim) - yaw  # the camera, seen from the body
        sides = np.where(self._robot.hips[:, 1] > 0, 1.0, -1.0)
        in_front = sides * np.sin(towards) > 0
        for collection, chosen in ((self._far, ~in_front), (self._near, in_front)):
            legs = [leg for leg in range(N_LEGS) if chosen[leg]]
            collection.set_segments([arcs[leg] for leg in legs])
            collection.set_color([str(colours[leg]) for leg in legs])

    def _show_ground(self, position: Array) -> None:
        low, high = position[:2] - _VIEW / 2, position[:2] + _VIEW / 2
        lines = []
        for axis in (0, 1):
            for at in np.arange(np.ceil(low[axis] / _GRID), high[axis] / _GRID) * _GRID:
                line = np.zeros((2, 3))
                line[:, axis] = at
                line[:, 1 - axis] = low[1 - axis], high[1 - axis]
                lines.append(line)
        self._grid.set_segments(lines)
        self._axes.set(
            xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(0, _ABOVE * _VIEW)
        )  # fmt: skip
