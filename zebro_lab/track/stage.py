# SPDX-License-Identifier: MIT
"""Stages of `zebro-lab track`: track photographs into a track folder; preview the first one."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path

import numpy as np

from tracking import Tracked, track_photos
from tracking.contributions import contributions, shared_part
from tracking.errors import TimesError
from tracking.images import PhotoTimes, read_pixels
from tracking.photos.preview import PhotoPreview, preview_photo
from tracking.photos.workers import PROCESSES, Progress
from zebro_lab.files.atomic import atomic_write_bytes
from zebro_lab.files.picture_format import PictureFormat
from zebro_lab.files.provenance import file_hashes
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.files.single_file import picture, require_overwritable
from zebro_lab.files.source_names import is_simulated
from zebro_lab.robot.marker_print import MarkerPrint
from zebro_lab.track import pictures
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
from zebro_lab.track.request import TimeRequest, TrackRequest

PREVIEW = picture("track --preview")


def preview(request: TrackRequest, file: Path) -> PhotoPreview:
    """Detect marks in the first photograph by time, draw them in a PNG, and return what was found.

    If half of the photographs or more lack an EXIF time, and no time option is given, it is the
    first by name. In a composite picture no robot is searched.

    Args:
        request: Options of `zebro-lab track`.
        file: The PNG to write; an earlier preview is replaced.

    Raises:
        ZebroLabError: A file or an option is invalid.
        TrackingError: There is no photograph, given times are invalid, the first photograph is
            unreadable, shows fewer than 4 points of the floor or the robot's marker twice, or the
            floor's map does not fit its marks or has the robot's marker.
    """
    target = require_overwritable(file, PREVIEW, inputs=request.inputs)
    inputs = read_inputs(request)
    with ExitStack() as stack:
        sequence = _first_photos(request, stack)
        scene, photo = inputs.scene_of(sequence), sequence.photos[0]
        if sequence.is_composite:
            scene = replace(scene, robot=None)
        found = preview_photo(scene, photo)
        drawn = BytesIO()
        pictures.draw_preview(
            drawn, PlacedPhoto(read_pixels(photo.path), found.camera, found.pose),
            floor=scene.floor, detection=found.detection, title=f"Preview: {photo.name}",
            simulated=is_simulated(inputs.source_of(sequence)), command=PREVIEW.command,
        )  # fmt: skip
        atomic_write_bytes(target, drawn.getvalue())
        return replace(found, warnings=(*lens_note(inputs), *found.warnings))


def _first_photos(request: TrackRequest, stack: ExitStack) -> PhotoSequence:
    """Open the photographs, or the first frame of a video; without times, sort them by name.

    Names decide if half of the photographs or more lack an EXIF time and no time option is given.

    Args:
        request: Options of `zebro-lab track`.
        stack: What closes the photographs, when the caller's `with` statement ends.
    """
    try:
        return stack.enter_context(open_photos(request.photos, request.times, frames=1))
    except TimesError:
        if request.times != TimeRequest():
            raise
        by_name = TimeRequest(interval=1.0)  # only orders: a preview has no use for times
        return stack.enter_context(open_photos(request.photos, by_name, frames=1))


@dataclass(frozen=True)
class TrackResult:
    """Written track.

    Attributes:
        folder: The track folder.
        tracked: Track, floor fit, left-out photographs and notes.
        photos: Number of photographs, including those left out; for a composite picture, number of
            its tracked exposures.
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
    """Return a function from names to times; only times of exposures depend on the names."""
    times = counted.times
    if times is None:
        return lambda names: exposure_times(names, request.times)
    return lambda _: times


def _result(
    inputs: TrackInputs, sequence: PhotoSequence, tracked: Tracked, counted: CountedTimes
) -> TrackResult:
    """Return the result; add left-out photographs and notes known before tracking to `tracked`."""
    lost = {**sequence.left_out, **tracked.lost}
    notes = (*counted.notes, *lens_note(inputs), *tracked.notes)
    tracked = replace(tracked, lost=lost, notes=notes)
    count = len(sequence.photos) + len(sequence.left_out)
    if sequence.is_composite:
        count = len(tracked.track.observations)
    source = inputs.source_of(sequence)
    return TrackResult(
        inputs.request.folder, tracked, count, source, counted.description, sequence.is_composite
    )


def _write(inputs: TrackInputs, sequence: PhotoSequence, result: TrackResult) -> None:
    """Write the track folder: poses, joint covariance, refined floor, annotations, pictures."""
    request, found, seen = inputs.request, result.tracked.track, result.tracked.floor
    is_file = sequence.origin.is_file()
    photos = [sequence.origin] if is_file else [photo.path for photo in sequence.photos]
    with track_folder(
        result.folder,
        found.columns,
        tum=found.tum,
        source=result.source,
        settings=_settings(inputs, sequence),
        inputs=file_hashes([*request.named, *photos]),
        report=_report(result),
    ) as draft:
        write_joint(draft, np.asarray(found.t, dtype=float), found.joint, found.shared.slots)
        heading = f"The floor of {request.floor.name}, refined with the photographs."
        (draft / FLOOR_FILE).write_text(
            render_floor_file(seen.fit.floor, heading=heading), encoding="utf-8"
        )
        if request.annotations is not None:
            (draft / ANNOTATIONS_FILE).write_text(
                render_annotations(inputs.annotations), encoding="utf-8"
            )
        _draw(draft, result, sequence, request.form)


def _draw(draft: Path, result: TrackResult, sequence: PhotoSequence, form: PictureFormat) -> None:
    """Draw the pictures of the track folder over the photograph of the last pose."""
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
    """Return the manifest's entries on times, left-out photographs, uncertainty and floor."""
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
    """Round shares of the variance of position and of yaw [-] for the manifest."""
    return {"position": round(position, 4), "yaw": round(yaw, 4)}


def _settings(inputs: TrackInputs, sequence: PhotoSequence) -> Mapping[str, object]:
    """Return the options of a track for the manifest, JSON-serialisable, in SI."""
    request, robot = inputs.request, inputs.scene.robot
    marker = None if robot is None else robot.marker
    return {
        "photos": request.photos.name,
        "marker": marker and MarkerPrint(marker.dictionary, marker.marker_id, marker.side).text,
        "interval": request.times.interval,
        "every": request.times.frame_step if sequence.is_video else None,
        "start": None if request.start is None else request.start.isoformat(),
        "body_height": request.stated_height,
        "mean_height_sd": request.stated_mean_height_sd,
        "height_sd": request.bounce_sd,
        "gap": request.gap,
    }
