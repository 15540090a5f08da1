# SPDX-License-Identifier: MIT
"""Preview of a track: detections in one photograph, its scale, and check of measured distances."""

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from tracking.camera import Camera, CameraPose, to_floor
from tracking.detect import Detection, observe
from tracking.errors import PhotoError
from tracking.floor import FloorFit, FloorView, refine_floor
from tracking.photos.floor_seen import FloorSeen
from tracking.photos.result import Tracked, finish
from tracking.photos.scene import Photo, Scene
from tracking.photos.search import Wanted, look_at

_FAR = 4e-3  # disagreement of tape and picture worth a warning [m]


@dataclass(frozen=True)
class TapeCheck:
    """Distance between two marks of the floor, by tape measure and by photograph.

    Attributes:
        marks: Marker numbers or point names of the two marks, as text.
        tape: Distance between their centres in x, y by the floor map, measured with a tape measure
            [m].
        seen: The same from the photograph, at the marks' heights by the map [m].
    """

    marks: tuple[str, str]
    tape: float
    seen: float

    @property
    def is_off(self) -> bool:
        """Return whether the distances by tape measure and by photograph differ by over 4 mm."""
        return abs(self.seen - self.tape) > _FAR


@dataclass(frozen=True)
class PhotoPreview:
    """Detections, scale and tape checks of a photograph.

    Attributes:
        detection: Markers detected in the photograph.
        camera: The camera with its lens as fitted to the floor.
        pose: Pose of the camera.
        marks: Numbers or names of the floor's marks that are detected or clicked.
        unseen: Numbers or names of the floor's marks that are not.
        misfit_px: Root mean square distance of the marks' points from their projection after the
            fit of floor and camera [px].
        scale: Size of a pixel on the floor at the middle of the marks [m/px].
        robot: x, y [m] and yaw [rad] of the robot, as a track of this photograph alone has them;
            None where its marker is not detected, or there is none.
        robot_side_px: Mean side of the robot's marker in the photograph [px]; None likewise.
        tape: Distance checks of all pairs of `marks`; empty for a single mark.
        warnings: Warnings, one sentence each, as of a track.
    """

    detection: Detection
    camera: Camera
    pose: CameraPose
    marks: tuple[str, ...]
    unseen: tuple[str, ...]
    misfit_px: float
    scale: float
    robot: tuple[float, float, float] | None
    robot_side_px: float | None
    tape: tuple[TapeCheck, ...]
    warnings: tuple[str, ...] = ()

    @property
    def photo(self) -> str:
        """Name of the photograph."""
        return self.detection.photo

    @property
    def camera_height(self) -> float:
        """Height of the camera over the floor [m]."""
        return float(self.pose.position[2])


def preview_photo(scene: Scene, photo: Photo) -> PhotoPreview:
    """Detect the marks of floor and robot in one photograph and check distances between marks.

    Args:
        scene: Camera, floor, clicked points and robot.
        photo: The photograph.

    Raises:
        PhotoError: Detection in the photograph failed (see `look_at`).
        TrackingError: The floor's map does not fit, or none or fewer than 4 of its points are seen.
    """
    look = look_at(photo, Wanted(scene.camera.size, scene.floor, scene.robot))
    if look.seen is None:
        raise PhotoError(photo.name, str(look.problem))
    view = scene.with_clicks(look.seen.floor)
    fit = refine_floor(scene.camera, scene.floor, [view])
    scene = replace(scene, camera=fit.camera)  # the pose of the camera is for this lens
    pose, marks = fit.stands[0].pose, scene.floor.marks
    seen = [key for key in marks if key in view.pixels]
    tracked = _tracked(scene, fit, look.seen)
    return PhotoPreview(
        look.seen, fit.camera, pose, tuple(map(str, seen)),
        tuple(str(key) for key in marks if key not in view.pixels),
        fit.misfit_px, _scale(scene, view, pose), None if tracked is None else _planar(tracked),
        None if look.seen.robot is None else _side_px(look.seen.robot.corners_px),
        _tape_checks(scene, view, pose), fit.warnings if tracked is None else tracked.notes,
    )  # fmt: skip


def _scale(scene: Scene, view: FloorView, pose: CameraPose) -> float:
    """Compute the width on the floor of a pixel at the mean position of the marks [m/px]."""
    seen = [view.pixels[key] for key in scene.floor.marks if key in view.pixels]
    middle = np.mean([pixels.mean(axis=0) for pixels in seen], axis=0)
    ends = to_floor(scene.camera, pose, np.add(middle, [[-0.5, 0.0], [0.5, 0.0]]))
    return float(np.linalg.norm(ends[1] - ends[0]))


def _side_px(corners_px: np.ndarray) -> float:
    """Compute the mean side of a quadrilateral (4, 2) [px]."""
    return float(np.linalg.norm(corners_px - np.roll(corners_px, 1, axis=0), axis=1).mean())


def _tracked(scene: Scene, fit: FloorFit, detection: Detection) -> Tracked | None:
    """Track the robot in this photograph alone; None where its marker is not detected."""
    if scene.robot is None or detection.robot is None:
        return None
    times = {detection.photo: (0.0, 0.0)}
    observations = observe(fit, [detection], robot=scene.robot, times=times)
    seen = FloorSeen(fit, (detection,), {})
    alone = replace(scene, corrections=())  # those are of photographs of a track
    return finish(alone, seen, observations, unseen={}, times=times, gap=None)


def _planar(tracked: Tracked) -> tuple[float, float, float]:
    """Return x, y [m] and yaw [rad] of the first pose of a track."""
    x, y, yaw = tracked.track.poses[0].tolist()
    return x, y, yaw


def _tape_checks(scene: Scene, view: FloorView, pose: CameraPose) -> tuple[TapeCheck, ...]:
    """Compare the distances of all pairs of marks seen, by the map and by the photograph."""
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
