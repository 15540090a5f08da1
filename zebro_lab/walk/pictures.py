# SPDX-License-Identifier: MIT
"""Pictures of a walk folder."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

from model.gait.cyclic import CyclicReference
from model.poses import Poses
from model.robot import Robot
from model.slip.curve import SlipCurve
from model.walk.ground import FLAT, Ground
from model.walk.path import WalkPath
from model.walk.slip import Slip
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.files.source_names import is_simulated
from zebro_lab.walk.contacts import WalkContacts
from zebro_lab.walk.folder import BAND_PICTURE, CONTACTS_PICTURE
from zebro_lab.walk.output_request import PictureRequest
from zebro_lab.walk.shown_time import part_in

_Drawers: TypeAlias = dict[str, tuple[str, Callable[..., Any], WalkPath]]
"""Pictures by name: what they show, the function that draws them, and of what part of a walk."""


def draw_walk(
    folder: Path,
    path: WalkPath,
    robot: Robot,
    *,
    title: str,
    asked: PictureRequest,
    gait: CyclicReference | None = None,
    slip: Slip | None = None,
    ground: Ground = FLAT,
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
        gait: The gait, whose touchdown and lift-off are drawn; None for a log or a program.
        slip: The slip law, which is drawn if it is a curve; None for a model without.
        ground: The ground, drawn below the path and the snapshots.

    Raises:
        SettingsError: The window is not in the walk.
    """
    from model.thesis.path import ThesisPath
    from zebro_lab.plots import (  # matplotlib takes most of a second
        save,
        slip_law,
        walk_path,
        walk_scene,
        walk_stance,
    )

    end = part_in(path, asked.window)
    drawers = _over_time(end, path if asked.window is None else end)
    if isinstance(path, ThesisPath):
        drawers |= _of_the_thesis(end, kinematic=path.is_kinematic)
    figures = {
        name: draw(part, title=f"{what}: {title}") for name, (what, draw, part) in drawers.items()
    }
    figures["path"] = walk_path.path_with_snapshots(
        path, robot, title=f"Path: {title}", at=asked.snapshots, ground=ground
    )
    figures["snapshots"] = walk_scene.snapshots(
        path, robot, title=f"Snapshots: {title}", at=asked.snapshots, ground=ground
    )
    if gait is not None:
        figures["stances"] = walk_stance.stances(gait, robot, title=f"Stances: {title}")
    if slip is not None and isinstance(slip.law, SlipCurve):
        figures["slip_law"] = slip_law.slip_law(
            slip.law, title=f"Slip law: {title}", simulated=is_simulated(slip.source)
        )
    for name, figure in figures.items():
        save(figure, folder / f"{name}.{asked.form}")


def _over_time(end: WalkPath, whole: WalkPath) -> _Drawers:
    """Return the pictures over time of every walk: legs of its end, the body's motion of it all."""
    from zebro_lab.plots import walk_contacts, walk_legs, walk_path

    return {
        "motion": ("Motion of the body", walk_path.motion, whole),
        "orientation": ("Orientation of the body", walk_path.orientation, whole),
        "slip_ratio": ("Slip ratios", walk_legs.slip_ratios, end),
        "normal_force": ("Normal forces", walk_legs.normal_forces, end),
        "traction_force": ("Traction forces", walk_legs.traction_forces, end),
        "leg_angles": ("Leg angles", walk_legs.leg_angles, end),
        "gantt": ("Contact", walk_contacts.gantt, end),
    }


def _of_the_thesis(part: WalkPath, *, kinematic: bool) -> _Drawers:
    """Return the pictures of `THESIS_PICTURES`, of a part of a walk by the thesis's model.

    Those of its dynamics of tripods, hip heights by side and static loads, only if it walked them.
    """
    from zebro_lab.plots import walk_thesis

    dynamics = {} if kinematic else {
        "hip_height": ("Hip heights", walk_thesis.hip_heights, part),
        "static_load": ("Normal forces and static loads", walk_thesis.static_loads, part),
        "paired_traction": (
            "Sums of traction over pairs of time steps", walk_thesis.paired_traction, part
        ),
    }  # fmt: skip
    return {
        "coordinates": ("Coordinates of the model", walk_thesis.coordinates, part),
        "lowest_angle": ("Lowest points of the legs", walk_thesis.lowest_angles, part),
        "contact_velocity": ("Speeds of legs and ground", walk_thesis.contact_velocities, part),
        **dynamics,
    }


def draw_contacts(
    folder: Path, path: WalkPath, contacts: WalkContacts, *, title: str, asked: PictureRequest
) -> None:
    """Draw the contact states in the last two cycles of walking, or in the window of time.

    Args:
        folder: Folder to write the picture into.
        path: The walk.
        contacts: Its contact states.
        title: Gait and model.
        asked: Format, and window of time.

    Raises:
        SettingsError: The window is not in the walk.
    """
    from zebro_lab.plots import save  # matplotlib takes most of a second
    from zebro_lab.plots.walk_contacts import contact_states_chart

    shown = part_in(path, asked.window)
    figure = contact_states_chart(
        path, contacts.sequence.states, (float(shown.t[0]), float(shown.t[-1])),
        title=f"Contact states: {title}",
    )  # fmt: skip
    save(figure, folder / f"{CONTACTS_PICTURE}.{asked.form}")


def draw_band(
    folder: Path, paths: Poses, *, title: str, form: PictureFormat, ground: Ground = FLAT
) -> None:
    """Draw the band of a predicted path.

    Args:
        folder: Folder to write the picture into.
        paths: Draws of the path.
        title: Gait and model.
        form: Format of the picture.
        ground: The ground, which is drawn below the paths.
    """
    from zebro_lab.plots import path_validation, save  # matplotlib takes most of a second

    figure = path_validation.path_band(paths, title=f"Predicted path: {title}", ground=ground)
    save(figure, folder / f"{BAND_PICTURE}.{form}")
