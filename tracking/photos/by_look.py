# SPDX-License-Identifier: MIT
"""Track a robot without a marker, by aligning a template of its top with each photograph."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from model.arrays import Array
from tracking.body import (
    AnnotatedPose,
    BodyCandidates,
    BodyTemplate,
    RefinedCorners,
    align,
    find_body,
    make_template,
    refine_corners,
    resolve_headings,
)
from tracking.camera import Camera, CameraPose
from tracking.errors import BodyError, NoUsablePhoto, PhotoError
from tracking.images import read_pixels
from tracking.path import PoseObservation
from tracking.photos.floor_seen import FloorSeen, see_floor
from tracking.photos.result import Times, Tracked, finish, observation_of
from tracking.photos.scene import MarkedTop, Photo, Scene
from tracking.photos.workers import Progress, batches_of, run_batches
from tracking.pose import BodyPrior, fit_pose

_REACH = 0.6  # radius around the last position that is searched first [m]
_LIKE = 0.6  # least correlation with the template of another annotated photograph
_NO_TOP = 1e-6  # probability of clicks farther from any pose of the top
_WORTH_WORKERS = 6  # photographs; each takes a second to match


@dataclass(frozen=True)
class _Search:
    """Job of a worker: find templates in consecutive photographs with known camera poses."""

    camera: Camera
    prior: BodyPrior
    photos: Sequence[tuple[Photo, CameraPose, BodyTemplate]]


def track_by_look(
    scene: Scene, photos: Sequence[Photo], *, times: Times, gap: float | None, workers: int,
    progress: Progress,
) -> Tracked:  # fmt: skip
    """Track a robot by a template of its top, annotated in one photograph or in several.

    In each photograph the template of the annotated photograph nearest in order is sought: the
    robot looks much the same there. In annotated photographs all others are aligned too, which
    tells how their annotations differ.

    Args:
        scene: Camera, floor and robot, with its annotated tops.
        photos: The photographs, in order of time.
        times: By photograph, time and its standard deviation [s].
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        workers: Number of processes; one is used to find the robot in fewer than 6 photographs,
            and to detect markers below `WORTH_WORKERS` pixels in all.
        progress: Receiver of progress and of requests to stop.

    Returns:
        The track with fitted floor, photographs without a pose, and notes.

    Raises:
        NoUsablePhoto: No photograph, or not one with an annotated top, can be used.
        TrackingError: No top is annotated or it cannot serve as template, no photograph shows a
            mark of the floor or its map does not fit, the robot's head and tail cannot be
            distinguished, no pose is left, two photographs have the same time, or a correction is
            invalid.
        TrackStopped: A stop was requested.
    """
    seen = see_floor(scene, photos, robot=None, workers=workers, progress=progress)
    scene = replace(scene, camera=seen.fit.camera)  # the poses of the camera are for this lens
    templates, corners = _templates(scene, seen, photos)
    usable = [photo for photo in photos if photo.name not in seen.lost]
    nearest = nearest_of([photo.name for photo in usable], list(templates))
    jobs = [
        (photo, seen.fit.pose_of(photo.name), templates[nearest[photo.name]][0]) for photo in usable
    ]
    found = _found(scene, jobs, workers=workers, progress=progress)
    known = [(photo, each) for photo, each in zip(usable, found, strict=True) if each is not None]
    length = next(iter(templates.values()))[0].plate.length
    chosen = resolve_headings([each for _, each in known], length=length)
    observations = [
        observation_of(
            photo.name,
            alignment,
            times[photo.name],
            source="body",
            stand=seen.fit.stand_of(photo.name),
            annotated=(nearest[photo.name], templates[nearest[photo.name]][1]),
        )
        for (photo, _), alignment in zip(known, chosen, strict=True)
    ]
    unseen = {
        photo.name: "no place looks like the robot's annotated top"
        for photo, each in zip(usable, found, strict=True)
        if each is None
    }
    tracked = finish(
        scene, seen, observations, unseen=unseen, times=times, gap=gap,
        annotations={name: annotated for name, (_, annotated) in templates.items()},
        again=_again(scene, photos, templates, observations),
    )  # fmt: skip
    views = {top.photo: seen.fit.pose_of(top.photo) for top in scene.tops}
    notes = (*_click_notes(scene, views, corners), *tracked.notes)
    return replace(tracked, notes=notes, corners=corners)


def _click_notes(
    scene: Scene, views: Mapping[str, CameraPose], corners: Mapping[str, RefinedCorners]
) -> list[str]:
    """Return a sentence for each top whose clicks do not fit its stated size, or else its edges."""
    notes = []
    for top in scene.tops:
        clicked = pose_of_top(top, scene, views[top.photo])
        missed = np.array(top.corners_px) - clicked.corners_px
        if missed_too_far(clicked, missed, top.corner_sd_px):
            farthest = float(np.linalg.norm(missed, axis=1).max())
            notes.append(
                f"the clicks on the robot's top in {top.photo} are up to {farthest:.1f} px from "
                f"where a top of {top.plate.length:g} x {top.plate.width:g} m can be: check its "
                "length and width, and the order of the clicks (front left, front right, rear "
                "right, rear left); or click again"
            )
        elif corners[top.photo].contradicts:
            notes.append(
                f"the edges seen near the clicked corners of the robot's top in {top.photo} do not "
                "fit the clicks, which are used without them: click again on the corners of a "
                "plate whose edges are seen, or state a larger corner_sd_px"
            )
    return notes


def missed_too_far(pose: AnnotatedPose, missed: Array, sd_px: float) -> bool:
    """Return whether clicks fit no pose of the top, by a chi-squared test at probability 1e-6.

    Args:
        pose: Pose fitted to the clicks.
        missed: Clicked minus projected corners, shape (4, 2) [px].
        sd_px: Standard deviation of u and of v of a click [px].
    """
    state, prior = pose.pose.state, pose.prior
    height_sd = np.hypot(prior.height_sd, prior.mean_height_sd)
    tilt_sd = np.hypot(prior.tilt_sd, prior.mean_tilt_sd)
    held = np.array([(state[2] - prior.height) / height_sd, *(state[3:5] / tilt_sd)])
    square = float(np.sum((missed / sd_px) ** 2) + held @ held)
    # Degrees of freedom: clicked coordinates and three priors, less the six of the pose.
    return square > float(chi2.isf(_NO_TOP, missed.size + 3 - 6))


def _again(
    scene: Scene, photos: Sequence[Photo],
    templates: Mapping[str, tuple[BodyTemplate, AnnotatedPose]],
    observations: Sequence[PoseObservation],
) -> list[PoseObservation]:  # fmt: skip
    """Align, in each annotated photograph, the templates of all others, from the pose found.

    Kept are alignments whose correlation is above `_LIKE`. With one template there are none.
    """
    files = {photo.name: photo.path for photo in photos}
    found = []
    for seen in observations if len(templates) > 1 else ():
        if seen.photo not in templates:
            continue
        pixels = read_pixels(files[seen.photo], size=scene.camera.size)
        view = templates[seen.photo][1].view
        for name in sorted(templates.keys() - {seen.annotated}):
            template, annotated = templates[name]
            alignment = align(pixels, scene.camera, view, template=template, prior=scene.prior,
                              start=seen.planar)  # fmt: skip
            if alignment is not None and alignment.score > _LIKE:
                found.append(
                    observation_of(seen.photo, alignment, (seen.t, seen.t_sd), source="body",
                                   stand=seen.stand, annotated=(name, annotated))
                )  # fmt: skip
    return found


def nearest_of(names: Sequence[str], annotated: Sequence[str]) -> dict[str, str]:
    """Return for each photograph the annotated one nearest in order, of two the earlier.

    Args:
        names: Names of the photographs, in order of time.
        annotated: Names of the annotated ones, all among `names`.
    """
    places = sorted((names.index(name), name) for name in annotated)
    return {
        name: min(places, key=lambda place: abs(place[0] - k))[1] for k, name in enumerate(names)
    }


def _found(
    scene: Scene, photos: Sequence[tuple[Photo, CameraPose, BodyTemplate]], *, workers: int,
    progress: Progress,
) -> list[BodyCandidates | None]:  # fmt: skip
    """Find a template in each photograph, in a process pool; None where it is not found.

    It is searched near its place before, then in the whole photograph. Below 6 photographs there is
    no pool.
    """
    workers = workers if len(photos) >= _WORTH_WORKERS else 1
    jobs = [_Search(scene.camera, scene.prior, batch) for batch in batches_of(photos, workers)]
    batches = run_batches(_find_batch, jobs, workers=workers, progress=progress, what="robot")
    return [found for batch in batches for found in batch]


def marked_tops(scene: Scene, seen: FloorSeen, photos: Sequence[Photo]) -> tuple[MarkedTop, ...]:
    """Return the scene's annotated tops of the robot; raise if a photograph cannot be used.

    Args:
        scene: Camera, floor and robot.
        seen: The floor in the photographs, and the photographs that cannot be used.
        photos: The photographs.

    Raises:
        BodyError: No top is annotated.
        NoUsablePhoto: An annotated photograph is not among `photos`, or cannot be used.
    """
    if not scene.tops:
        raise BodyError(
            "the robot has no marker, and its top is not annotated (`zebro-lab annotate --corners`)"
        )
    for top in scene.tops:
        if top.photo not in {photo.name for photo in photos}:
            raise NoUsablePhoto(
                f"annotated photograph '{top.photo}' is not among the photographs; add it"
            )
        if top.photo in seen.lost:
            raise NoUsablePhoto(f"the annotated photograph {top.photo}: {seen.lost[top.photo]}")
    return scene.tops


def _templates(
    scene: Scene, seen: FloorSeen, photos: Sequence[Photo]
) -> tuple[dict[str, tuple[BodyTemplate, AnnotatedPose]], dict[str, RefinedCorners]]:
    """Cut a template of the robot out of each annotated photograph.

    Returns:
        By name of the photograph, the template and the pose at which it is cut out; and the corners
        of the top by clicks and edges.

    Raises:
        BodyError: No top is annotated, or one cannot serve as template (see `make_template`).
        NoUsablePhoto: An annotated photograph is not among `photos`, or cannot be used.
    """
    files = {photo.name: photo.path for photo in photos}
    templates, corners = {}, {}
    for top in marked_tops(scene, seen, photos):
        view = seen.fit.pose_of(top.photo)
        pixels = read_pixels(files[top.photo], size=scene.camera.size)
        annotated, corners[top.photo] = refined_pose(top, scene, view, pixels)
        template = make_template(
            pixels, scene.camera, view, pose=annotated.pose, plate=top.plate, prior=scene.prior
        )
        templates[top.photo] = (template, annotated)
    return templates, corners


def refined_pose(
    top: MarkedTop, scene: Scene, view: CameraPose, pixels: NDArray[np.uint8]
) -> tuple[AnnotatedPose, RefinedCorners]:
    """Fit the robot's pose to clicks on the corners of its top, refined by the top's edges.

    Args:
        top: The top, with the clicked corners.
        scene: As of `pose_of_top`.
        view: Pose of the camera in the annotated photograph.
        pixels: The annotated photograph, BGR, shape (height, width, 3).

    Returns:
        The pose, and the refined corners it was fitted to.
    """
    clicked = pose_of_top(top, scene, view)
    if not top.edges:
        clicks = np.array(top.corners_px)
        return clicked, RefinedCorners(clicks, top.corner_sd_px**2 * np.eye(8), 0)
    corners = refine_corners(pixels, clicked, np.array(top.corners_px), sd_px=top.corner_sd_px)
    return _pose_at(corners.corners_px, corners.covariance, top, scene, view), corners


def pose_of_top(top: MarkedTop, scene: Scene, view: CameraPose) -> AnnotatedPose:
    """Fit the robot's pose to clicks on the corners of its top.

    Args:
        top: The top, with the clicked corners.
        scene: Scene, of which the camera and the prior of height and tilt are used; the camera
            is that for which `view` was fitted.
        view: Pose of the camera in the annotated photograph.

    Raises:
        ValueError: As `fit_pose`.
    """
    covariance = top.corner_sd_px**2 * np.eye(8)
    return _pose_at(np.array(top.corners_px), covariance, top, scene, view)


def _pose_at(
    corners_px: Array, covariance: Array, top: MarkedTop, scene: Scene, view: CameraPose
) -> AnnotatedPose:
    """Fit the robot's pose to corners of its top in the picture, with their covariance (8, 8)."""
    corners = top.plate.corners_body
    pose = fit_pose(scene.camera, view, points_body=corners, corners_px=corners_px,
                    covariance=covariance, prior=scene.prior)  # fmt: skip
    return AnnotatedPose(scene.camera, view, pose, scene.prior, corners)


def _find_batch(job: _Search) -> list[BodyCandidates | None]:
    """Find the robot in each photograph of a job, first near where it was last found."""
    found: list[BodyCandidates | None] = []
    near = None
    for photo, view, template in job.photos:
        candidates = _find_one(job, photo, view, template, near)
        if candidates is not None:
            near = candidates.best.pose.planar[:2]
        found.append(candidates)
    return found


def _find_one(
    job: _Search, photo: Photo, view: CameraPose, template: BodyTemplate, near: Array | None
) -> BodyCandidates | None:
    """Find the robot near a place, if one is given; else, or if it fails, in the whole picture.

    None where it is not found, or the file cannot be read any more.
    """
    try:
        pixels = read_pixels(photo.path, size=job.camera.size)
    except PhotoError:
        return None  # the file was readable before: it was removed meanwhile
    if near is not None:
        found = find_body(pixels, job.camera, view, template=template, prior=job.prior,
                          near=near, reach=_REACH)  # fmt: skip
        if found is not None:
            return found
    return find_body(pixels, job.camera, view, template=template, prior=job.prior)
