# SPDX-License-Identifier: MIT
"""Pictures of a report, embedded in the page, with captions."""

import base64
import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from PIL import Image, UnidentifiedImageError

from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing, read_bytes

MOST_PICTURE = 32 << 20
SUFFIXES: Final = (".png", ".svg")
"""Endings of the pictures that can be embedded."""
_MOST_PIXELS: Final = 64 << 20  # of a picture unpacked, 256 MB
_MOST_SIDE: Final = 16_383  # of WebP [px]
_AGAIN: Final = "delete it and run again what wrote it"
_PNG = b"\x89PNG\r\n\x1a\n"
_QUALITY: Final = 90
_PHOTOGRAPHIC: Final = 4.0
"""Ratio of a PNG's size to that at `_QUALITY` from which on no exact copy is tried."""
_WORTH: Final = 1.5
"""Ratio of the size of an exact copy to that at `_QUALITY` up to which it is taken."""
VALIDATION, ERRORS = "validation", ".errors"
CAPTIONS: Mapping[str, str] = {
    "curves": "The rig's traction over slip ratio, as measured and corrected, and the fit, by load",
    "surface": "Fitted traction force over slip ratio and load",
    "corner": "Posterior of the slip law's parameters, each alone and each pair",
    "traces": "The sampler's walkers over its steps",
    "residuals": "Residuals of the fit",
    "walk_parameters": "Prior and posterior of legs and floor",
    "left_out.": "A walk predicted from a fit of the other walks, and its track",
    "track residuals": "Observed poses against the smoothed track, with 90 % bands",
    "overlay": "The tracked path over a photograph",
    "map": "The tracked path over the floor as seen from above, with 90 % regions",
    "path": "Predicted path from above, with the body at several times",
    "band": "Predicted path from above and over time; bands hold 50 and 90 % of the draws",
    "motion": "Predicted position, velocity and acceleration of the body",
    "orientation": "Predicted roll, pitch and yaw with their rates",
    "slip_ratio": "Predicted slip ratio of each leg in the last two cycles",
    "normal_force": "Predicted normal force of each leg in the last two cycles",
    "traction_force": "Predicted traction of each leg in the last two cycles",
    "paired_traction": "Predicted traction of each leg, time steps added in pairs: twice the force",
    "leg_angles": "Angle of each leg in the last two cycles",
    "gantt": "Predicted stance of each leg in the last two cycles",
    "snapshots": "The robot at several times; legs on the ground are orange",
    "coordinates": "Coordinates of the thesis's model, with rates and accelerations",
    "lowest_angle": "Angle of the lowest point of each leg's circle",
    "hip_height": "Hip heights of each side, by which contacts change",
    "contact_velocity": "Speeds that each leg's slip ratio compares",
    "static_load": "Normal force of each leg, and its load in static equilibrium",
    "slip_law": "Traction of the slip law at four loads, and over slip and load",
    ".floor": "Predicted band and tracked path over the floor as seen from above",
    ".photos": "Photographs from above, and the robot drawn at its predicted pose",
    ".imu": "Roll and pitch, predicted and measured by the IMU",
    ".errors": "Predicted paths and the track, and errors over time",
}
"""Captions by file name without suffix; with a leading dot by the end of that name (validation);
with the stage before it where stages have pictures of one name."""


@dataclass(frozen=True)
class Picture:
    """A picture embedded in a page.

    Attributes:
        data: Content of the file as a `data:` URL.
        caption: Caption of the picture.
        name: Name of the file.
    """

    data: str
    caption: str
    name: str


def embed(file: Path, *, stage: str, simulated: bool) -> Picture:
    """Encode a picture as a `data:` URL, with its caption; a PNG as WebP, which is smaller.

    Args:
        file: A PNG or SVG file.
        stage: Name of the stage that drew the picture.
        simulated: Whether to append "(simulated)" to the caption.

    Raises:
        NotFound: There is no such file.
        DataError: The file is neither PNG nor SVG, cannot be read, or is too large.
    """
    data = read_bytes(file, most=MOST_PICTURE)
    kind, content = ("svg+xml", _svg(data, file)) if file.suffix == ".svg" else _webp(data, file)
    encoded = base64.b64encode(content).decode("ascii")
    caption = caption_of(file.stem, stage=stage)
    return Picture(
        f"data:image/{kind};base64,{encoded}",
        f"{caption} (simulated)" if simulated else caption,
        file.name,
    )


def _svg(data: bytes, file: Path) -> bytes:
    """Return an SVG as it is; `DataError` if it has no `<svg` in its first 4096 bytes.

    Within an `img` element browsers run no script in it.
    """
    if b"<svg" not in data[:4096]:
        raise DataError(f"is not an SVG; {_AGAIN}", file=file)
    return data


def _webp(data: bytes, file: Path) -> tuple[str, bytes]:
    """Convert a PNG to WebP: exactly where that is small, as for lines, else at high quality.

    A picture with a side too long for WebP is returned as it is. Transparency becomes white.

    Returns:
        Kind, "webp" or "png", and content.

    Raises:
        DataError: The file is no PNG, is damaged, or has too many pixels.
    """
    if not data.startswith(_PNG):
        raise DataError(f"is not a PNG; {_AGAIN}", file=file)
    with parsing(file, "cannot be read as PNG", advice=_AGAIN), _opened(data, file) as image:
        if image.width * image.height > _MOST_PIXELS:
            raise DataError(
                f"has {image.width} × {image.height} pixels; expected at most "
                f"{_MOST_PIXELS / 1e6:.0f} million", file=file,
            )  # fmt: skip
        if max(image.size) > _MOST_SIDE:
            return "png", data
        plain = image.convert("RGBA")
        plain = Image.alpha_composite(Image.new("RGBA", plain.size, "white"), plain).convert("RGB")
        close = _as_webp(plain, quality=_QUALITY, method=4)
        if len(data) > _PHOTOGRAPHIC * len(close):
            return "webp", close
        exact = _as_webp(plain, lossless=True, quality=50, method=2)
        return "webp", exact if len(exact) <= _WORTH * len(close) else close


def _opened(data: bytes, file: Path) -> Image.Image:
    """Open the bytes of a PNG; raise `DataError` if they are damaged."""
    try:
        return Image.open(io.BytesIO(data), formats=["PNG"])
    except UnidentifiedImageError as error:
        raise DataError(f"is a damaged PNG; {_AGAIN}", file=file) from error


def _as_webp(image: Image.Image, **how: int) -> bytes:
    """Encode a picture as WebP with these options of Pillow's encoder."""
    file = io.BytesIO()
    image.save(file, "WEBP", **how)
    return file.getvalue()


def lies_in(folder: Path, name: str) -> bool:
    """Return whether a file named in a manifest lies directly in the manifest's folder.

    Links are resolved first. A manifest is untrusted input: `../secret.png`, an absolute path or a
    link could refer to any file.

    Args:
        folder: Folder of the manifest.
        name: File name as given in the manifest.
    """
    if Path(name).name != name or "\0" in name:
        return False
    return (folder / name).resolve().parent == folder.resolve()


def place_of(name: str) -> tuple[int, str]:
    """Return the sort key of a picture's file name: index in `CAPTIONS` (else last), then name.

    A key with a leading dot fits if it is in the name, one with a final dot if the name begins with
    it, another if it is the name without its ending.

    >>> sorted(["corner.png", "curves.png", "b.imu.png", "b.png"], key=place_of)
    ['curves.png', 'corner.png', 'b.imu.png', 'b.png']
    """
    stem = Path(name).stem if name.endswith(SUFFIXES) else name
    keys = list(CAPTIONS)
    mine = (i for i, key in enumerate(keys) if _names(key, stem) or (key[0] == "." and key in stem))
    return next(mine, len(keys)), name


def _names(key: str, stem: str) -> bool:
    """Return whether a key of `CAPTIONS` is a picture's name, or with a final dot its beginning."""
    return stem == key or (key[-1] == "." and stem.startswith(key))


def caption_of(stem: str, *, stage: str) -> str:
    """Return the caption of a picture, from its file name and the stage that drew it.

    In a validation it is that of the key in `CAPTIONS` with a leading dot with which the name ends,
    else that of `.errors`. In other stages it is that of stage and name, else that of the name,
    else the name itself with spaces.

    Args:
        stem: File name of the picture without suffix.
        stage: Name of the stage that drew the picture.

    >>> caption_of("walk-3.photos", stage="validation")
    'Photographs from above, and the robot drawn at its predicted pose'
    >>> caption_of("left_out.walk1", stage="walks")
    'A walk predicted from a fit of the other walks, and its track'
    >>> caption_of("my-walk", stage="validation")
    'Predicted paths and the track, and errors over time'
    """
    if stage == VALIDATION:
        end = next((end for end in CAPTIONS if end[0] == "." and stem.endswith(end)), ERRORS)
        return CAPTIONS[end]
    if f"{stage} {stem}" in CAPTIONS:
        return CAPTIONS[f"{stage} {stem}"]
    words = stem.replace("_", " ").replace("-", " ")
    return next((CAPTIONS[key] for key in CAPTIONS if _names(key, stem)), words)
