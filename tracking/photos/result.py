# SPDX-License-Identifier: MIT
"""Assemble a track from observed poses: corrections, smoothing, notes for the user."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tracking.body import Alignment, AnnotatedPose, RefinedCorners
from tracking.corrections import Correction, Move, replay
from tracking.doubt import REMARKABLE, doubts, heading_doubts
from tracking.floor.doubt import suspicion
from tracking.images import PhotoTimes
from tracking.path import PoseObservation, Track, assemble_track
from tracking.photos.floor_seen import FloorSeen
from tracking.photos.scene import Scene
from tracking.shared import ANNOTATION, SharedErrors, annotation_name

Times = Mapping[str, tuple[float, float]]
"""By name of photograph or exposure, its time and the standard deviation of the time [s]."""


@dataclass(frozen=True)
class Tracked:
    """A finished track with the fitted floor and the photographs without a pose.

    Attributes:
        track: The smoothed path with covariance.
        floor: Fitted floor and camera, and the detections in each photograph.
        lost: By name of each photograph without a pose in the track, the reason: it cannot be used,
            does not show the robot, or its pose was deleted by a correction.
        notes: Notes and warnings for the user, one line each.
        corners: By name of annotated photograph, the corners of the top by clicks and edges.
    """

    track: Track
    floor: FloorSeen
    lost: Mapping[str, str]
    notes: tuple[str, ...]
    corners: Mapping[str, RefinedCorners] = field(default_factory=dict)


def times_by_name(names: Sequence[str], times: PhotoTimes) -> Times:
    """Convert times to a dictionary of (time, standard deviation) by name of photograph.

    Args:
        names: Names of the photographs.
        times: Times of the photographs [s], in the same order and number.
    """
    return dict(zip(names, zip(times.t.tolist(), times.sd.tolist(), strict=True), strict=True))


def observation_of(
    photo: str, alignment: Alignment, time: tuple[float, float], *, source: str, stand: int = 0,
    annotated: tuple[str, AnnotatedPose] | None = None,
) -> PoseObservation:  # fmt: skip
    """Convert a template alignment to an observation of the pose.

    Args:
        photo: Name of the photograph or exposure.
        alignment: The robot's pose with covariances and score.
        time: Time of the photograph and its standard deviation [s].
        source: "marker" or "body": what the template shows.
        stand: Number of the camera's stand, from 0.
        annotated: Where the template was cut out at an annotated pose, the name of its photograph
            and this pose, whose error is an error of the found pose too.
    """
    t, t_sd = time
    pose = alignment.pose
    name = "" if annotated is None else annotated[0]
    if annotated is not None and ANNOTATION not in pose.by_cause:
        moved = annotated[1].as_a_whole(float(pose.state[5]))
        pose = replace(pose, by_cause={**pose.by_cause, **moved})
    return PoseObservation(photo, t, t_sd, pose, alignment.score, source, stand, name)


def finish(
    scene: Scene, seen: FloorSeen, observations: Sequence[PoseObservation], *,
    unseen: Mapping[str, str], times: Times, gap: float | None,
    annotations: Mapping[str, AnnotatedPose] | None = None,
    again: Sequence[PoseObservation] = (),
) -> Tracked:  # fmt: skip
    """Apply corrections, smooth the poses, and collect notes for the user.

    Args:
        scene: Scene, of which prior and corrections are used.
        seen: Fitted floor and camera, and photographs that cannot be used.
        observations: Poses observed by the tracker.
        unseen: By name of each photograph in which the robot was not found, the reason.
        times: By photograph, time and its standard deviation [s].
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        annotations: By name of photograph, the annotated poses at which templates were cut out;
            None for none.
        again: Poses in annotated photographs by the templates of other annotated photographs.

    Returns:
        The track, with the warnings of the floor fit and notes on stated values that do not fit,
        gaps, outliers and corrections, each where there are any.

    Raises:
        TrackingError: No observation is left, two have the same time, or a correction is invalid.
    """
    kept = replay(observations, scene.corrections, times=times, prior=scene.prior)
    shared = shared_errors(scene, seen)
    for photo, annotated in (annotations or {}).items():
        shared = shared.also(annotation_name(photo), annotated.covariance)
    # `again` has further poses of photographs: not of those whose pose a correction changed.
    unchanged = {id(each) for each in kept} & {id(each) for each in observations}
    same = {each.photo for each in observations if id(each) in unchanged}
    again = [each for each in again if each.photo in same]
    track = assemble_track(kept, shared=shared, prior=scene.prior, gap=gap, again=again)
    tracked = {seen.photo for seen in track.observations}
    deleted = {o.photo: "deleted by a correction" for o in observations if o.photo not in tracked}
    lost = {**seen.lost, **unseen, **deleted}
    lost = {photo: reason for photo, reason in lost.items() if photo not in tracked}
    notes = (*seen.fit.warnings, *_robot_notes(track, seen), *_track_notes(track),
             *_correction_note(scene.corrections))  # fmt: skip
    return Tracked(track, seen, lost, notes)


def _robot_notes(track: Track, seen: FloorSeen) -> tuple[str, ...]:
    """Return warnings of stated values of the robot that do not fit.

    Where a value of lens or floor does not fit (`FloorFit.suspicion`), only the heading is judged:
    what is wrong there also shows in the size and height of the robot.
    """
    if seen.fit.suspicion:
        return heading_doubts(track)
    return (*suspicion(doubts(track), remarkable=REMARKABLE), *heading_doubts(track))


def shared_errors(scene: Scene, seen: FloorSeen) -> SharedErrors:
    """Join the errors of camera and floor with those of the robot's marker and prior.

    Args:
        scene: Scene, of which robot and prior are used.
        seen: Fitted floor and camera.
    """
    shared = seen.fit.shared
    robot = {} if scene.robot is None else scene.robot.marker.spreads
    for cause, covariance in {**robot, **scene.prior.spreads}.items():
        shared = shared.also(cause, covariance)
    return shared


def _track_notes(track: Track) -> list[str]:
    """Name gaps of the path, and poses far from it."""
    of = track.observations
    notes = [
        f"no pose is found in the {of[k].t - of[k - 1].t:.1f} s before {of[k].photo}: the path is "
        "interrupted there (--gap is the longest time without interruption)"
        for k in np.flatnonzero(track.gap_before)
    ]
    notes += [
        f"{of[k].photo}: its pose is far from the path through its neighbours; look at the "
        "photograph, and move, flip or delete the pose with `zebro-lab annotate`"
        for k in np.flatnonzero(track.smoothed.suspect)
    ]
    return notes


def _correction_note(corrections: Sequence[Correction]) -> list[str]:
    """Say how many corrections are applied, if there are any."""
    if not corrections:
        return []
    moved = sum(isinstance(correction, Move) for correction in corrections)
    return [f"{len(corrections)} corrections are applied; {moved} of them set a pose by hand"]
