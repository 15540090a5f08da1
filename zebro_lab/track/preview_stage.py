# SPDX-License-Identifier: MIT
"""Preview of a track: detections in the first photograph, its scale, and a check of the tape."""

from dataclasses import dataclass
from io import BytesIO
from itertools import combinations
from pathlib import Path

import numpy as np

from tracking import Scene
from tracking.camera import CameraPose, to_floor
from tracking.detect import Detection
from tracking.floor import FloorFit, FloorView, refine_floor
from tracking.images import read_pixels
from tracking.photos.search import Wanted, look_at
from tracking.pose import fit_pose
from zebro_lab.files.atomic import atomic_write_bytes
from zebro_lab.files.errors import DataError
from zebro_lab.files.own_file import picture, require_own
from zebro_lab.track.inputs import read_inputs
from zebro_lab.track.photo_sequence import open_photos
from zebro_lab.track.pictures import draw_preview
from zebro_lab.track.request import TrackRequest

PREVIEW = picture("track --preview")
_FAR = 4e-3  # disagreement of tape and picture worth a warning [m]


@dataclass(frozen=True)
class TapeCheck:
    """Distance between two marks of the floor, by tape and by photograph.

    Attributes:
        marks: Their names.
        tape: Between their places in the map [m].
        seen: Between where the photograph shows them [m].
    """

    marks: tuple[str, str]
    tape: float
    seen: float

    @property
    def is_off(self) -> bool:
        """Return whether tape and photograph disagree."""
        return abs(self.seen - self.tape) > _FAR


@dataclass(frozen=True)
class Preview:
    """Detections, scale and tape checks of the first photograph.

    Attributes:
        file: The picture that was drawn.
        photo: Name of the photograph.
        marks: Marks of the floor that are seen.
        unseen: Marks of the floor that are not.
        camera_height: Height of the camera over the floor [m].
        misfit_px: Distance of marks from where the map has them, root mean square [px].
        scale: Size of a pixel on the floor in the middle of the marks [m/px].
        robot: x, y [m] and yaw [rad] of the robot, shape (3,); None where its marker is not seen.
        robot_side_px: Side of its marker in the photograph [px].
        tape: Tape checks of all pairs.
    """

    file: Path
    photo: str
    marks: tuple[str, ...]
    unseen: tuple[str, ...]
    camera_height: float
    misfit_px: float
    scale: float
    robot: tuple[float, float, float] | None
    robot_side_px: float | None
    tape: tuple[TapeCheck, ...]


def preview(request: TrackRequest, file: Path) -> Preview:
    """Detect marks in the first photograph and draw them.

    Args:
        request: Options of the track.
        file: The PNG to write.

    Raises:
        ZebroLabError: A file or an option is invalid.
        TrackingError: The floor's map does not fit.
    """
    target = require_own(file, PREVIEW, inputs=request.inputs)
    inputs = read_inputs(request)
    with open_photos(request.photos, request.times, frames=1) as sequence:
        scene = inputs.scene_of(sequence)
        photo = sequence.photos[0]
        robot = None if sequence.is_composite else scene.robot
        look = look_at(photo, Wanted(scene.camera.size, scene.floor, robot))
        if look.seen is None:
            raise DataError(f"{photo.name}: {look.problem}")
        view = scene.with_clicks(look.seen.floor)
        fit = refine_floor(scene.camera, scene.floor, [view])
        drawn = BytesIO()
        draw_preview(
            drawn, read_pixels(photo.path), camera=scene.camera, view=fit.stands[0].pose,
            floor=scene.floor, detection=look.seen, title=f"Preview: {photo.name}",
            simulated=inputs.source_of(sequence).startswith("sim:"), command=PREVIEW.command,
        )  # fmt: skip
        atomic_write_bytes(target, drawn.getvalue())
        return _preview(file, scene, look.seen, view, fit)


def _preview(
    file: Path, scene: Scene, detection: Detection, view: FloorView, fit: FloorFit
) -> Preview:
    pose = fit.stands[0].pose
    seen = [key for key in scene.floor.marks if key in view.pixels]
    middle = np.mean([view.pixels[key].mean(axis=0) for key in seen], axis=0)
    ends = to_floor(scene.camera, pose, np.add(middle, [[-0.5, 0.0], [0.5, 0.0]]))
    robot = _robot(scene, detection, pose)
    side = None
    if detection.robot is not None:
        corners = detection.robot.corners_px
        side = float(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).mean())
    return Preview(
        file, detection.photo, tuple(map(str, seen)),
        tuple(str(key) for key in scene.floor.marks if key not in view.pixels),
        float(pose.position[2]), fit.misfit_px, float(np.linalg.norm(ends[1] - ends[0])),
        robot, side, _tape_checks(scene, view, pose),
    )  # fmt: skip


def _robot(
    scene: Scene, detection: Detection, pose: CameraPose
) -> tuple[float, float, float] | None:
    if scene.robot is None or detection.robot is None:
        return None
    marker = scene.robot.marker
    found = fit_pose(
        scene.camera, pose, points_body=marker.points_body, corners_px=detection.robot.corners_px,
        covariance=detection.robot.covariance, prior=scene.prior,
        scale_sd=marker.side_sd / marker.side,
    )  # fmt: skip
    x, y, yaw = found.planar.tolist()
    return x, y, yaw


def _tape_checks(scene: Scene, view: FloorView, pose: CameraPose) -> tuple[TapeCheck, ...]:
    places = {}
    for key, mark in scene.floor.marks.items():
        if key in view.pixels:
            seen = to_floor(scene.camera, pose, view.pixels[key], float(mark.points[0, 2]))
            places[str(key)] = (mark.points[:, :2].mean(axis=0), seen.mean(axis=0))
    return tuple(
        TapeCheck(
            (a, b),
            float(np.linalg.norm(places[a][0] - places[b][0])),
            float(np.linalg.norm(places[a][1] - places[b][1])),
        )
        for a, b in combinations(places, 2)
    )
