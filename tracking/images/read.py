# SPDX-License-Identifier: MIT
"""Read photographs, and say of each that cannot be read what is wrong with it."""

import re
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

MOST_PIXELS = 120_000_000
"""Largest picture that is read: three of them fit into a small computer's memory."""

_READABLE = {".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".webp"}
_KNOWN = _READABLE | {".heic", ".heif", ".avif"}
_HEIF_BRANDS = {b"heic", b"heix", b"hevc", b"mif1", b"msf1", b"heim", b"heis"}


@dataclass(frozen=True)
class Image:
    """A picture and when it was taken.

    Attributes:
        name: Name of the photograph or frame.
        pixels: BGR, shape (height, width, 3).
        t: Time [s].
        t_sd: Its standard deviation [s].
    """

    name: str
    pixels: NDArray[np.uint8]
    t: float
    t_sd: float


def find_photos(folder: Path) -> tuple[Path, ...]:
    """List the photographs of a folder, in the order in which a person counts.

    Args:
        folder: Folder, whose own files count only.

    Returns:
        Paths, "p2.jpg" before "p10.jpg". Files of kinds that cannot be read (HEIC) are among them,
        so that reading names them instead of their being passed over.

    Raises:
        TrackingError: When there is no folder or no photograph in it.
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
    parts = re.split(r"(\d+)", name.lower())
    return [(1, int(part), "") if part.isdigit() else (0, 0, part) for part in parts]


@contextmanager
def open_picture(path: Path) -> Iterator[PIL.Image.Image]:
    """Open a picture; its size and EXIF data are known, its pixels not yet decoded.

    Args:
        path: The file.

    Yields:
        Pillow's picture.

    Raises:
        PhotoError: When it has more pixels than Pillow opens at all.
        OSError: When it cannot be read; of what is no picture, Pillow's UnidentifiedImageError.
    """
    with warnings.catch_warnings():
        # Pillow warns of large pictures; `read_pixels` measures them.
        warnings.simplefilter("ignore", PIL.Image.DecompressionBombWarning)
        try:
            picture = PIL.Image.open(path)
        except PIL.Image.DecompressionBombError as error:
            most = 2 * (PIL.Image.MAX_IMAGE_PIXELS or MOST_PIXELS)
            raise PhotoError(path.name, _too_large(f"more than {most / 1e6:.0f}")) from error
    with picture:
        yield picture


def read_pixels(path: Path, *, size: tuple[int, int] | None = None) -> NDArray[np.uint8]:
    """Read a photograph, turned as its EXIF orientation says.

    Args:
        path: The file.
        size: Width and height it must have, usually the calibrated camera's [px].

    Returns:
        BGR, shape (height, width, 3).

    Raises:
        PhotoError: When the file is missing, empty, cut short, of an unknown kind, too large or
            not of the size asked for.
    """
    _refuse_unreadable(path)
    try:
        with open_picture(path) as picture:
            _refuse_large(path, picture.size)
            upright = PIL.ImageOps.exif_transpose(picture).convert("RGB")
    except PhotoError:
        raise
    except PIL.UnidentifiedImageError as error:
        raise PhotoError(path.name, "not a picture; expected JPEG, PNG or TIFF") from error
    except (OSError, SyntaxError, ValueError) as error:
        raise PhotoError(
            path.name,
            f"cannot be decoded ({error}); the file is cut short or damaged: copy it again",
        ) from error
    if size is not None and upright.size != size:
        raise PhotoError(
            path.name,
            f"{upright.size[0]}x{upright.size[1]} px; expected {size[0]}x{size[1]} px, as of the "
            "camera and the other photographs: use photographs of one size, not turned or cropped",
        )
    return np.ascontiguousarray(np.asarray(upright)[:, :, ::-1])


def _refuse_unreadable(path: Path) -> None:
    if not path.is_file():
        raise PhotoError(path.name, f"no such file in {path.parent}")
    with path.open("rb") as file:
        head = file.read(12)
    if not head:
        raise PhotoError(path.name, "the file is empty (0 bytes); copy it from the camera again")
    if head[4:8] == b"ftyp" and head[8:12] in _HEIF_BRANDS:
        raise PhotoError(
            path.name,
            "HEIC is not read; set the phone's camera to 'most compatible' (JPEG), or convert the "
            f"photographs with their EXIF data: heif-convert -q 95 {path.name} {path.stem}.jpeg "
            "(Linux), sips -s format jpeg (macOS)",
        )


def _refuse_large(path: Path, size: tuple[int, int]) -> None:
    if size[0] * size[1] > MOST_PIXELS:
        found = f"{size[0]}x{size[1]} px are {size[0] * size[1] / 1e6:.0f}"
        raise PhotoError(path.name, _too_large(found))


def _too_large(found: str) -> str:
    return (
        f"{found} megapixels; at most {MOST_PIXELS / 1e6:.0f} are read: 12 are plenty, scale the "
        "photographs down"
    )
