# SPDX-License-Identifier: MIT
"""Plot roll and pitch of a predicted walk with those measured by an IMU."""

import numpy as np
from matplotlib.figure import Figure

from model.arrays import Array
from zebro_lab.plots.sheet import BLUE, legend_below, new_figure, styled

_SHOWN = 6.0  # s: longer, and the strides run into each other


@styled
def tilt(t: Array, predicted: Array, measured: Array, *, title: str, simulated: bool) -> Figure:
    """Draw predicted and measured roll and pitch [deg] over the middle 6 s of the walk, or all.

    Args:
        t: Times, increasing, shape (n,) [s].
        predicted: Predicted roll and pitch, shape (n, 2) [rad].
        measured: Measured roll and pitch, shape (n, 2) [rad].
        title: Name of the walk.
        simulated: Whether to append "(simulated)" to the title.

    Returns:
        The figure; the IMU's bias is not removed.
    """
    figure = new_figure(f"Roll and pitch: {title}", simulated, width=8.5, height=4.6)
    middle = 0.5 * (t[0] + t[-1])
    shown = np.abs(t - middle) <= _SHOWN / 2
    names = ("roll [deg]\n(left side up)", "pitch [deg]\n(nose down)")
    panels = figure.subplots(2, 1, sharex=True)
    for axes, name, expected, seen in zip(panels, names, predicted.T, measured.T, strict=True):
        axes.plot(t[shown], np.degrees(seen[shown]), color="0.6", lw=0.9, label="IMU")
        axes.plot(t[shown], np.degrees(expected[shown]), color=BLUE, lw=1.2, label="predicted")
        axes.set_ylabel(name)
        axes.grid(color="0.92", lw=0.6)
    part = "" if shown.all() else f", the middle {_SHOWN:g} s of the walk"
    panels[-1].set_xlabel(f"time [s]{part}")
    figure.align_ylabels(panels)
    legend_below(figure, columns=2)
    return figure
