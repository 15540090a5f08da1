# SPDX-License-Identifier: MIT
"""Picture of a validated trajectory: both paths from above, and errors over time."""

import numpy as np
from matplotlib.figure import Figure

from model.metrics.path_errors import pose_errors
from zebro_lab.files.source_names import is_simulated
from zebro_lab.plots.sheet import BLUE, RED, legend_below, map_and_panels, styled
from zebro_lab.validation.trajectories.pair import JudgedPair

_PANELS = ("distance [m]", "yaw error [deg]")


@styled
def trajectories(judged: JudgedPair) -> Figure:
    """Draw reference, estimate and aligned estimate in the plane; distances and yaw errors.

    Args:
        judged: The errors.

    Returns:
        The figure; times count from the first matched pose [s], or are numbers of poses.
    """
    track, estimate, row = judged.tracked, judged.estimated, judged.rows[0]
    figure, above, panels = map_and_panels(
        judged.title,
        simulated=is_simulated(judged.source), height=5.0, names=_PANELS,
    )  # fmt: skip
    aligned = row.errors.alignment.apply(row.estimate.position)
    above.plot(*track.position.T, color="black", lw=1.6, label="reference")
    t = track.t - track.t[0]
    for name, position, colour in (
        ("estimate", estimate.position, RED), ("estimate, aligned", aligned, BLUE),
    ):  # fmt: skip
        above.plot(*position.T, color=colour, lw=0.9, label=name)
        distance = np.linalg.norm(position - track.position, axis=1)
        panels[0].plot(t, distance, color=colour, lw=0.9, label=name)
    if estimate.has_yaw and track.has_yaw:
        turned = np.degrees(pose_errors(estimate, track).rotation)
        panels[1].plot(t, turned, color=RED, lw=0.9, label="estimate")
    first, second = judged.reference.plane
    above.set(xlabel=f"{first} [m]", ylabel=f"{second} [m]")
    panels[-1].set_xlabel("time [s]" if judged.reference.timed else "number of the pose")
    legend_below(figure, columns=3)
    return figure
