# SPDX-License-Identifier: MIT
"""Photographs to a track: what each shows, the floor and camera fitted to all, poses, smoothing."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from tracking.camera import Camera
from tracking.corrections import Correction, Move, replay
from tracking.detect import Detection, Robot, observe
from tracking.floor import FloorFit, FloorMap, FloorView, refine_floor
from tracking.images import read_pixels
from tracking.path import Observation, Track, assemble_track
from tracking.pose import BodyPrior
from zebro_lab.files.errors import DataError
from zebro_lab.robot.marker_numbers import strangers
from zebro_lab.track.annotations import Annotations, Click
from zebro_lab.track.photo_search import Look, Photo, Wanted, Watcher, search_photos

_HIGH = 3.0  # standard deviations by which the body may seem higher than robot.toml has it


@dataclass(frozen=True)
class Scene:
    """What is known before looking.

    Attributes:
        camera: The lens, at the size of the photographs.
        floor: The floor as measured.
        prior: Height and tilt of the body.
        robot: The robot with its marker; None where it is tracked by its own picture.
        said: What a person said about the photographs.
        workers: Processes to use.
    """

    camera: Camera
    floor: FloorMap
    prior: BodyPrior
    robot: Robot | None
    said: Annotations = field(default_factory=Annotations)
    workers: int = 1


@dataclass(frozen=True)
class FloorSeen:
    """The floor and the camera, and what each photograph shows.

    Attributes:
        fit: Floor and camera.
        detections: What the photographs show, in order of time.
        lost: Photographs that cannot be used, with the reason.
    """

    fit: FloorFit
    detections: tuple[Detection, ...]
    lost: Mapping[str, str]


@dataclass(frozen=True)
class Tracked:
    """A finished track.

    Attributes:
        track: The path.
        floor: Floor, camera and photographs behind it.
        lost: Photographs that gave no pose, with the reason.
        notes: For a person, one line each.
    """

    track: Track
    floor: FloorSeen
    lost: Mapping[str, str]
    notes: tuple[str, ...]


def see_floor(scene: Scene, photos: Sequence[Photo], watcher: Watcher) -> FloorSeen:
    """Look at all photographs and fit floor and camera to them.

    Args:
        scene: What is known.
        photos: The photographs, in order of time.
        watcher: Who follows.

    Returns:
        Floor and camera, and what each photograph shows.

    Raises:
        DataError: No photograph can be used.
        TrackingError: The floor's map does not fit.
        TrackStopped: Somebody asked to stop.
    """
    wanted = Wanted(scene.camera.size, scene.floor, scene.robot)
    looks = search_photos(photos, wanted, workers=scene.workers, watcher=watcher)
    detections = [look.seen for look in looks if look.seen is not None]
    lost = {look.photo: look.problem for look in looks if look.problem is not None}
    if not detections:
        raise DataError(_why_none(looks))
    views = [with_clicks(seen.floor, scene) for seen in detections]
    fit = refine_floor(scene.camera, scene.floor, views)
    return FloorSeen(fit, tuple(detections), lost | dict(fit.unused))


def track_marker(
    scene: Scene, robot: Robot, photos: Sequence[Photo], *,
    times: Mapping[str, tuple[float, float]], watcher: Watcher, gap: float | None = None,
) -> Tracked:  # fmt: skip
    """Track a robot by the marker on its back.

    Args:
        scene: What is known.
        robot: The robot.
        photos: The photographs, in order of time.
        times: By photograph, time and its standard deviation [s].
        watcher: Who follows.
        gap: Interval longer than which the path is interrupted; None for the tracker's own [s].

    Returns:
        The track.

    Raises:
        DataError: No photograph can be used.
        TrackingError: The floor's map does not fit, the robot is nowhere seen, or a correction
            cannot be replayed.
        TrackStopped: Somebody asked to stop.
    """
    seen = see_floor(scene, photos, watcher)
    observations = observe(scene.camera, seen.fit, seen.detections, robot=robot, times=times)
    if not observations and not scene.said.corrections:
        raise DataError(_robot_unseen(scene, robot, photos, seen))
    number = robot.marker.marker_id
    unseen = {
        detection.photo: f"the robot's marker {number} is not seen"
        for detection in seen.detections
        if detection.robot is None
    }
    return finish(scene, seen, observations, unseen=unseen, times=times, gap=gap)


def finish(
    scene: Scene, seen: FloorSeen, observations: Sequence[Observation], *,
    unseen: Mapping[str, str], times: Mapping[str, tuple[float, float]], gap: float | None,
) -> Tracked:  # fmt: skip
    """Replay corrections, smooth, and say what a person should know.

    Args:
        scene: What is known.
        seen: Floor and camera.
        observations: Where the robot was found.
        unseen: Photographs in which it was not, with the reason.
        times: By photograph, time and its standard deviation [s].
        gap: As in `track_marker` [s].

    Returns:
        The track.

    Raises:
        TrackingError: The robot is nowhere seen, or a correction cannot be replayed.
    """
    corrections = scene.said.corrections
    kept = replay(observations, corrections, times=times, z=scene.prior.height)
    track = assemble_track(kept, gap=gap)
    tracked = {seen.photo for seen in track.observations}
    deleted = {o.photo: "deleted by a correction" for o in observations if o.photo not in tracked}
    lost = {**seen.lost, **unseen, **deleted}
    lost = {photo: reason for photo, reason in lost.items() if photo not in tracked}
    notes = (*seen.fit.warnings, *_track_notes(track), *_height_note(track, scene.prior),
             *_correction_note(corrections))  # fmt: skip
    return Tracked(track, seen, lost, notes)


def with_clicks(view: FloorView, scene: Scene) -> FloorView:
    """Add the points of the floor that a person clicked on to what a photograph shows."""
    clicks = _clicks_for(view.photo, scene)
    if not clicks:
        return view
    clicked = FloorView.of(view.photo, clicked=clicks)
    return FloorView(
        view.photo, {**view.pixels, **clicked.pixels}, {**view.covariances, **clicked.covariances}
    )


def _clicks_for(photo: str, scene: Scene) -> Mapping[str, Click]:
    """Return a photograph's clicks; on a tripod those of one photograph hold for all.

    Where the floor has markers these place the camera in the other photographs.
    """
    clicks = scene.said.clicks
    if photo in clicks or scene.floor.markers or not clicks:
        return clicks.get(photo, {})
    return next(iter(clicks.values()))


def _why_none(looks: Sequence[Look]) -> str:
    reasons = Counter(look.problem for look in looks)
    common, count = reasons.most_common(1)[0]
    return (
        f"none of {len(looks)} photographs can be used; {looks[0].photo}: {looks[0].problem}"
        f"{f' ({count} of them so)' if common == looks[0].problem and count > 1 else ''}"
    )


def _robot_unseen(scene: Scene, robot: Robot, photos: Sequence[Photo], seen: FloorSeen) -> str:
    first = next(photo for photo in photos if photo.name == seen.detections[0].photo)
    other = strangers(read_pixels(first.path), robot, scene.floor)
    advice = f"look at {first.name} with --preview"
    if other is not None:
        advice = f"{first.name} shows {other}: correct [marker] of robot.toml, or --marker"
    marker = robot.marker
    return (
        f"the robot's marker {marker.marker_id} of '{marker.dictionary}' is seen in none of "
        f"{len(seen.detections)} photographs; {advice}"
    )


def _track_notes(track: Track) -> list[str]:
    of = track.observations
    notes = [
        f"nothing is seen for {of[k].t - of[k - 1].t:.1f} s before {of[k].photo}: the path is "
        "interrupted there"
        for k in np.flatnonzero(track.gap_before)
    ]
    notes += [
        f"{of[k].photo}: far from the path through its neighbours; look at it, and correct it "
        "with `zebro-lab annotate`"
        for k in np.flatnonzero(track.smoothed.suspect)
    ]
    return notes


def _height_note(track: Track, prior: BodyPrior) -> list[str]:
    higher = float(np.median([seen.z for seen in track.observations])) - prior.height
    if abs(higher) < _HIGH * prior.height_sd:
        return []
    return [
        f"the body seems {1e3 * abs(higher):.0f} mm {'higher' if higher > 0 else 'lower'} than "
        "stated; check marker.height in robot.toml, and the side of the marker (--marker)"
    ]


def _correction_note(corrections: Sequence[Correction]) -> list[str]:
    if not corrections:
        return []
    moved = sum(isinstance(correction, Move) for correction in corrections)
    return [f"{len(corrections)} corrections replayed, {moved} of them positions by hand"]
