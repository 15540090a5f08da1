# SPDX-License-Identifier: MIT
"""Pictures and animation of a walk folder."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from model.robot import Robot
from model.walk.path import WalkPath

_SHOWN_CYCLES = 2.0
_SHOWN_TIME = 4.0  # s, for a walk without a known cycle


def draw_walk(
    folder: Path, path: WalkPath, robot: Robot, *, title: str, period: float | None
) -> None:
    """Draw path, motion, orientation, slip ratios, forces and contacts of a walk as PNG files.

    Slip, forces and contacts are drawn for the last two cycles, when the walk is steady; for the
    last 4 s if the period is unknown.

    Args:
        folder: Folder to write the PNG files into.
        path: The walk.
        robot: The robot, whose outline is drawn on the path.
        title: Gait and model; appended to the name of each picture.
        period: Duration of a gait cycle [s]; None if unknown.
    """
    from zebro_lab.plots import save, walk_legs, walk_path  # matplotlib takes most of a second

    end = last_cycles(path, period)
    drawers: dict[str, tuple[str, Callable[..., Any], WalkPath]] = {
        "motion": ("Motion of the body", walk_path.motion, path),
        "orientation": ("Orientation of the body", walk_path.orientation, path),
        "slip_ratio": ("Slip ratios", walk_legs.slip_ratios, end),
        "normal_force": ("Normal forces", walk_legs.normal_forces, end),
        "traction_force": ("Traction forces", walk_legs.traction_forces, end),
        "paired_traction": ("Traction, pairs of time steps added", walk_legs.paired_traction, end),
        "gantt": ("Contact", walk_legs.gantt, end),
    }
    figures = {
        name: draw(part, title=f"{what}: {title}") for name, (what, draw, part) in drawers.items()
    }
    figures["path"] = walk_path.path_with_snapshots(path, robot, title=f"Path: {title}")
    for name, figure in figures.items():
        save(figure, folder / f"{name}.png")


def last_cycles(path: WalkPath, period: float | None) -> WalkPath:
    """Return the last two cycles of a walk, or 4 s if the period is unknown; two samples at least.

    Args:
        path: The walk.
        period: Duration of a gait cycle [s]; None if unknown.
    """
    shown = _SHOWN_TIME if period is None else _SHOWN_CYCLES * period
    first = int(np.searchsorted(path.t, path.t[-1] - shown - 1e-9))
    return path.part(slice(min(first, max(len(path.t) - 2, 0)), None))
