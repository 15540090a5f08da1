# SPDX-License-Identifier: MIT
"""Track a robot without a marker, by its own picture; and many exposures in one picture."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.body import (
    Alignment,
    BodyCandidates,
    BodyTemplate,
    find_body,
    make_template,
    marker_template,
    resolve_headings,
)
from tracking.camera import Camera, CameraPose
from tracking.camera.lens import Array
from tracking.composite import (
    Exposure,
    Merged,
    find_exposures,
    find_exposures_like,
    order_exposures,
)
from tracking.errors import PhotoError
from tracking.images import PhotoTimes, read_pixels
from tracking.path import Observation
from tracking.pose import BodyPose, BodyPrior, fit_pose
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.track.annotations import TemplateClicks
from zebro_lab.track.photo_search import Photo, Watcher, batches_of, run_batches
from zebro_lab.track.tracker import FloorSeen, Scene, Tracked, finish, see_floor

CLICK_SD = 1.0
"""Standard deviation of a click on a corner of the robot's top [px]."""

_REACH = 0.6  # how far from where it was the robot is looked for first [m]
_MARK_MARGIN = 1.5  # by how much a floor marker and its margin are larger than its black square
_MANY_ROUGH = 1 / 3  # of a composite's exposures
_WORTH_WORKERS = 6  # photographs: rotating and matching takes a second each


@dataclass(frozen=True)
class _Search:
    """A stretch of photographs to find the robot in."""

    camera: Camera
    template: BodyTemplate
    prior: BodyPrior
    photos: Sequence[tuple[Photo, CameraPose]]


def track_body(
    scene: Scene, photos: Sequence[Photo], *, times: Mapping[str, tuple[float, float]],
    watcher: Watcher, gap: float | None = None,
) -> Tracked:  # fmt: skip
    """Track a robot by its own picture, annotated in one photograph.

    Args:
        scene: What is known, with the annotated template.
        photos: The photographs, in order of time.
        times: By photograph, time and its standard deviation [s].
        watcher: Who follows.
        gap: Interval longer than which the path is interrupted; None for the tracker's own [s].

    Returns:
        The track.

    Raises:
        ZebroLabError: No photograph can be used, or none is annotated.
        TrackingError: The floor's map does not fit, head and tail cannot be told apart, or a
            correction cannot be replayed.
        TrackStopped: Somebody asked to stop.
    """
    seen = see_floor(scene, photos, watcher)
    template = _template(scene, seen, photos)
    usable = [photo for photo in photos if photo.name not in seen.lost]
    workers = scene.workers if len(usable) >= _WORTH_WORKERS else 1
    jobs = [
        _Search(scene.camera, template, scene.prior,
                [(photo, seen.fit.pose_of(photo.name)) for photo in batch])
        for batch in batches_of(usable, workers)
    ]  # fmt: skip
    batches = run_batches(_find_batch, jobs, workers=workers, watcher=watcher, what="robot")
    found = [found for batch in batches for found in batch]
    known = [(photo, each) for photo, each in zip(usable, found, strict=True) if each is not None]
    chosen = resolve_headings([each for _, each in known], length=template.plate.length)
    observations = [
        _observation(photo.name, alignment, times, "body")
        for (photo, _), alignment in zip(known, chosen, strict=True)
    ]
    unseen = {
        photo.name: "nothing looks like the robot"
        for photo, each in zip(usable, found, strict=True)
        if each is None
    }
    return finish(scene, seen, observations, unseen=unseen, times=times, gap=gap)


def track_composite(
    scene: Scene, photo: Photo, *, times_of: Callable[[tuple[str, ...]], PhotoTimes],
    merged: Merged, body_size: tuple[float, float], watcher: Watcher, gap: float | None = None,
) -> Tracked:  # fmt: skip
    """Track a robot through the exposures of one composite picture.

    Exposures are called after the picture: `walk.jpg#1` is the first.

    Args:
        scene: What is known; the robot's marker, or its annotated template, is what is looked for.
        photo: The picture.
        times_of: Gives the times of the exposures, by their names in order.
        merged: How the exposures were merged.
        body_size: Length and width of the robot's body [m].
        watcher: Who follows.
        gap: Interval longer than which the path is interrupted; None for the tracker's own [s].

    Returns:
        The track.

    Raises:
        ZebroLabError: The picture cannot be used, or has no times.
        TrackingError: The floor's map does not fit, or no exposure is found.
    """
    by_floor = Scene(scene.camera, scene.floor, scene.prior, None, scene.said)
    seen = see_floor(by_floor, [photo], watcher)
    watcher.step("exposures", None)
    exposures = _exposures(scene, seen, photo, merged, body_size)
    poses = np.array([each.alignment.pose.planar for each in exposures])
    order = order_exposures(poses)
    source = "body" if scene.robot is None else "marker"
    names = tuple(f"{photo.name}#{number}" for number in range(1, len(order) + 1))
    stamps = times_of(names)
    times = dict(zip(names, zip(stamps.t.tolist(), stamps.sd.tolist(), strict=True), strict=True))
    observations = [
        _observation(name, exposures[k].alignment, times, source)
        for name, k in zip(names, order, strict=True)
    ]
    tracked = finish(scene, seen, observations, unseen={}, times=times, gap=gap)
    return replace(tracked, notes=(*tracked.notes, *_rough_note(exposures)))


def _rough_note(exposures: Sequence[Exposure]) -> list[str]:
    rough = sum(exposure.is_rough for exposure in exposures)
    if rough < _MANY_ROUGH * len(exposures):
        return []
    return [
        f"{rough} of {len(exposures)} exposures are placed only roughly, if they are exposures at "
        "all: look at overlay.png; the exposure whose top is marked must show whole, and body_size "
        "in robot.toml must be the robot's"
    ]


def _exposures(
    scene: Scene, seen: FloorSeen, photo: Photo, merged: Merged, body_size: tuple[float, float]
) -> tuple[Exposure, ...]:
    """Find exposures by the robot's marker, or by the one whose top was clicked on."""
    pixels = read_pixels(photo.path, size=scene.camera.size)
    view = seen.fit.pose_of(photo.name)
    hidden = _on_marks(seen, photo.name, pixels.shape[:2])
    if scene.robot is not None:
        return find_exposures(
            pixels, scene.camera, view, template=marker_template(scene.robot.marker),
            prior=scene.prior, merged=merged, body_size=body_size, hidden=hidden,
        )  # fmt: skip
    clicks = _clicks(scene, seen, [photo])
    return find_exposures_like(
        pixels, scene.camera, view, known=pose_from_clicks(clicks, scene, view),
        plate=clicks.plate, prior=scene.prior, merged=merged, body_size=body_size,
        hidden=hidden,
    )  # fmt: skip


def _on_marks(seen: FloorSeen, photo: str, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Mark the pixels of the floor's markers with their margin: they look like the robot's."""
    hidden = np.zeros(shape, dtype=np.uint8)
    for detection in seen.detections:
        for corners in detection.floor.pixels.values() if detection.photo == photo else ():
            middle = corners.mean(axis=0)
            outline = middle + _MARK_MARGIN * (corners - middle)
            cv2.fillConvexPoly(hidden, np.round(outline).astype(np.int32), (1,))
    return hidden.astype(bool)


def _observation(
    name: str, alignment: Alignment, times: Mapping[str, tuple[float, float]], source: str
) -> Observation:
    t, t_sd = times[name]
    return Observation.of(
        name, alignment.pose, t=t, t_sd=t_sd, score=alignment.score, source=source
    )


def _clicks(scene: Scene, seen: FloorSeen, photos: Sequence[Photo]) -> TemplateClicks:
    clicks = scene.said.template
    if clicks is None:
        raise SettingsError(
            "needed: without a marker the robot is known by its picture; mark its top in one "
            "photograph with `zebro-lab annotate PHOTOS --photo NAME --corners ...`",
            key="--annotations",
        )
    if clicks.photo not in {photo.name for photo in photos}:
        raise DataError(f"the template's photograph '{clicks.photo}' is not among the photographs")
    if clicks.photo in seen.lost:
        raise DataError(f"the template's photograph {clicks.photo}: {seen.lost[clicks.photo]}")
    return clicks


def _template(scene: Scene, seen: FloorSeen, photos: Sequence[Photo]) -> BodyTemplate:
    clicks = _clicks(scene, seen, photos)
    view = seen.fit.pose_of(clicks.photo)
    files = {photo.name: photo.path for photo in photos}
    pixels = read_pixels(files[clicks.photo], size=scene.camera.size)
    return template_from_clicks(clicks, pixels, scene, view)


def template_from_clicks(
    clicks: TemplateClicks, pixels: NDArray[np.uint8], scene: Scene, view: CameraPose
) -> BodyTemplate:
    """Take the robot's picture out of the photograph in which its top was clicked on.

    Raises:
        BodyError: The robot is cut by the photograph's edge, too small or without contrast.
    """
    pose = pose_from_clicks(clicks, scene, view)
    return make_template(pixels, scene.camera, view, pose=pose, plate=clicks.plate)


def pose_from_clicks(clicks: TemplateClicks, scene: Scene, view: CameraPose) -> BodyPose:
    """Fit the robot's pose to clicks on the corners of its top."""
    return fit_pose(
        scene.camera, view, points_body=clicks.plate.corners_body, corners_px=clicks.corners_px,
        covariance=CLICK_SD**2 * np.eye(8), prior=scene.prior,
    )  # fmt: skip


def _find_batch(job: _Search) -> list[BodyCandidates | None]:
    found: list[BodyCandidates | None] = []
    near = None
    for photo, view in job.photos:
        candidates = _find_one(job, photo, view, near)
        if candidates is not None:
            near = candidates.best.pose.planar[:2]
        found.append(candidates)
    return found


def _find_one(
    job: _Search, photo: Photo, view: CameraPose, near: Array | None
) -> BodyCandidates | None:
    try:
        pixels = read_pixels(photo.path, size=job.camera.size)
    except PhotoError:
        return None  # was readable a moment ago: the file went away
    if near is not None:
        found = find_body(pixels, job.camera, view, template=job.template, prior=job.prior,
                          near=near, reach=_REACH)  # fmt: skip
        if found is not None:
            return found
    return find_body(pixels, job.camera, view, template=job.template, prior=job.prior)
