# SPDX-License-Identifier: MIT
"""Track a robot by the marker on its back."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tracking.corrections import Correction, Flip, replay
from tracking.detect import Detection, MarkedRobot, observe
from tracking.errors import NoUsablePhoto
from tracking.floor import EDGE_SPREADS, EdgeSpread, FloorFit, FloorMap
from tracking.images import read_pixels
from tracking.markers import find_markers, guess_dictionary, marker_family
from tracking.path import assemble_track
from tracking.photos.floor_seen import FloorSeen, see_floor
from tracking.photos.result import Times, Tracked, finish, shared_errors
from tracking.photos.scene import Photo, Scene
from tracking.photos.workers import Progress
from tracking.shared import SharedErrors

_LONGEST = 100  # photographs from which the spread of edges is estimated
_NEGLIGIBLE = 1e-3  # probability by the floor's markers of a spread that the walk must ask for


def edge_spread(
    fit: FloorFit, detections: Sequence[Detection], *, robot: MarkedRobot, times: Times,
    shared: SharedErrors, gap: float | None, corrections: Sequence[Correction] = (),
) -> EdgeSpread:  # fmt: skip
    """Weigh the spreads that the floor's markers leave by the likelihood of the walk.

    Args:
        fit: The camera and the floor, with the edges of its markers.
        detections: Markers detected in each photograph, of which the first 100 with the robot's
            are used.
        robot: The robot's marker and prior.
        times: By photograph, time and its standard deviation [s].
        shared: Covariance of the errors that photographs share.
        gap: Interval longer than which the path is interrupted [s]; None for 3.5 times the median
            interval.
        corrections: Manual corrections; photographs whose pose they delete or set are not used.

    Returns:
        The spread by floor and walk; that of `fit` where fewer than 3 photographs are usable. The
        walk's likelihood is made non-decreasing: it tells only how large the spread is at least.
        Spreads below the first that the floor's markers give over `_NEGLIGIBLE` get probability 0.

    Raises:
        CorrectionError: A correction names a photograph without a pose, or whose pose an earlier
            one has deleted.
        PathError: Two photographs have the same time.
    """
    usable = [each for each in detections if each.robot is not None]
    usable = [each for each in usable if each.photo not in fit.unused]
    flips: list[Flip] = []
    if corrections:
        poses = observe(fit, usable, robot=robot, times=times)
        poses = replay(poses, corrections, prior=robot.prior, times=times)
        kept = {each.photo: (each.t, each.t_sd) for each in poses if each.source == "marker"}
        usable, times = [each for each in usable if each.photo in kept], kept
        usable.sort(key=lambda each: kept[each.photo])
        flips = [each for each in corrections if isinstance(each, Flip)]
    usable = usable[:_LONGEST]
    flips = [each for each in flips if each.photo in {seen.photo for seen in usable}]
    known = fit.edge_spread
    if len(usable) < 3:
        return known
    logs = np.full(len(EDGE_SPREADS), -np.inf)
    process = None
    first = int(np.argmax(known.weights > _NEGLIGIBLE))
    for k in range(first, len(EDGE_SPREADS)):
        if known.weights[k] <= _NEGLIGIBLE and logs[k - 1] < logs.max():
            break  # neither the floor's markers nor the walk ask for still larger spreads
        seen = observe(fit, usable, robot=robot, times=times, edge_sd=float(EDGE_SPREADS[k]))
        seen = replay(seen, flips, prior=robot.prior)
        track = assemble_track(seen, shared=shared, prior=robot.prior, gap=gap, start=process,
                               average=False)  # fmt: skip
        process = track.smoothed.process
        logs[k] = track.smoothed.log_likelihood + sum(each.pose.log_evidence for each in seen)
    return EdgeSpread(known.log_weights + np.maximum.accumulate(logs))


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
    """Say that no photograph shows the robot's marker, and which others the first one shows."""
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
