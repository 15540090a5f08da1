# SPDX-License-Identifier: MIT
"""Pictures of a walk folder."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from model.gait.cyclic import CyclicReference
from model.slip.curve import SlipCurve
from model.thesis.path import ThesisPath
from zebro_lab.files.source_names import is_simulated
from zebro_lab.plots import save, slip_law, walk_legs, walk_path, walk_thesis
from zebro_lab.plots.path_validation import path_band
from zebro_lab.plots.walk_contacts import contact_states_chart, gantt
from zebro_lab.plots.walk_scene import snapshots
from zebro_lab.plots.walk_stance import stances
from zebro_lab.walk.folder import BAND_PICTURE, CONTACTS_PICTURE
from zebro_lab.walk.request import PictureRequest
from zebro_lab.walk.shown_time import part_in
from zebro_lab.walk.walking import Walked

_MOTION = {
    "motion": ("Motion of the body", walk_path.motion),
    "orientation": ("Orientation of the body", walk_path.orientation),
}
"""Pictures over time by name, with what they show: of all of a walk, or of a window."""
_LEGS = {
    "slip_ratio": ("Slip ratios", walk_legs.slip_ratios),
    "normal_force": ("Normal forces", walk_legs.normal_forces),
    "traction_force": ("Traction forces", walk_legs.traction_forces),
    "leg_angles": ("Leg angles", walk_legs.leg_angles),
    "gantt": ("Contact", gantt),
}
_THESIS = {
    "coordinates": ("Coordinates of the model", walk_thesis.coordinates),
    "lowest_angle": ("Lowest points of the legs", walk_thesis.lowest_angles),
    "contact_velocity": ("Speeds of legs and ground", walk_thesis.contact_velocities),
}
_THESIS_DYNAMICS = {
    "hip_height": ("Hip heights", walk_thesis.hip_heights),
    "static_load": ("Normal forces and static loads", walk_thesis.static_loads),
    "paired_traction": ("Sums of traction over pairs of time steps", walk_thesis.paired_traction),
}


def draw_walk(folder: Path, walked: Walked, request: PictureRequest) -> None:
    """Draw path, snapshots, motion, orientation, slip, forces, leg angles and contacts of a walk.

    Slip, forces, angles and contacts are drawn for the last two cycles of walking, when the walk is
    steady; in a window of time, if one is asked for, together with motion and orientation. There
    are further pictures of the legs at touchdown and lift-off for a cyclic gait, of the slip law if
    it is a curve, and of its own quantities for the thesis's model.

    Args:
        folder: Folder to write the pictures into.
        walked: The walk, whose title is appended to the name of each picture.
        request: Format, times of snapshots and window of time.

    Raises:
        SettingsError: The window is not in the walk.
    """
    path, robot, title, slip = walked.path, walked.described.robot, walked.title, walked.slip
    end = part_in(path, request.window)
    whole = path if request.window is None else end
    drawers: dict[str, tuple[str, Callable[..., Any]]] = {**_MOTION, **_LEGS}
    if isinstance(path, ThesisPath):
        drawers |= _THESIS if path.is_kinematic else {**_THESIS, **_THESIS_DYNAMICS}
    figures = {
        name: draw(whole if name in _MOTION else end, title=f"{what}: {title}")
        for name, (what, draw) in drawers.items()
    }
    for name, what, draw in (
        ("path", "Path", walk_path.path_with_snapshots), ("snapshots", "Snapshots", snapshots),
    ):  # fmt: skip
        figures[name] = draw(
            path, robot, title=f"{what}: {title}", at=request.snapshots, ground=walked.heights
        )
    if isinstance(walked.reference, CyclicReference):
        figures["stances"] = stances(walked.reference, robot, title=f"Stances: {title}")
    if slip is not None and isinstance(slip.law, SlipCurve):
        figures["slip_law"] = slip_law.slip_law(
            slip.law, title=f"Slip law: {title}", simulated=is_simulated(slip.source)
        )
    for name, figure in figures.items():
        save(figure, folder / f"{name}.{request.form}")


def draw_contacts(folder: Path, walked: Walked, request: PictureRequest) -> None:
    """Draw the contact states in the last two cycles of walking, or in the window of time.

    Args:
        folder: Folder to write the picture into.
        walked: The walk; nothing is drawn of one without contact states.
        request: Format, and window of time.

    Raises:
        SettingsError: The window is not in the walk.
    """
    if walked.contacts is None:
        return
    t = part_in(walked.path, request.window).t
    figure = contact_states_chart(
        walked.path, walked.contacts.sequence.states, (float(t[0]), float(t[-1])),
        title=f"Contact states: {walked.title}",
    )  # fmt: skip
    save(figure, folder / f"{CONTACTS_PICTURE}.{request.form}")


def draw_band(folder: Path, walked: Walked, request: PictureRequest) -> None:
    """Draw the band of a predicted path.

    Args:
        folder: Folder to write the picture into.
        walked: The walk; nothing is drawn of one without a band.
        request: Format of the picture.
    """
    if walked.band is not None:
        title = f"Predicted path: {walked.title}"
        figure = path_band(walked.band, title=title, ground=walked.heights)
        save(figure, folder / f"{BAND_PICTURE}.{request.form}")
