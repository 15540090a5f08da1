# SPDX-License-Identifier: MIT
"""Write a finished walk: the walk folder with path, band and the requested pictures."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from model.robot import Robot
from model.tasks import Watcher
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.files.provenance import file_hashes
from zebro_lab.terminal.picture_options import Window
from zebro_lab.walk.band import band_settings
from zebro_lab.walk.contacts import write_contacts, write_touchdowns
from zebro_lab.walk.folder import (
    CONTACTS_CSV,
    THESIS_CSV,
    TOUCHDOWNS_CSV,
    walk_folder,
    write_draws,
)
from zebro_lab.walk.request import ModelRequest, PictureRequest
from zebro_lab.walk.walking import Walked


class WalkStopped(ZebroLabError):
    """A walk was stopped on request before it was written completely; nothing is left of it."""


def write_walk(
    out: Path,
    request: ModelRequest,
    walked: Walked,
    watcher: Watcher,
    *,
    kind: str,
    settings: Mapping[str, object],
    files: tuple[Path, ...] = (),
) -> None:
    """Write the walk folder: path, manifest, band, and the requested pictures and animation.

    Args:
        out: Folder to write.
        request: Settings of the band, and which pictures to draw.
        walked: The finished walk.
        watcher: Receives progress, and may request a stop.
        kind: Command that writes the folder: "walk" or "predict".
        settings: Settings other than model, robot, slip and band, JSON-serialisable.
        files: Files read other than those of robot and slip.

    Raises:
        AlreadyExists, NotWritten: As in `walk_folder`.
        WalkStopped: A stop was requested before pictures are drawn, or during the animation;
            nothing was written.
    """
    everything = {
        **walked.settings,
        "contact_by": walked.contact_by,
        "robot": _robot_settings(walked.described.robot),
        "walks": None if walked.informed is None else walked.informed.settings(),
        **settings,
        **({} if walked.band is None else {"band": band_settings(request.band, walked.informed)}),
    }
    source, inputs = f"sim:{walked.model}", file_hashes([*files, *walked.files])
    with walk_folder(
        out, walked.path, kind=kind, source=source, settings=everything, inputs=inputs
    ) as folder:
        if walked.model == "thesis":  # its package takes most of a second
            from zebro_lab.walk.thesis_file import write_thesis

            write_thesis(folder / THESIS_CSV, walked.path, walked.described.robot)
        _draw(_shown(request.pictures, walked), walked, folder, watcher)
        if walked.contacts is not None:
            write_contacts(folder / CONTACTS_CSV, walked.contacts)
            write_touchdowns(folder / TOUCHDOWNS_CSV, walked.contacts.touchdowns)
        if walked.band is not None:
            write_draws(folder, walked.band)


def _draw(request: PictureRequest, walked: Walked, folder: Path, watcher: Watcher) -> None:
    """Draw figures, contact states, band and animation, as far as requested and computed."""
    _raise_if_stopped(watcher)
    if request.figures or walked.contacts is not None or walked.band is not None:
        from zebro_lab.walk import pictures  # matplotlib takes most of a second

        if request.figures:
            watcher.step("drawing", None)
            pictures.draw_walk(folder, walked, request)
        pictures.draw_contacts(folder, walked, request)
        pictures.draw_band(folder, walked, request)
    if request.animate:
        from zebro_lab.plots.animation import animate

        def follow(fraction: float) -> None:
            """Show the share that is drawn; raise `WalkStopped` if a stop is requested."""
            watcher.step("filming", fraction)
            _raise_if_stopped(watcher)

        animate(
            walked.path, walked.described.robot, folder, title=walked.title, progress=follow,
            ground=walked.heights,
        )  # fmt: skip


def _shown(request: PictureRequest, walked: Walked) -> PictureRequest:
    """Return the pictures to draw; without a window, pictures of a program show the whole walk."""
    t, drawn = walked.path.t, request.figures or request.contacts
    if request.window is not None or not (drawn and walked.segments):
        return request
    return replace(request, window=Window(float(t[0]), float(t[-1])))


def _raise_if_stopped(watcher: Watcher) -> None:
    """Raise `WalkStopped` if the watcher requests a stop."""
    if watcher.stop_requested():
        raise WalkStopped("stopped; nothing was written")


def _robot_settings(robot: Robot) -> dict[str, object]:
    """Return the robot for the manifest, in SI, as `robot_of_walk` reads it."""
    return {
        "mass": robot.mass,
        "body_size": list(robot.body_size),
        "inertia": robot.principal_inertia.tolist(),
        "leg_radius": robot.leg_radius,
        "leg_arc": robot.leg_arc,
        "leg_offset": robot.leg_offset.tolist(),
        "hips": robot.hips.tolist(),
    }
