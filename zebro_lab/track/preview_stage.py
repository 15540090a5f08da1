# SPDX-License-Identifier: MIT
"""Draw the preview of a track: what is detected in the first photograph."""

from contextlib import ExitStack
from dataclasses import replace
from io import BytesIO
from pathlib import Path

from tracking.errors import TimesError
from tracking.images import read_pixels
from tracking.photos.preview import Preview, preview_photo
from zebro_lab.files.atomic import atomic_write_bytes
from zebro_lab.files.own_file import picture, require_own
from zebro_lab.files.source_names import is_simulated
from zebro_lab.track.inputs import lens_note, read_inputs
from zebro_lab.track.photo_sequence import PhotoSequence, open_photos
from zebro_lab.track.photographs import PlacedPhoto
from zebro_lab.track.request import TimeRequest, TrackRequest

PREVIEW = picture("track --preview")


def preview(request: TrackRequest, file: Path) -> Preview:
    """Detect marks in the first photograph by time, draw them in a PNG, and return what was found.

    Without times it is the first by name. In a composite picture no robot is searched.

    Args:
        request: Options of `zebro-lab track`.
        file: The PNG to write; an earlier preview is replaced.

    Raises:
        ZebroLabError: A file or an option is invalid.
        TrackingError: There is no photograph, given times are invalid, the first photograph is
            unreadable, shows fewer than 4 points of the floor or the robot's marker twice, or the
            floor's map does not fit its marks or has the robot's marker.
    """
    from zebro_lab.track import pictures  # matplotlib takes most of a second

    target = require_own(file, PREVIEW, inputs=request.inputs)
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
    """Open the photographs, by name if none has a time and no option gives it."""
    try:
        return stack.enter_context(open_photos(request.photos, request.times, frames=1))
    except TimesError:
        if request.times != TimeRequest():
            raise
        by_name = TimeRequest(interval=1.0)
        return stack.enter_context(open_photos(request.photos, by_name, frames=1))
