# SPDX-License-Identifier: MIT
"""Track a robot by the marker on its back."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tracking.detect import MarkedRobot, observe
from tracking.errors import NoUsablePhoto
from tracking.floor import FloorMap
from tracking.images import read_pixels
from tracking.markers import find_markers, guess_dictionary, marker_family
from tracking.photos.edges import edge_spread
from tracking.photos.floor_seen import FloorSeen, see_floor
from tracking.photos.result import Times, Tracked, finish, shared_errors
from tracking.photos.scene import Photo, Scene
from tracking.photos.workers import Progress


def track_by_marker(
    scene: Scene, robot: MarkedRobot, photos: Sequence[Photo], *, times: Times,
    gap: float | None, workers: int, progress: Progress,
) -> Tracked:  # fmt: skip
    """Track a robot by the marker on its back.

    Args:
        scene: Camera, floor, clicked points, prior and corrections.
        robot: The robot's marker and prior.
        photos: The photographs, in order of time.
        times: By photograph, time and its standard deviation [s].
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        workers: Number of processes; one is used below `WORTH_WORKERS` pixels in all.
        progress: Receiver of progress and of requests to stop.

    Returns:
        The track with fitted floor, photographs without a pose, and notes.

    Raises:
        NoUsablePhoto: No photograph can be used, or the marker is detected in none and there are
            no corrections.
        TrackingError: No photograph shows a mark of the floor or its map does not fit, two
            photographs have the same time, no pose is left, or a correction is invalid.
        TrackStopped: A stop was requested.
    """
    seen = see_floor(scene, photos, robot=robot, workers=workers, progress=progress)
    edges = edge_spread(
        seen.fit, seen.detections, robot=robot, times=times, shared=shared_errors(scene, seen),
        gap=gap, corrections=scene.corrections,
    )  # fmt: skip
    observations = observe(seen.fit, seen.detections, robot=robot, times=times, edge_sd=edges.sd)
    if not observations and not scene.corrections:
        raise NoUsablePhoto(_robot_unseen(scene, robot, photos, seen))
    unseen = {
        detection.photo: f"the robot's marker {robot.marker.marker_id} is not seen"
        for detection in seen.detections
        if detection.robot is None
    }
    return finish(scene, seen, observations, unseen=unseen, times=times, gap=gap)


def _robot_unseen(
    scene: Scene, robot: MarkedRobot, photos: Sequence[Photo], seen: FloorSeen
) -> str:
    first = next(photo for photo in photos if photo.name == seen.detections[0].photo)
    other = other_markers(read_pixels(first.path), robot, scene.floor)
    advice = "look at the first photograph with `zebro-lab track --preview`"
    if other is not None:
        advice = f"{first.name} shows {other}: correct [marker] of robot.toml"
    marker = robot.marker
    return (
        f"the robot's marker {marker.marker_id} of '{marker.dictionary}' is seen in none of "
        f"{len(seen.detections)} photographs; {advice}"
    )


def other_markers(pixels: NDArray[np.uint8], robot: MarkedRobot, floor: FloorMap) -> str | None:
    """Format the numbers of the markers in a photograph that are not on the floor map.

    The list serves the error message when the robot's marker is not detected: a wrong number or
    dictionary is the most frequent cause. Tried are the robot's, the floor's and a guessed
    dictionary, in this order; of the floor's dictionary the floor map's numbers are left out.

    Args:
        pixels: The photograph, grey or BGR.
        robot: The robot, of which the marker's dictionary is used.
        floor: The floor's marks.

    Returns:
        Text such as "3, 7 of '4x4_50'" for the first dictionary with such markers, or None.
    """
    names = (robot.marker.dictionary, floor.dictionary, guess_dictionary(pixels))
    for dictionary in dict.fromkeys(name for name in names if name is not None):
        numbers = range(marker_family(dictionary).count)
        found = {s.marker_id for s in find_markers(pixels, dictionary, wanted=numbers, effort=0)}
        if dictionary == floor.dictionary:
            found -= set(floor.marker_ids)
        if found:
            return f"{', '.join(map(str, sorted(found)))} of '{dictionary}'"
    return None
