# SPDX-License-Identifier: MIT
"""Read photographs with limits of size, and report damaged files."""

import re
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import PIL.Image
import PIL.ImageOps
from numpy.typing import NDArray

from tracking.errors import PhotoError, TrackingError

MOST_PIXELS = 80_000_000
"""Largest number of pixels read: decoding and rotating them takes less than a gigabyte [px]."""
MOST_FILE = 256 << 20
"""Largest size of a picture file that is read, that of `MOST_PIXELS` uncompressed [bytes]."""
MOST_SCANS = 200
"""Largest number of scans of a JPEG that is read; cameras write 1 to 12. Decoding a scan takes as
long as a whole picture."""

_READABLE = {".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".webp"}
_FORMATS = ("JPEG", "PNG", "TIFF", "BMP", "WEBP")  # not those that start programs
_KNOWN = _READABLE | {".heic", ".heif", ".avif"}
_HEIF_BRANDS = {b"heic", b"heix", b"hevc", b"mif1", b"msf1", b"heim", b"heis"}


@dataclass(frozen=True)
class Image:
    """A picture with its name and time.

    Attributes:
        name: Name of the photograph or frame.
        pixels: BGR, shape (height, width, 3).
        t: Time the picture was taken [s]; of a video frame from the start of the video.
        t_sd: Standard deviation of `t` [s].
    """

    name: str
    pixels: NDArray[np.uint8]
    t: float
    t_sd: float


def find_photos(folder: Path) -> tuple[Path, ...]:
    """List the photographs of a folder, by suffix, in natural order of their names.

    Args:
        folder: The folder; subfolders are not searched.

    Returns:
        Paths, "p2.jpg" before "p10.jpg". Files of formats that cannot be read (HEIC, AVIF) are
        included, so that reading reports them instead of skipping them silently.

    Raises:
        TrackingError: When `folder` is not a folder or has no photograph in it.
        OSError: When the folder may not be read.
    """
    if not folder.is_dir():
        raise TrackingError(f"{folder} is not a folder; expected a folder of photographs")
    paths = [path for path in folder.iterdir() if path.suffix.lower() in _KNOWN]
    if not paths:
        raise TrackingError(
            f"{folder} holds no photographs; expected files that end in "
            f"{', '.join(sorted(_READABLE))}"
        )
    return tuple(sorted(paths, key=lambda path: _counting(path.name)))


def _counting(name: str) -> list[tuple[int, int, str]]:
    """Return a key for natural order: digits compare as numbers, letters by their lower case."""
    parts = re.split(r"(\d+)", name.lower())
    return [(1, int(part), "") if part.isdigit() else (0, 0, part) for part in parts]


@contextmanager
def open_picture(path: Path) -> Iterator[PIL.Image.Image]:
    """Open a picture file with Pillow; size and EXIF data are read, pixels not yet decoded.

    Args:
        path: The file.

    Yields:
        Pillow's picture; the file is closed on exit.

    Raises:
        PhotoError: When the file is missing, not readable, not a regular file, empty, HEIC or of an
            unknown format, damaged, or larger than `MOST_FILE` or `MOST_PIXELS`; also for
            an OSError and for what Pillow raises inside the `with` block. Other exceptions of the
            block are raised unchanged.
        OSError: When the folder of the file may not be searched.
    """
    _refuse_unreadable(path)
    try:
        with warnings.catch_warnings():
            # Pillow warns of large pictures, which are measured below, and of odd EXIF data.
            warnings.simplefilter("ignore")
            with PIL.Image.open(path, formats=_FORMATS) as picture:
                _refuse_large(path, picture.size)
                yield picture
    except PhotoError:
        raise
    except PIL.UnidentifiedImageError as error:
        raise PhotoError(path.name, "not a readable picture; expected JPEG, PNG or TIFF") from error
    except PIL.Image.DecompressionBombError as error:
        most = 2 * (PIL.Image.MAX_IMAGE_PIXELS or MOST_PIXELS)
        raise PhotoError(path.name, _too_large(f"more than {most / 1e6:.0f}")) from error
    except Exception as error:  # Pillow raises many kinds of exceptions for damaged files
        if not (isinstance(error, OSError) or _raised_by_pillow(error)):
            raise
        reason = " ".join(str(error).split()) or type(error).__name__
        raise PhotoError(
            path.name,
            f"cannot be decoded ({reason[:200]}); the file is cut short or damaged: copy it again",
        ) from error


def _raised_by_pillow(error: Exception) -> bool:
    """Return whether an exception has passed through a function of Pillow."""
    frames = traceback.walk_tb(error.__traceback__)
    return any(frame.f_globals.get("__name__", "").startswith("PIL.") for frame, _ in frames)


def read_pixels(path: Path, *, size: tuple[int, int] | None = None) -> NDArray[np.uint8]:
    """Read a photograph, rotated by its EXIF orientation.

    Args:
        path: The file.
        size: Width and height the rotated photograph must have; None for any [px].

    Returns:
        BGR, shape (height, width, 3).

    Raises:
        PhotoError: When the file cannot be read (see `open_picture`), has more than `MOST_SCANS`
            scans, or is not of the given size.
        OSError: When the folder of the file may not be searched.
    """
    upright = _upright(path)
    if size is not None and upright.size != size:
        raise PhotoError(
            path.name,
            f"it has {upright.size[0]}x{upright.size[1]} px; expected {size[0]}x{size[1]} px, as "
            "most photographs, or the camera, have: use photographs of one size, not cropped",
        )
    return np.ascontiguousarray(np.asarray(upright)[:, :, ::-1])


def _upright(path: Path) -> PIL.Image.Image:
    """Decode a picture, rotate it by its EXIF orientation and convert it to RGB.

    The memory of the original is freed on return. Raises PhotoError and OSError as `open_picture`,
    PhotoError also for a JPEG of more than `MOST_SCANS` scans.
    """
    with open_picture(path) as picture:
        _refuse_many_scans(path)
        PIL.ImageOps.exif_transpose(picture, in_place=True)
        if picture.mode != "RGB":
            return picture.convert("RGB")
        picture.load()
        return picture


def _refuse_unreadable(path: Path) -> None:
    """Raise `PhotoError` unless this is a readable file, not empty, too large, or HEIC."""
    # Neither a FIFO, which would block until there is a writer, nor a device.
    if not path.is_file():
        found = "it is not a regular file; remove it from the folder"
        raise PhotoError(path.name, found if path.exists() else f"no such file in {path.parent}")
    if path.stat().st_size > MOST_FILE:
        found = f"the file has {path.stat().st_size / 1e6:.0f} MB; at most {MOST_FILE / 1e6:.0f} MB"
        raise PhotoError(path.name, f"{found} are read: scale the photograph down")
    try:
        with path.open("rb") as file:
            head = file.read(12)
    except OSError as error:
        found = f"cannot be opened ({error.strerror}); check its permissions"
        raise PhotoError(path.name, found) from error
    if not head:
        raise PhotoError(path.name, "the file is empty (0 bytes); copy it from the camera again")
    if head[4:8] == b"ftyp" and head[8:12] in _HEIF_BRANDS:
        raise PhotoError(
            path.name,
            "HEIC is not read; set the phone's camera to 'most compatible' (JPEG), or convert the "
            f"photographs with their EXIF data: heif-convert -q 95 {path.name} {path.stem}.jpeg "
            f"(Linux), sips -s format jpeg {path.name} --out {path.stem}.jpeg (macOS)",
        )


def _refuse_many_scans(path: Path) -> None:
    """Raise `PhotoError` for a JPEG whose scan markers (FF DA) exceed `MOST_SCANS`."""
    data = path.read_bytes()
    scans = data.count(b"\xff\xda") if data.startswith(b"\xff\xd8") else 0
    if scans > MOST_SCANS:
        found = f"the JPEG has {scans} scans; at most {MOST_SCANS} are read"
        raise PhotoError(path.name, f"{found}: save it as a JPEG that is not progressive")


def _refuse_large(path: Path, size: tuple[int, int]) -> None:
    """Raise `PhotoError` for a picture of more than `MOST_PIXELS`; `size` is width, height [px]."""
    if size[0] * size[1] > MOST_PIXELS:
        found = f"{size[0]}x{size[1]} px are {size[0] * size[1] / 1e6:.0f}"
        raise PhotoError(path.name, _too_large(found))


def _too_large(found: str) -> str:
    """Say that a picture has too many pixels, of which `found` says how many."""
    return (
        f"{found} megapixels; at most {MOST_PIXELS / 1e6:.0f} are read: 12 are plenty, scale the "
        "photographs down"
    )
