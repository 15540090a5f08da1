# SPDX-License-Identifier: MIT
"""Track a robot through the exposures of one composite picture."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from tracking.body import AnnotatedPose
from tracking.camera import CameraPose
from tracking.composite import Exposure, find_exposures, find_exposures_like, order_exposures
from tracking.detect import MarkedRobot, pose_of_marker
from tracking.errors import CompositeError
from tracking.images import PhotoTimes, read_pixels
from tracking.markers import Sighting
from tracking.photos.by_look import marked_tops, pose_of_top
from tracking.photos.floor_seen import FloorSeen, see_floor
from tracking.photos.result import Tracked, finish, observation_of, times_by_name
from tracking.photos.scene import Photo, Scene
from tracking.photos.workers import Progress
from tracking.pose import BodyPose

_MANY_ROUGH = 1 / 3  # of a composite's exposures


def track_exposures(
    scene: Scene, photo: Photo, *, times_of: Callable[[Sequence[str]], PhotoTimes],
    gap: float | None, progress: Progress,
) -> Tracked:  # fmt: skip
    """Track a robot through the exposures of one composite picture.

    Exposures are named after the picture in order along the walk: `walk.jpg#1` is the first.

    Args:
        scene: Camera, floor and robot, which is found by its marker, or else its annotated top.
        photo: The picture.
        times_of: Function from the names of the exposures, in order, to their times.
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        progress: Receiver of progress and of requests to stop.

    Returns:
        The track; notes include a warning when a third of the exposures or more is rough.

    Raises:
        NoUsablePhoto: The picture cannot be used, or the annotated top is in another picture.
        TrackingError: There is neither marker nor annotated top, or the top cannot serve as
            template; no mark of the floor is seen or its map does not fit; `scene.body_size` is
            None; no exposure is found or left; two have the same time; or a correction is invalid.
        TrackStopped: A stop was requested.
    """
    seen = see_floor(scene, [photo], robot=None, workers=1, progress=progress)
    scene = replace(scene, camera=seen.fit.camera)  # the pose of the camera is for this lens
    progress.step("exposures", None)
    exposures = _exposures(scene, seen, photo)
    order = order_exposures(np.array([each.alignment.pose.planar for each in exposures]))
    names = tuple(f"{photo.name}#{number}" for number in range(1, len(order) + 1))
    times = times_by_name(names, times_of(names))
    annotated = None if scene.robot is not None else _annotated(scene, seen, photo)
    source = "marker" if annotated is None else "body"
    observations = [
        observation_of(
            name,
            exposures[k].alignment,
            times[name],
            source=source,
            annotated=None if annotated is None else (photo.name, annotated),
        )
        for name, k in zip(names, order, strict=True)
    ]
    tracked = finish(
        scene, seen, observations, unseen={}, times=times, gap=gap,
        annotations=None if annotated is None else {photo.name: annotated},
    )  # fmt: skip
    return replace(tracked, notes=(*tracked.notes, *_rough_note(exposures)))


def _exposures(scene: Scene, seen: FloorSeen, photo: Photo) -> tuple[Exposure, ...]:
    """Find exposures by the robot's marker, or without one by the look of the annotated exposure.

    Raises CompositeError if `scene.body_size` is None or none is found, and as `marked_tops`.
    """
    size = scene.body_size
    if size is None:
        raise CompositeError("the robot's body has no size; give body_size in robot.toml")
    pixels = read_pixels(photo.path, size=scene.camera.size)
    view = seen.fit.pose_of(photo.name)
    hidden = seen.marks_in(photo.name, pixels.shape[:2])
    if scene.robot is not None:
        return find_exposures(
            pixels, scene.camera, view, marker=scene.robot.marker,
            pose_of=partial(_pose_of, scene.robot, seen, view), prior=scene.prior, body_size=size,
            hidden=hidden,
        )  # fmt: skip
    top = marked_tops(scene, seen, [photo])[0]
    return find_exposures_like(
        pixels, scene.camera, view, known=pose_of_top(top, scene, view).pose, plate=top.plate,
        prior=scene.prior, body_size=size, hidden=hidden,
    )  # fmt: skip


def _pose_of(
    robot: MarkedRobot, seen: FloorSeen, view: CameraPose, sighting: Sighting
) -> BodyPose:  # fmt: skip
    """Fit the robot's pose to its marker in one exposure."""
    return pose_of_marker(seen.fit, view, sighting, robot)


def _annotated(scene: Scene, seen: FloorSeen, photo: Photo) -> AnnotatedPose:
    """Fit the pose of the annotated exposure to its clicks; raise as `marked_tops`."""
    return pose_of_top(marked_tops(scene, seen, [photo])[0], scene, seen.fit.pose_of(photo.name))


def _rough_note(exposures: Sequence[Exposure]) -> list[str]:
    """Warn if a third of the exposures or more have the coarse raster's pose."""
    rough = sum(exposure.is_rough for exposure in exposures)
    if rough < _MANY_ROUGH * len(exposures):
        return []
    return [
        f"{rough} of {len(exposures)} exposures could not be aligned: they are placed only roughly "
        "or are not the robot: look at overlay.png, check body_size in robot.toml, and without a "
        "marker annotate an exposure that is fully visible"
    ]
