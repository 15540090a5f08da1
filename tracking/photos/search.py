# SPDX-License-Identifier: MIT
"""Detect markers in many photographs, in a process pool; damaged photographs are reported.

The camera stands still and the robot moves a little between two photographs. After the first
photograph each marker is therefore searched where it was before, and in the whole photograph if it
is not found there. Floor markers that the photograph before did not show are searched only if none
of the others is found. Without a robot marker the whole photograph is searched for all.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracking.detect import Detection, MarkedRobot, detect
from tracking.errors import PhotoError
from tracking.floor import FloorMap, FloorView
from tracking.images import read_pixels
from tracking.markers import find_markers
from tracking.photos.scene import Photo
from tracking.photos.workers import WORTH_WORKERS, Progress, batches_of, run_batches


@dataclass(frozen=True)
class Wanted:
    """Settings of detection: size of photographs, the floor's marks and the robot's marker.

    Attributes:
        size: Width and height that photographs must have [px].
        floor: The floor's marks.
        robot: The robot; None not to detect its marker.
    """

    size: tuple[int, int]
    floor: FloorMap
    robot: MarkedRobot | None


@dataclass(frozen=True)
class PhotoResult:
    """Detection in one photograph, or the reason why the photograph cannot be used.

    Attributes:
        photo: Name of the photograph.
        seen: Markers detected; None where the photograph cannot be used.
        problem: Reason why the photograph cannot be used; None where it can.
    """

    photo: str
    seen: Detection | None
    problem: str | None = None


def search_photos(
    photos: Sequence[Photo], wanted: Wanted, *, workers: int, progress: Progress
) -> tuple[PhotoResult, ...]:
    """Detect markers in photographs, in parallel where that is faster.

    Args:
        photos: The photographs, in order of time.
        wanted: Settings of detection.
        workers: Number of processes; one is used below `WORTH_WORKERS` pixels in all.
        progress: Receiver of progress and of requests to stop.

    Returns:
        Detection in each photograph, or why it cannot be used, in the same order.

    Raises:
        MarkerError: There is no dictionary of a given name.
        TrackStopped: A stop was requested.
    """
    if len(photos) * wanted.size[0] * wanted.size[1] < WORTH_WORKERS:
        workers = 1
    batches = [(wanted, batch) for batch in batches_of(photos, workers)]
    done = run_batches(_search_batch, batches, workers=workers, progress=progress, what="markers")
    return tuple(look for batch in done for look in batch)


def _search_batch(job: tuple[Wanted, Sequence[Photo]]) -> list[PhotoResult]:
    """Detect markers in consecutive photographs, each near those of the one before."""
    wanted, photos = job
    looks: list[PhotoResult] = []
    hint: Detection | None = None
    for photo in photos:
        look = look_at(photo, wanted, hint)
        # A photograph without the robot must not discard the hint of where the floor's marks are.
        hint = look.seen or hint
        looks.append(look)
    return looks


def look_at(photo: Photo, wanted: Wanted, hint: Detection | None = None) -> PhotoResult:
    """Detect markers in one photograph; report a `PhotoError` instead of raising it.

    Args:
        photo: The photograph.
        wanted: Settings of detection.
        hint: Detection in a photograph taken shortly before, near which to search first.

    Returns:
        The detection; or why the photograph cannot be used: it cannot be read, is of another size
        or, if a robot's marker is wanted, shows that twice or none of the floor's markers.

    Raises:
        MarkerError: There is no dictionary of a given name.
    """
    try:
        pixels = read_pixels(photo.path, size=wanted.size)
        return PhotoResult(photo.name, _detected(photo.name, pixels, wanted, hint))
    except PhotoError as error:
        return PhotoResult(photo.name, None, error.reason)


def _detected(
    name: str, pixels: NDArray[np.uint8], wanted: Wanted, hint: Detection | None
) -> Detection:
    """Detect markers; floor markers that `hint` does not show are sought only if that fails.

    Raises:
        PhotoError: As `detect`; never if no robot is wanted.
    """
    robot = wanted.robot
    if robot is None:
        return _floor_alone(name, pixels, wanted.floor)
    if hint is not None and hint.floor.pixels:
        # Avoids a search of the whole picture in every photograph for marks outside it.
        seen = FloorMap(
            wanted.floor.dictionary,
            tuple(m for m in wanted.floor.markers if m.marker_id in hint.floor.pixels),
        )
        try:
            return detect(name, pixels, floor=seen, robot=robot, hint=hint)
        except PhotoError:
            if wanted.floor.markers == seen.markers:
                raise
    return detect(name, pixels, floor=wanted.floor, robot=robot, hint=hint)


def _floor_alone(name: str, pixels: NDArray[np.uint8], floor: FloorMap) -> Detection:
    """Detect the floor's markers only, leave out those detected twice; none is not an error."""
    found = find_markers(pixels, floor.dictionary, wanted=floor.marker_ids) if floor.markers else ()
    return Detection(name, FloorView.of(name, found), None)
