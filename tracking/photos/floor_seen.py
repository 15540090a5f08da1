# SPDX-License-Identifier: MIT
"""Detect the floor's marks in all photographs and fit floor and camera to them."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.detect import Detection, MarkedRobot
from tracking.errors import NoUsablePhoto
from tracking.floor import FloorFit, refine_floor
from tracking.photos.scene import Photo, Scene
from tracking.photos.search import PhotoResult, Wanted, search_photos
from tracking.photos.workers import Progress

_MARK_MARGIN = 1.5  # size of a floor marker with its margin over that of its black square


@dataclass(frozen=True)
class FloorSeen:
    """Fitted floor and camera, with the detections of each photograph.

    Attributes:
        fit: Fitted floor map and camera poses.
        detections: Markers detected in each photograph whose detection did not fail (see
            `look_at`), in order of time, also if it shows no mark of the floor.
        lost: By name of each photograph that cannot be used, the reason: detection failed, or it
            shows no mark of the floor.
    """

    fit: FloorFit
    detections: tuple[Detection, ...]
    lost: Mapping[str, str]

    def marks_in(self, photo: str, shape: tuple[int, ...]) -> NDArray[np.bool_]:
        """Compute the mask of the floor's detected markers with their white margin.

        Args:
            photo: Name of the photograph.
            shape: Height and width of the photograph [px].

        Returns:
            True on markers and 0.25 of their side around them, shape (height, width); False
            everywhere for a photograph without detections.
        """
        hidden = np.zeros(shape, dtype=np.uint8)
        for detection in self.detections:
            for corners in detection.floor.pixels.values() if detection.photo == photo else ():
                middle = corners.mean(axis=0)
                outline = middle + _MARK_MARGIN * (corners - middle)
                cv2.fillConvexPoly(hidden, np.round(outline).astype(np.int32), (1,))
        return hidden.astype(bool)


def see_floor(
    scene: Scene, photos: Sequence[Photo], *, robot: MarkedRobot | None, workers: int,
    progress: Progress,
) -> FloorSeen:  # fmt: skip
    """Detect markers in all photographs and fit floor and camera to them.

    Args:
        scene: Camera, floor and clicked points.
        photos: The photographs, in order of time.
        robot: The robot whose marker is also detected; None to detect only the floor's markers.
        workers: Number of processes; one is used below `WORTH_WORKERS` pixels in all.
        progress: Receiver of progress and of requests to stop.

    Returns:
        Fitted floor and camera, and the markers detected in each photograph.

    Raises:
        NoUsablePhoto: Detection failed in all photographs (see `look_at`).
        TrackingError: No photograph shows a mark of the floor, a stand shows fewer than 4 points,
            or the floor's map does not fit.
        TrackStopped: A stop was requested.
    """
    wanted = Wanted(scene.camera.size, scene.floor, robot)
    results = search_photos(photos, wanted, workers=workers, progress=progress)
    detections = tuple(result.seen for result in results if result.seen is not None)
    if not detections:
        raise NoUsablePhoto(_why_none(results))
    lost = {result.photo: result.problem for result in results if result.problem is not None}
    views = [scene.with_clicks(seen.floor) for seen in detections]
    fit = refine_floor(scene.camera, scene.floor, views)
    return FloorSeen(fit, detections, lost | dict(fit.unused))


def _why_none(results: Sequence[PhotoResult]) -> str:
    """Say why no photograph can be used: the first one's problem, and how many have it."""
    first = results[0]
    common, count = Counter(result.problem for result in results).most_common(1)[0]
    so = f" (the same for {count} of them)" if common == first.problem and count > 1 else ""
    return f"none of {len(results)} photographs can be used; {first.photo}: {first.problem}{so}"
