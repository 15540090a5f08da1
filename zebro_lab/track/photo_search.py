# SPDX-License-Identifier: MIT
"""Markers in many photographs, on several cores; a bad photograph does not lose the others.

The camera stands still and the robot moves a little between two photographs, so after the first
one each marker is looked for where it was. The whole photograph is searched again only where the
robot is not found there, or most of the floor is not.
"""

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.detect import Detection, Robot, detect
from tracking.errors import PhotoError
from tracking.floor import FloorMap, FloorView
from tracking.images import read_pixels
from tracking.markers import find_markers
from zebro_lab.files.errors import ZebroLabError

WORTH_WORKERS = 60e6
"""Pixels to look at for which starting other processes, a second each, pays."""

LONGEST_BATCH = 12

Job = TypeVar("Job")
Result = TypeVar("Result")


class Watcher(Protocol):
    """Who follows the search: a progress bar, or nobody."""

    def step(self, what: str, fraction: float | None) -> None:
        """Hear what is going on, and how far it is (None: unknown)."""
        ...

    def stop_requested(self) -> bool:
        """Tell whether somebody asked to stop."""
        ...


class TrackStopped(ZebroLabError):
    """Tracking was stopped on request; nothing was written."""


@dataclass(frozen=True)
class Photo:
    """A photograph to look at.

    Attributes:
        name: What the results call it.
        path: Its file.
    """

    name: str
    path: Path


@dataclass(frozen=True)
class Wanted:
    """What to look for.

    Attributes:
        size: Width and height photographs must have [px].
        floor: The floor's marks.
        robot: The robot; None where its marker is not to be looked for.
    """

    size: tuple[int, int]
    floor: FloorMap
    robot: Robot | None


@dataclass(frozen=True)
class Look:
    """What looking at a photograph gave.

    Attributes:
        photo: Its name.
        seen: What it shows; None where it cannot be used.
        problem: Why not; None where it can.
    """

    photo: str
    seen: Detection | None
    problem: str | None = None


def search_photos(
    photos: Sequence[Photo], wanted: Wanted, *, workers: int, watcher: Watcher
) -> tuple[Look, ...]:
    """Look for markers in photographs.

    Args:
        photos: The photographs, in order of time.
        wanted: What to look for.
        workers: Processes to use.
        watcher: Who follows.

    Returns:
        What each shows, in the same order.

    Raises:
        TrackStopped: Somebody asked to stop.
    """
    if len(photos) * wanted.size[0] * wanted.size[1] < WORTH_WORKERS:
        workers = 1
    batches = [(wanted, batch) for batch in batches_of(photos, workers)]
    done = run_batches(_search_batch, batches, workers=workers, watcher=watcher, what="markers")
    return tuple(look for batch in done for look in batch)


def batches_of(photos: Sequence[Photo], workers: int) -> list[Sequence[Photo]]:
    """Cut photographs into stretches that follow each other in time."""
    length = int(np.clip(np.ceil(len(photos) / (2 * workers)), 1, LONGEST_BATCH))
    return [photos[start : start + length] for start in range(0, len(photos), length)]


def run_batches(
    work: Callable[[Job], Result], jobs: Sequence[Job], *, workers: int, watcher: Watcher, what: str
) -> list[Result]:
    """Do the same to every batch, on several cores where there are enough of them.

    Args:
        work: What to do; a function of a module, as other processes must find it.
        jobs: What to do it to.
        workers: Processes to use.
        watcher: Who follows.
        what: What to tell the watcher.

    Returns:
        Results in the order of the jobs.

    Raises:
        TrackStopped: Somebody asked to stop.
    """
    watcher.step(what, 0.0)
    if min(workers, len(jobs)) < 2:
        results = []
        for number, job in enumerate(jobs, 1):
            results.append(work(job))
            follow(watcher, what, number / len(jobs))
        return results
    # Not forked: OpenCV's threads do not survive it.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(min(workers, len(jobs)), context, _one_thread)
    try:
        futures = [pool.submit(work, job) for job in jobs]
        for number, _ in enumerate(as_completed(futures), 1):
            follow(watcher, what, number / len(jobs))
        return [future.result() for future in futures]
    finally:
        pool.shutdown(cancel_futures=True)


def _one_thread() -> None:
    cv2.setNumThreads(1)


def follow(watcher: Watcher, what: str, fraction: float | None) -> None:
    """Tell a watcher how far it is, and stop where it asks to.

    Raises:
        TrackStopped: Somebody asked to stop.
    """
    watcher.step(what, fraction)
    if watcher.stop_requested():
        raise TrackStopped("stopped; nothing was written")


def _search_batch(job: tuple[Wanted, Sequence[Photo]]) -> list[Look]:
    wanted, photos = job
    looks: list[Look] = []
    hint: Detection | None = None
    for photo in photos:
        look = look_at(photo, wanted, hint)
        # A photograph without the robot must not make the next one forget where the floor is.
        hint = look.seen or hint
        looks.append(look)
    return looks


def look_at(photo: Photo, wanted: Wanted, hint: Detection | None = None) -> Look:
    """Look for markers in one photograph.

    Args:
        photo: The photograph.
        wanted: What to look for.
        hint: What one taken shortly before shows.

    Returns:
        What it shows, or why it cannot be used.
    """
    try:
        pixels = read_pixels(photo.path, size=wanted.size)
        return Look(photo.name, _detected(photo.name, pixels, wanted, hint))
    except PhotoError as error:
        return Look(photo.name, None, error.reason)


def _detected(
    name: str, pixels: NDArray[np.uint8], wanted: Wanted, hint: Detection | None
) -> Detection:
    robot = wanted.robot
    if robot is None:
        return _floor_alone(name, pixels, wanted.floor)
    if hint is not None and hint.floor.pixels:
        # Marks out of the picture are not sought in the whole of it again and again.
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
    """Look for the floor's marks where the robot has no marker."""
    found = find_markers(pixels, floor.dictionary, wanted=floor.marker_ids) if floor.markers else ()
    return Detection(name, FloorView.of(name, found), None)
