# SPDX-License-Identifier: MIT
"""Open photographs of a folder, frames of a video, or one composite picture, with their times."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np

from tracking.camera import Camera
from tracking.errors import PhotoError
from tracking.images import (
    PhotoTimes,
    clock_offset,
    exif_time,
    find_photos,
    open_picture,
    times_from_exif,
    times_from_interval,
    times_from_table,
    video_frames,
)
from tracking.photos.scene import Photo
from tracking.photos.workers import Progress, report_step
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.files.provenance import file_hash
from zebro_lab.track.request import VIDEOS, TimeRequest

MOST_APART = 100.0
"""Factor by which `--interval` may differ from EXIF times, whose clocks run a bit fast or slow."""
_ORIENTATION = 0x0112
_ROTATED = {5, 6, 7, 8}


@dataclass(frozen=True)
class PhotoSequence:
    """Photographs in order of time.

    Attributes:
        photos: The n photographs; for a composite picture the one file.
        times: Times of the photographs, shape (n,) [s]; None for a composite picture.
        source: "sim:photographs" if a file's EXIF data say that it is simulated, else None.
        origin: Folder, video or picture, as given.
        left_out: Reason by name of each photograph of the folder that is not used for lack of a
            time.
    """

    photos: tuple[Photo, ...]
    times: PhotoTimes | None
    source: str | None
    origin: Path
    left_out: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_composite(self) -> bool:
        """Whether the photographs are one picture with many exposures."""
        return self.times is None

    @property
    def is_video(self) -> bool:
        """Whether the photographs are frames of a video."""
        return self.origin.suffix.lower() in VIDEOS and not self.origin.is_dir()


@contextmanager
def open_photos(
    origin: Path,
    request: TimeRequest,
    *,
    progress: Progress | None = None,
    frames: int | None = None,
) -> Iterator[PhotoSequence]:
    """Find photographs and their times; leave out copies and pictures without a time.

    In a folder, the photograph given as `--clock` is skipped, as it does not show the walk. Copies,
    equal byte for byte, are left out unless a table gives the times. If neither a table nor an
    interval gives them, pictures without EXIF time are left out, provided that under half lack it.
    Frames of a video are kept in a temporary folder until the `with` statement ends.

    Args:
        origin: Folder of photographs, video, or one composite picture.
        request: How the photographs get their times.
        progress: Where progress is reported while a video is read, or None.
        frames: Largest number of frames of a video; None for all.

    Yields:
        The photographs in order of time.

    Raises:
        NotFound: `origin` does not exist.
        SettingsError: A video is given together with an interval, a table of times or a clock, or
            photographs with a step between frames.
        DataError: The folder holds only the photograph given as `--clock`, or frames of a video
            cannot be written to the temporary folder.
        TrackingError: The folder has no photograph, times are missing, or a file is unreadable.
        TrackStopped: A stop was requested.
    """
    is_video = origin.suffix.lower() in VIDEOS and not origin.is_dir()
    _require_meant_for(request, is_video=is_video)
    if origin.is_dir():
        yield _of_folder(origin, request)
    elif not origin.is_file():
        raise NotFound(f"{origin}: no such folder, video or picture; working in {Path.cwd()}")
    elif is_video:
        with TemporaryDirectory(prefix="zebro-lab-") as folder:
            yield _of_video(origin, Path(folder), request.frame_step, frames, progress)
    else:
        yield PhotoSequence((Photo(origin.name, origin),), None, _simulated(origin), origin)


def calibrated_for(camera: Camera, sequence: PhotoSequence) -> Camera:
    """Scale the lens to the size of most of the photographs, unless none is readable.

    Args:
        camera: The lens as calibrated.
        sequence: The photographs.

    Raises:
        DataError: The photographs' aspect ratio differs from the calibration's.
    """
    # Frames of a video have one size, and Pillow decodes a PNG to look for its EXIF data.
    looked_at = sequence.photos[: 1 if sequence.is_video else None]
    sizes = Counter(size for photo in looked_at if (size := upright_size(photo.path)))
    if not sizes:
        return camera
    try:
        return camera.scaled(sizes.most_common(1)[0][0])
    except ValueError as error:
        raise DataError(str(error), file=sequence.origin) from error


def upright_size(path: Path) -> tuple[int, int] | None:
    """Read width and height [px] of a picture after EXIF rotation; None if it is unreadable."""
    try:
        with open_picture(path) as picture:
            width, height = picture.size
            rotated = picture.getexif().get(_ORIENTATION) in _ROTATED
    except PhotoError:
        return None
    return (height, width) if rotated else (width, height)


def exposure_times(names: Sequence[str], request: TimeRequest) -> PhotoTimes:
    """Compute the times of a composite picture's exposures from a table or an interval.

    Args:
        names: Names of the n exposures, in order of time.
        request: Interval, or table of times by name.

    Returns:
        Times and standard deviations, shape (n,) each [s].

    Raises:
        SettingsError: Neither an interval nor a table was given.
        TrackingError: The interval is not above 0, or the table is invalid or lacks an exposure.
    """
    times = _given_times([Path(name) for name in names], request)
    if times is None:
        raise SettingsError(
            f"a composite picture has no times; give the interval between its {len(names)} "
            f"exposures in seconds, or a table of their times with --times",
            key="--interval",
        )
    return times


def _given_times(paths: Sequence[Path], request: TimeRequest) -> PhotoTimes | None:
    """Return the times in the given table, else multiples of the interval; None without either."""
    if request.table is not None:
        return times_from_table(request.table, paths)
    if request.interval is not None:
        return times_from_interval(len(paths), request.interval)
    return None


def _of_folder(folder: Path, request: TimeRequest) -> PhotoSequence:
    """Return the photographs of a folder in order of time, as described in `open_photos`."""
    clock = None if request.clock is None else request.clock.resolve()
    paths = tuple(path for path in find_photos(folder) if path.resolve() != clock)
    if not paths:
        raise DataError(
            "holds no photograph but that of --clock; expected photographs of the walk", file=folder
        )
    copies = {} if request.table is not None else _copies(paths)
    paths = tuple(path for path in paths if path.name not in copies)
    left_out: Mapping[str, str] = {}
    times = _given_times(paths, request)
    if times is not None:
        _require_as_exif(paths, times, request)
    if times is None:
        # A file that is no picture has no EXIF either; its error is reported later.
        readable = [path for path in paths if upright_size(path) is not None]
        left_out = _without_time(readable)
        paths = tuple(path for path in paths if path.name not in left_out)
        times = _spread([path for path in readable if path.name not in left_out], paths)
    if request.clock is not None:
        times = _by_computer(times, request.clock)
    order = np.argsort(times.t, kind="stable")
    photos = tuple(Photo(paths[k].name, paths[k]) for k in order)
    source = next((found for photo in photos if (found := _simulated(photo.path))), None)
    ordered = PhotoTimes(times.t[order], times.sd[order], times.source)
    return PhotoSequence(photos, ordered, source, folder, {**copies, **left_out})


def _copies(paths: Sequence[Path]) -> Mapping[str, str]:
    """Return a reason by name to leave out each copy of another file, equal byte for byte.

    Of equal files the one with the shortest name is kept. Files without EXIF time are not compared.
    """
    sizes = Counter(path.stat().st_size for path in paths)
    originals: dict[str, str] = {}
    copies = {}
    for path in sorted(paths, key=lambda each: (len(each.name), each.name)):
        if sizes[path.stat().st_size] == 1 or exif_time(path) is None:
            continue
        original = originals.setdefault(file_hash(path), path.name)
        if original != path.name:
            copies[path.name] = f"a copy of {original}, byte for byte; delete one of them"
    return copies


def _require_as_exif(paths: Sequence[Path], times: PhotoTimes, request: TimeRequest) -> None:
    """Raise `SettingsError` if given and EXIF times differ in order of magnitude.

    Their median intervals may differ by a factor of up to `MOST_APART`. Nothing is checked unless
    all photographs, two or more, have EXIF times, whose median interval is above 0.
    """
    taken = [exif_time(path) for path in paths]
    t = np.sort([each[0] for each in taken if each is not None])
    if len(t) < 2 or len(t) < len(paths):
        return
    apart, given = (float(np.median(np.diff(each))) for each in (t, np.sort(times.t)))
    if apart > 0 and not 1 / MOST_APART < given / apart < MOST_APART:
        raise SettingsError(
            f"found {given:g} s between photographs, which by their EXIF times are {apart:g} s "
            "apart; it is in seconds, and without the option the EXIF times are used",
            key="--interval" if request.table is None else "--times",
        )


def _without_time(readable: Sequence[Path]) -> Mapping[str, str]:
    """Return a reason for each picture without EXIF time, if under half lack it; else empty."""
    without = [path for path in readable if exif_time(path) is None]
    if 2 * len(without) >= len(readable):
        return {}
    return {
        path.name: "no EXIF time; give all times with --interval or --times" for path in without
    }


def _spread(readable: list[Path], paths: tuple[Path, ...]) -> PhotoTimes:
    """Read EXIF times of the readable files; give any other path the time of the one before it.

    Paths before the first readable one have its time; all are 0 if none is readable.
    """
    if not readable:
        return PhotoTimes(np.zeros(len(paths)), np.zeros(len(paths)), "none: nothing can be read")
    times = times_from_exif(readable)
    place = {path: k for k, path in enumerate(readable)}
    last, index = 0, []
    for path in paths:
        last = place.get(path, last)
        index.append(last)
    return PhotoTimes(times.t[index], times.sd[index], times.source)


def _by_computer(times: PhotoTimes, clock: Path) -> PhotoTimes:
    """Convert times of the camera's clock to the computer's, by a photograph of its code."""
    offset = clock_offset(clock)
    # The offset's error is common to all photographs: it is stated once, not added to each.
    ahead = f"camera's clock {offset.seconds:+.3f} s (sd {offset.sd:.3f} s) ahead of the computer's"
    return PhotoTimes(times.t - offset.seconds, times.sd, f"{times.source}; {ahead}")


def _of_video(
    video: Path, folder: Path, every: float, most: int | None, progress: Progress | None
) -> PhotoSequence:
    """Write frames of a video as PNG into a folder; return them with their time stamps.

    Args:
        video: The video.
        folder: Existing folder for the frames.
        every: Least time between two frames [s]; 0 takes all.
        most: Largest number of frames; None for all.
        progress: Where each frame is reported, or None.
    """
    photos, t, sd = [], [], []

    for frame in islice(video_frames(video, every=every), most):
        if progress is not None:
            report_step(progress, "frames", None)
        path = folder / f"{len(photos):06d}.png"
        if not cv2.imwrite(str(path), frame.pixels, [cv2.IMWRITE_PNG_COMPRESSION, 1]):
            raise DataError(
                f"frame {frame.name} cannot be written to {folder.parent}; is the disk full? "
                "A longer --every SECONDS takes fewer frames",
                file=video,
            )
        photos.append(Photo(frame.name, path))
        t.append(frame.t)
        sd.append(frame.t_sd)
    step = f", one every {every:g} s" if every > 0 else ""
    source = f"time stamps of the video's frames{step}"
    times = PhotoTimes(np.array(t, float), np.array(sd, float), source)
    return PhotoSequence(tuple(photos), times, None, video)


def _require_meant_for(request: TimeRequest, *, is_video: bool) -> None:
    """Raise `SettingsError` for a time option that has no effect on photographs, or on a video."""
    if not is_video:
        given, reason = {"--every": request.every}, "photographs, which are all taken"
    else:
        given = {
            "--interval": request.interval, "--times": request.table, "--clock": request.clock
        }  # fmt: skip
        reason = "a video, whose frames have their times"
    for key, value in given.items():
        if value is not None:
            raise SettingsError(f"leave out for {reason}", key=key)


def _simulated(path: Path) -> str | None:
    """Return "sim:photographs" if EXIF data name the camera's make "simulated", else None."""
    # Simulated photographs of tests and demonstrations say so in the camera's make.
    try:
        with open_picture(path) as picture:
            make = str(picture.getexif().get(0x010F, "")).strip("\0 ")
    except PhotoError:
        return None
    return "sim:photographs" if make.lower() == "simulated" else None
