# SPDX-License-Identifier: MIT
"""Track a robot without a marker, by aligning a template of its top with each photograph."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracking.body import (
    BodyCandidates,
    BodyTemplate,
    find_body,
    make_template,
    resolve_headings,
)
from tracking.camera import Camera, CameraPose
from tracking.camera.lens import Array
from tracking.errors import BodyError, NoUsablePhoto, PhotoError
from tracking.images import read_pixels
from tracking.photos.floor_seen import FloorSeen, see_floor
from tracking.photos.result import Times, Tracked, finish, observation_of
from tracking.photos.scene import MarkedTop, Photo, Scene
from tracking.photos.workers import Progress, batches_of, run_batches
from tracking.pose import HELD, PLANAR, BodyPose, BodyPrior, fit_pose

_REACH = 0.6  # radius around the last position that is searched first [m]
_WORTH_WORKERS = 6  # photographs; each takes a second to match


@dataclass(frozen=True)
class _Search:
    """Job of a worker: find the template in consecutive photographs with known camera poses."""

    camera: Camera
    template: BodyTemplate
    prior: BodyPrior
    photos: Sequence[tuple[Photo, CameraPose]]


def track_by_look(
    scene: Scene, photos: Sequence[Photo], *, times: Times, gap: float | None, workers: int,
    progress: Progress,
) -> Tracked:  # fmt: skip
    """Track a robot by a template of its top, annotated in one photograph.

    Args:
        scene: Camera, floor and robot, with the annotated top.
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
        NoUsablePhoto: No photograph, or not the one with the annotated top, can be used.
        TrackingError: No top is annotated or it cannot serve as template, no photograph shows a
            mark of the floor or its map does not fit, the robot's head and tail cannot be
            distinguished, no pose is left, two photographs have the same time, or a correction is
            invalid.
        TrackStopped: A stop was requested.
    """
    seen = see_floor(scene, photos, robot=None, workers=workers, progress=progress)
    scene = replace(scene, camera=seen.fit.camera)  # the poses of the camera are for this lens
    template, annotation = _template(scene, seen, photos)
    usable = [photo for photo in photos if photo.name not in seen.lost]
    found = _found(scene, seen, template, usable, workers=workers, progress=progress)
    known = [(photo, each) for photo, each in zip(usable, found, strict=True) if each is not None]
    chosen = resolve_headings([each for _, each in known], length=template.plate.length)
    observations = [
        observation_of(
            photo.name,
            alignment,
            times[photo.name],
            source="body",
            stand=seen.fit.stand_of(photo.name),
            annotated=True,
        )
        for (photo, _), alignment in zip(known, chosen, strict=True)
    ]
    unseen = {
        photo.name: "no place looks like the robot's annotated top"
        for photo, each in zip(usable, found, strict=True)
        if each is None
    }
    return finish(
        scene, seen, observations, unseen=unseen, times=times, gap=gap, annotation=annotation
    )


def _found(
    scene: Scene, seen: FloorSeen, template: BodyTemplate, photos: Sequence[Photo], *,
    workers: int, progress: Progress,
) -> list[BodyCandidates | None]:  # fmt: skip
    """Find the template in each photograph, in a process pool; None where it is not found.

    It is searched near its place before, then in the whole photograph. Below 6 photographs there is
    no pool.
    """
    workers = workers if len(photos) >= _WORTH_WORKERS else 1
    jobs = [
        _Search(scene.camera, template, scene.prior,
                [(photo, seen.fit.pose_of(photo.name)) for photo in batch])
        for batch in batches_of(photos, workers)
    ]  # fmt: skip
    batches = run_batches(_find_batch, jobs, workers=workers, progress=progress, what="robot")
    return [found for batch in batches for found in batch]


def marked_top(scene: Scene, seen: FloorSeen, photos: Sequence[Photo]) -> MarkedTop:
    """Return the scene's annotated top of the robot; raise if its photograph cannot be used.

    Args:
        scene: Camera, floor and robot.
        seen: The floor in the photographs, and the photographs that cannot be used.
        photos: The photographs.

    Raises:
        BodyError: `scene.top` is None.
        NoUsablePhoto: The annotated photograph is not among `photos`, or cannot be used.
    """
    top = scene.top
    if top is None:
        raise BodyError(
            "the robot has no marker, and its top is not annotated (`zebro-lab annotate --corners`)"
        )
    if top.photo not in {photo.name for photo in photos}:
        raise NoUsablePhoto(
            f"annotated photograph '{top.photo}' is not among the photographs; add it"
        )
    if top.photo in seen.lost:
        raise NoUsablePhoto(f"the annotated photograph {top.photo}: {seen.lost[top.photo]}")
    return top


def _template(scene: Scene, seen: FloorSeen, photos: Sequence[Photo]) -> tuple[BodyTemplate, Array]:
    """Cut the robot's template out of the photograph in which its top is annotated.

    Returns:
        The template, and the covariance of its pose in the body frame by the clicks (3, 3).

    Raises:
        BodyError: No top is annotated, or it cannot serve as template (see `make_template`).
        NoUsablePhoto: The annotated photograph is not among `photos`, or cannot be used.
    """
    top = marked_top(scene, seen, photos)
    view = seen.fit.pose_of(top.photo)
    files = {photo.name: photo.path for photo in photos}
    pixels = read_pixels(files[top.photo], size=scene.camera.size)
    pose = pose_of_top(top, scene, view)
    template = make_template(pixels, scene.camera, view, pose=pose, plate=top.plate)
    return template, annotation_covariance(pose, scene.prior)


def annotation_covariance(pose: BodyPose, prior: BodyPrior) -> Array:
    """Compute the covariance of an annotated pose by the clicks alone, in the body frame.

    A template cut out at this pose moves all poses by the same x, y and yaw of the body. What is
    wrong with the stated height and tilt is left out: it is wrong in the same way where the
    template is found again. With C the covariance of the pose and Q^-1 the information of the
    prior, clicks make C - C Q^-1 C of it.

    Args:
        pose: The annotated pose, by `pose_of_top`.
        prior: Prior with which it was fitted.

    Returns:
        Covariance of x, y [m] and yaw [rad] in the body frame, shape (3, 3).
    """
    known = np.zeros((6, 6))
    known[np.ix_(HELD, HELD)] = np.linalg.inv(prior.covariance)
    C = pose.covariance
    by_clicks = (C - C @ known @ C)[np.ix_(PLANAR, PLANAR)]
    c, s = np.cos(pose.state[5]), np.sin(pose.state[5])
    into_body = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return into_body @ by_clicks @ into_body.T


def pose_of_top(top: MarkedTop, scene: Scene, view: CameraPose) -> BodyPose:
    """Fit the robot's pose to clicks on the corners of its top.

    Args:
        top: The top, with the clicked corners.
        scene: Scene, of which the camera and the prior of height and tilt are used; the camera
            is that for which `view` was fitted.
        view: Pose of the camera in the annotated photograph.
    """
    return fit_pose(
        scene.camera, view, points_body=top.plate.corners_body, corners_px=top.corners_px,
        covariance=top.corner_sd_px**2 * np.eye(8), prior=scene.prior,
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
        return None  # the file was readable before: it was removed meanwhile
    if near is not None:
        found = find_body(pixels, job.camera, view, template=job.template, prior=job.prior,
                          near=near, reach=_REACH)  # fmt: skip
        if found is not None:
            return found
    return find_body(pixels, job.camera, view, template=job.template, prior=job.prior)
