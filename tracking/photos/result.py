# SPDX-License-Identifier: MIT
"""Assemble a track from observed poses: corrections, smoothing, notes for the user."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tracking.body import Alignment
from tracking.corrections import Correction, Move, replay
from tracking.images import PhotoTimes
from tracking.path import PoseObservation, Track, assemble_track
from tracking.photos.floor_seen import FloorSeen
from tracking.photos.scene import Scene
from tracking.pose import BodyPrior

Times = Mapping[str, tuple[float, float]]
"""By name of photograph or exposure, its time and the standard deviation of the time [s]."""

_HIGH = 3.0  # standard deviations of height above robot.toml's that are put down to chance


@dataclass(frozen=True)
class Tracked:
    """A finished track with the fitted floor and the photographs without a pose.

    Attributes:
        track: The smoothed path with covariance.
        floor: Fitted floor and camera, and the detections in each photograph.
        lost: By name of each photograph without a pose in the track, the reason: it cannot be used,
            does not show the robot, or its pose was deleted by a correction.
        notes: Notes and warnings for the user, one line each.
    """

    track: Track
    floor: FloorSeen
    lost: Mapping[str, str]
    notes: tuple[str, ...]


def times_by_name(names: Sequence[str], times: PhotoTimes) -> Times:
    """Convert times to a dictionary of (time, standard deviation) by name of photograph.

    Args:
        names: Names of the photographs.
        times: Times of the photographs [s], in the same order and number.
    """
    return dict(zip(names, zip(times.t.tolist(), times.sd.tolist(), strict=True), strict=True))


def observation_of(
    photo: str, alignment: Alignment, time: tuple[float, float], *, source: str
) -> PoseObservation:
    """Convert a template alignment to an observation of the pose.

    Args:
        photo: Name of the photograph or exposure.
        alignment: The robot's pose with covariances and score.
        time: Time of the photograph and its standard deviation [s].
        source: "marker" or "body": what the template shows.
    """
    t, t_sd = time
    return PoseObservation.of(
        photo, alignment.pose, t=t, t_sd=t_sd, score=alignment.score, source=source
    )


def finish(
    scene: Scene, seen: FloorSeen, observations: Sequence[PoseObservation], *,
    unseen: Mapping[str, str], times: Times, gap: float | None,
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

    Returns:
        The track, with the warnings of the floor fit and notes on gaps, outliers, a median height 3
        or more standard deviations off the prior's, and corrections, each where there are any.

    Raises:
        TrackingError: No observation is left, two have the same time, or a correction is invalid.
    """
    kept = replay(observations, scene.corrections, times=times, z=scene.prior.height)
    track = assemble_track(kept, gap=gap)
    tracked = {seen.photo for seen in track.observations}
    deleted = {o.photo: "deleted by a correction" for o in observations if o.photo not in tracked}
    lost = {**seen.lost, **unseen, **deleted}
    lost = {photo: reason for photo, reason in lost.items() if photo not in tracked}
    notes = (*seen.fit.warnings, *_track_notes(track), *_height_note(track, scene.prior),
             *_correction_note(scene.corrections))  # fmt: skip
    return Tracked(track, seen, lost, notes)


def _track_notes(track: Track) -> list[str]:
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


def _height_note(track: Track, prior: BodyPrior) -> list[str]:
    higher = float(np.median([seen.z for seen in track.observations])) - prior.height
    if abs(higher) < _HIGH * prior.height_sd:
        return []
    return [
        f"the robot's body is {1e3 * abs(higher):.0f} mm {'higher' if higher > 0 else 'lower'} in "
        f"the photographs than expected ({1e3 * prior.height:.0f} mm above the floor); check "
        "marker.height in robot.toml (or --body-height) and the side of the marker (--marker)"
    ]


def _correction_note(corrections: Sequence[Correction]) -> list[str]:
    if not corrections:
        return []
    moved = sum(isinstance(correction, Move) for correction in corrections)
    return [f"{len(corrections)} corrections are applied; {moved} of them set a pose by hand"]
