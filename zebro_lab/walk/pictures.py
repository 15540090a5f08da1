# SPDX-License-Identifier: MIT
"""Pictures of a walk folder."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from model.robot import Robot
from model.walk.path import WalkPath
from zebro_lab.walk.request import PictureRequest
from zebro_lab.walk.shown_time import part_in


def draw_walk(
    folder: Path, path: WalkPath, robot: Robot, *, title: str, asked: PictureRequest
) -> None:
    """Draw path, motion, orientation, slip ratios, forces, leg angles and contacts of a walk.

    Slip, forces, angles and contacts are drawn for the last two cycles of walking, when the walk is
    steady; in a window of time, if one is asked for, together with motion and orientation.

    Args:
        folder: Folder to write the pictures into.
        path: The walk.
        robot: The robot, whose outline is drawn on the path.
        title: Gait and model; appended to the name of each picture.
        asked: Format, times of snapshots and window of time.

    Raises:
        SettingsError: The window is not in the walk.
    """
    from zebro_lab.plots import save, walk_legs, walk_path  # matplotlib takes most of a second

    end = part_in(path, asked.window)
    whole = path if asked.window is None else end
    drawers: dict[str, tuple[str, Callable[..., Any], WalkPath]] = {
        "motion": ("Motion of the body", walk_path.motion, whole),
        "orientation": ("Orientation of the body", walk_path.orientation, whole),
        "slip_ratio": ("Slip ratios", walk_legs.slip_ratios, end),
        "normal_force": ("Normal forces", walk_legs.normal_forces, end),
        "traction_force": ("Traction forces", walk_legs.traction_forces, end),
        "paired_traction": (
            "Sums of traction over pairs of time steps",
            walk_legs.paired_traction,
            end,
        ),
        "leg_angles": ("Leg angles", walk_legs.leg_angles, end),
        "gantt": ("Contact", walk_legs.gantt, end),
    }
    figures = {
        name: draw(part, title=f"{what}: {title}") for name, (what, draw, part) in drawers.items()
    }
    figures["path"] = walk_path.path_with_snapshots(
        path, robot, title=f"Path: {title}", at=asked.snapshots
    )
    for name, figure in figures.items():
        save(figure, folder / f"{name}.{asked.form}")
