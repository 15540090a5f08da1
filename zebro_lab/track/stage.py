# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab track`: track photographs into a track folder."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tracking import Tracked, track_photos
from tracking.contributions import contributions, shared_part
from tracking.images import PhotoTimes, read_pixels
from tracking.photos.workers import PROCESSES, Progress
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.files.source_names import is_simulated
from zebro_lab.robot.marker_print import MarkerPrint
from zebro_lab.track.annotations import ANNOTATIONS_FILE, render_annotations
from zebro_lab.track.clock import CountedTimes
from zebro_lab.track.floor_file import FLOOR_FILE, render_floor_file
from zebro_lab.track.folder import TRACKED, track_folder
from zebro_lab.track.inputs import TrackInputs, lens_note, read_inputs
from zebro_lab.track.joint_file import write_joint
from zebro_lab.track.photo_sequence import (
    PhotoSequence,
    exposure_times,
    open_photos,
)
from zebro_lab.track.photographs import PlacedPhoto
from zebro_lab.track.request import TrackRequest


@dataclass(frozen=True)
class TrackResult:
    """Written track.

    Attributes:
        folder: The track folder.
        tracked: Track, floor fit, left-out photographs and notes.
        photos: Number of photographs, left-out ones included; of a composite, tracked exposures.
        source: Source of the photographs: "real", "sim:what" or "unknown".
        times: Source and origin of the times, in words.
        is_composite: Whether the photographs are exposures of one picture.
    """

    folder: Path
    tracked: Tracked
    photos: int
    source: str
    times: str
    is_composite: bool = False


def track(request: TrackRequest, watcher: Progress, *, workers: int = PROCESSES) -> TrackResult:
    """Track a walk in photographs and write the track folder.

    Args:
        request: Photographs, files and options.
        watcher: Progress display, which may also request a stop.
        workers: Largest number of processes.

    Raises:
        ZebroLabError: A file or an option is invalid, or the folder cannot be replaced or written.
        TrackingError: The photographs do not give a track.
        TrackStopped: A stop was requested.
    """
    require_replaceable(request.folder, TRACKED, inputs=request.inputs)
    inputs = read_inputs(request)
    with open_photos(request.photos, request.times, progress=watcher) as sequence:
        inputs.require_complete()
        counted = inputs.counted_times(sequence)
        tracked = track_photos(
            inputs.scene_of(sequence), sequence.photos, times_of=_times_of(counted, request),
            gap=request.gap, workers=workers, progress=watcher,
        )  # fmt: skip
        result = _result(inputs, sequence, tracked, counted)
        watcher.step("pictures", None)
        _write(inputs, sequence, result)
    return result


def _times_of(
    counted: CountedTimes, request: TrackRequest
) -> Callable[[Sequence[str]], PhotoTimes]:
    times = counted.times
    if times is None:
        return lambda names: exposure_times(names, request.times)
    return lambda _: times


def _result(
    inputs: TrackInputs, sequence: PhotoSequence, tracked: Tracked, counted: CountedTimes
) -> TrackResult:
    """Return the result; add left-out photographs and notes known before tracking to `tracked`."""
    lost = {**sequence.left_out, **tracked.lost}
    notes = (*sequence.notes, *counted.notes, *lens_note(inputs), *tracked.notes)
    tracked = replace(tracked, lost=lost, notes=notes)
    count = len(sequence.photos) + len(sequence.left_out)
    if sequence.is_composite:
        count = len(tracked.track.observations)
    source = inputs.source_of(sequence)
    return TrackResult(
        inputs.request.folder, tracked, count, source, counted.description, sequence.is_composite
    )


def _write(inputs: TrackInputs, sequence: PhotoSequence, result: TrackResult) -> None:
    request, found, seen = inputs.request, result.tracked.track, result.tracked.floor
    is_file = sequence.origin.is_file()
    photos = [sequence.origin] if is_file else [photo.path for photo in sequence.photos]
    with track_folder(
        result.folder,
        found.columns,
        tum=found.tum,
        source=result.source,
        settings=_settings(inputs),
        inputs=file_hashes([*request.named, *photos]),
        report=_report(result),
    ) as draft:
        write_joint(draft, np.asarray(found.t, dtype=float), found.joint, found.shared.slots)
        heading = f"The floor of {request.floor.name}, refined with the photographs."
        (draft / FLOOR_FILE).write_text(render_floor_file(seen.fit.floor, heading=heading))
        if request.annotations is not None:
            (draft / ANNOTATIONS_FILE).write_text(render_annotations(inputs.annotations))
        _draw(draft, result, sequence, request.form)


def _draw(draft: Path, result: TrackResult, sequence: PhotoSequence, form: PictureFormat) -> None:
    from zebro_lab.track import pictures  # matplotlib takes most of a second

    track, seen = result.tracked.track, result.tracked.floor
    # In the last photograph the robot no longer hides the floor where the path begins.
    last = track.observations[-1].photo.rpartition("#")[0] if sequence.is_composite else None
    shown = last or track.observations[-1].photo
    path = next(photo.path for photo in sequence.photos if photo.name == shown)
    detection = next((each for each in seen.detections if each.photo == shown), None)
    pictures.draw_track(
        draft, track, PlacedPhoto(read_pixels(path), seen.fit.camera, seen.fit.pose_of(shown)),
        floor=seen.fit.floor, detection=detection,
        title=sequence.origin.name,
        simulated=is_simulated(result.source), form=form,
    )  # fmt: skip


def _report(result: TrackResult) -> Mapping[str, object]:
    fit = result.tracked.floor.fit
    return {
        "times": result.times,
        "photos": result.photos,
        "tracked": len(result.tracked.track.observations),
        "left_out": dict(result.tracked.lost),
        "notes": list(result.tracked.notes),
        "uncertainty": {
            "shared": _parts(*shared_part(result.tracked.track)),
            "causes": {
                each.cause: _parts(each.position, each.yaw)
                for each in contributions(result.tracked.track)
            },
        },
        "annotated": {
            photo: {"edges": each.sides, "moved_px": round(each.moved, 3)}
            for photo, each in result.tracked.corners.items()
        },
        "floor_misfit_px": fit.misfit_px,
        "camera_stands": len(fit.stands),
    }


def _parts(position: float, yaw: float) -> Mapping[str, float]:
    return {"position": round(position, 4), "yaw": round(yaw, 4)}


def _settings(inputs: TrackInputs) -> Mapping[str, object]:
    request, robot = inputs.request, inputs.scene.robot
    marker = None if robot is None else robot.marker
    return {
        "photos": request.photos.name,
        "marker": marker and MarkerPrint(marker.dictionary, marker.marker_id, marker.side).text,
        "interval": request.times.interval,
        "every": request.times.frame_step,
        "start": None if request.start is None else request.start.isoformat(),
        "body_height": request.stated_height,
        "mean_height_sd": request.stated_mean_height_sd,
        "height_sd": request.bounce_sd,
        "gap": request.gap,
    }
