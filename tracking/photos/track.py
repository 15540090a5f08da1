# SPDX-License-Identifier: MIT
"""Track a walk in photographs, or in one composite picture."""

from collections.abc import Callable, Sequence

from tracking.errors import NoUsablePhoto
from tracking.images import PhotoTimes
from tracking.photos.by_look import track_by_look
from tracking.photos.by_marker import track_by_marker
from tracking.photos.exposures import track_exposures
from tracking.photos.result import Tracked, times_by_name
from tracking.photos.scene import Photo, Scene
from tracking.photos.workers import NoProgress, Progress


def track_photos(
    scene: Scene, photos: Sequence[Photo], *, times_of: Callable[[Sequence[str]], PhotoTimes],
    gap: float | None = None, workers: int = 1, progress: Progress | None = None,
) -> Tracked:  # fmt: skip
    """Track a robot in photographs: by its marker, by a template, or in a composite picture.

    Args:
        scene: Camera, floor, robot and annotations; tracked is a composite picture if
            `scene.is_composite`, else by the marker if `scene.robot` is given, else by the
            template.
        photos: The photographs, at least one, in order of time, or the one composite picture.
        times_of: Function from names of photographs, in order, to their times; of a composite
            picture, from names of its exposures found, `walk.jpg#1`, `walk.jpg#2` and so on.
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        workers: Largest number of processes.
        progress: Receiver of progress and of requests to stop; None for none.

    Returns:
        The path with covariance, the fitted floor and camera, and photographs left out and why.

    Raises:
        NoUsablePhoto: No photograph is given or can be used, or not the one with the annotated top,
            or the robot's marker is detected in none and there are no corrections.
        TrackingError: No photograph shows a mark of the floor or its map does not fit; the robot
            has no marker and no top that can serve as template, or its head and tail cannot be
            distinguished; `body_size` of a composite picture's robot is not known; no exposure is
            found or no pose left; two have the same time; or a correction is invalid.
        TrackStopped: A stop was requested.
    """
    if not photos:
        raise NoUsablePhoto("there are no photographs to track; expected one or more")
    progress = NoProgress() if progress is None else progress
    if scene.is_composite:
        return track_exposures(scene, photos[0], times_of=times_of, gap=gap, progress=progress)
    names = [photo.name for photo in photos]
    times = times_by_name(names, times_of(names))
    if scene.robot is None:
        return track_by_look(
            scene, photos, times=times, gap=gap, workers=workers, progress=progress
        )
    return track_by_marker(
        scene, scene.robot, photos, times=times, gap=gap, workers=workers, progress=progress
    )
