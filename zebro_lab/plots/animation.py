# SPDX-License-Identifier: MIT
"""3-D animation of the walking robot: mp4 if ffmpeg is installed, else gif."""

from collections.abc import Callable
from pathlib import Path
from typing import cast

import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from mpl_toolkits.mplot3d import Axes3D

from model.arrays import Array
from model.robot import Robot
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from zebro_lab.plots.sheet import new_figure, styled
from zebro_lab.plots.walk_scene import WalkScene

FRAME_RATE = 20  # frames a second
_MOST_FRAMES = 400  # a longer walk is shown faster


@styled
def animate(
    path: WalkPath,
    robot: Robot,
    folder: Path,
    *,
    title: str,
    progress: Callable[[float], None] = lambda _: None,
    ground: Ground = FLAT,
) -> Path:
    """Write an animation of the walking robot; the camera follows the body over a fixed grid.

    Args:
        path: The walk: poses, leg angles and contacts over time.
        robot: The robot, for the size of body and legs.
        folder: Folder to write `animation.mp4` (with ffmpeg on the search path) or
            `animation.gif` into.
        title: Title of the animation, which names the model; "(simulated)" is appended.
        progress: Called with the fraction drawn, 0 to 1 [-].
        ground: The ground, on which the grid lies.

    Returns:
        The file written. In contact a leg is orange, in the air grey. A walk longer than 20 s, 400
        frames, is shown faster, with the factor written in the picture.
    """
    frames, speed_up = frame_times(path.t)
    index = np.searchsorted(path.t, frames).clip(0, len(path.t) - 1)
    writer, name = _writer()
    figure = new_figure(title, True, width=6.4, height=4.0)
    figure.set_dpi(100)
    figure.set_layout_engine("none")
    figure.texts[0].set_y(0.96)
    beyond = (0.0, -0.2, 1.0, 1.35)  # 3-D axes leave much of their square empty
    axes = cast("Axes3D", figure.add_axes(beyond, projection="3d", computed_zorder=False))
    scene = WalkScene(axes, path, robot, ground=ground)
    pace = "" if speed_up == 1 else f"   {speed_up:.2g}× real time"
    clock = figure.text(0.03, 0.04, "")
    with writer.saving(figure, str(folder / name), dpi=100):
        for number, sample in enumerate(index, start=1):
            scene.show(int(sample))
            clock.set_text(f"t = {path.t[sample]:.2f} s{pace}")
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
    """Return a writer and the file's name: mp4 if ffmpeg is installed, else gif."""
    if FFMpegWriter.isAvailable():
        return FFMpegWriter(fps=FRAME_RATE, codec="h264", bitrate=-1,
                            extra_args=["-pix_fmt", "yuv420p"]), "animation.mp4"  # fmt: skip
    return PillowWriter(fps=FRAME_RATE), "animation.gif"
